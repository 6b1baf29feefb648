// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/live_layer.h"

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "render/rigid_bar.h"
#include "views/bar_actor.h"

namespace glisson::views {

namespace {

constexpr double barsApart_mm = 0.3;  // nearer bars are drawn as one
constexpr double apart_mm = 3.0;  // vessels this far apart have fully their own colour, as in the picture of the run

struct Colours {
  Eigen::Vector3f mre, atlas, agree;  // 0..255
};

Colours coloursOf(render::Palette palette) {
  if (palette == render::Palette::ColourBlind) return {{40, 130, 255}, {255, 140, 0}, {245, 245, 245}};
  return {{50, 80, 255}, {255, 40, 40}, {190, 60, 230}};
}

/// One surface that moves.
struct Surface {
  vtkNew<vtkPoints> points;
  vtkNew<vtkFloatArray> normal;
  vtkNew<vtkUnsignedCharArray> colours;
  vtkNew<vtkPolyData> data;
  vtkNew<vtkPolyDataMapper> mapper;
  vtkNew<vtkActor> actor;
  Eigen::Matrix3Xd rest;
  Eigen::Matrix3Xi triangles;
  Eigen::Matrix3Xf at, normals;  ///< now

  void make(const anatomy::TriangleMesh& mesh, bool coloured) {
    rest = mesh.vertices_lps_mm;
    triangles = mesh.triangles;
    points->SetDataTypeToFloat();
    points->SetNumberOfPoints(rest.cols());
    vtkNew<vtkCellArray> cells;
    for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
      const vtkIdType ids[3] = {triangles(0, t), triangles(1, t), triangles(2, t)};
      cells->InsertNextCell(3, ids);
    }
    normal->SetNumberOfComponents(3);
    normal->SetNumberOfTuples(rest.cols());
    data->SetPoints(points);
    data->SetPolys(cells);
    data->GetPointData()->SetNormals(normal);
    if (coloured) {
      colours->SetNumberOfComponents(3);
      colours->SetNumberOfTuples(rest.cols());
      data->GetPointData()->SetScalars(colours);
    }
    mapper->SetInputData(data);
    mapper->SetScalarVisibility(coloured);
    actor->SetMapper(mapper);
  }

  void move(const Eigen::Ref<const Eigen::Matrix3Xd>& u_mm) {
    at = (rest + u_mm).cast<float>();
    normals.setZero(3, at.cols());
    for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
      const Eigen::Vector3i v = triangles.col(t);
      const Eigen::Vector3f a = at.col(v[0]);
      const Eigen::Vector3f n = (at.col(v[1]) - a).cross(at.col(v[2]) - a);
      for (int i = 0; i < 3; ++i) normals.col(v[i]) += n;
    }
    normals.colwise().normalize();
    Eigen::Map<Eigen::Matrix3Xf>(static_cast<float*>(points->GetVoidPointer(0)), 3, at.cols()) = at;
    Eigen::Map<Eigen::Matrix3Xf>(normal->GetPointer(0), 3, at.cols()) = normals;
    points->Modified();
    normal->Modified();
  }
};

}  // namespace

struct LiveLayer::Private {
  Colours colour;
  Surface liverMre, liverAtlas, vesselsMre, vesselsAtlas;
  std::optional<BarActor> bar, atlasBar;

  void paintLiver() {
    for (const auto& [surface, own] : {std::pair{&liverMre, colour.mre}, {&liverAtlas, colour.atlas}}) {
      const Eigen::Vector3d c = own.cast<double>() / 255.0;
      surface->actor->GetProperty()->SetColor(c.x(), c.y(), c.z());
      surface->actor->GetProperty()->SetOpacity(0.16);
      // Behind the vessels the back of the glass adds nothing but haze.
      surface->actor->GetProperty()->BackfaceCullingOn();
    }
    if (!atlasBar) return;
    const Eigen::Vector3d c = colour.atlas.cast<double>() / 255.0;
    atlasBar->actor()->GetProperty()->SetColor(c.x(), c.y(), c.z());
  }
};

LiveLayer::LiveLayer(const render::RetractionScene& scene, render::Palette palette) : d_(std::make_unique<Private>()) {
  d_->liverMre.make(scene.liverSurface, false);
  d_->liverAtlas.make(scene.liverSurface, false);
  d_->vesselsMre.make(scene.vesselSurface, true);
  d_->vesselsAtlas.make(scene.vesselSurface, true);
  if (scene.retractorPoint_lps_mm) {
    rest_lps_ = tool_lps_ = *scene.retractorPoint_lps_mm;
    tools::BarPlace place{rest_lps_,
                          scene.retractorAxis,
                          scene.retractorDirection,
                          scene.retractorDiameter_mm,
                          scene.retractorLength_mm,
                          scene.bar.has_value()};
    if (scene.bar) place.line_lps = scene.bar->centreline_lps_mm;
    d_->bar.emplace(place);
    d_->atlasBar.emplace(place);
    d_->atlasBar->actor()->GetProperty()->SetOpacity(0.45);
  }
  setPalette(palette);
  const auto points = scene.liverSurface.vertices_lps_mm.cols() + scene.vesselSurface.vertices_lps_mm.cols();
  move(Eigen::Matrix3Xd::Zero(3, points), Eigen::Matrix3Xd::Zero(3, points), Eigen::Vector3d::Zero(),
       Eigen::Vector3d::Zero());
}

LiveLayer::~LiveLayer() = default;

void LiveLayer::addTo(vtkRenderer* renderer) {
  for (Surface* s : {&d_->vesselsAtlas, &d_->vesselsMre, &d_->liverAtlas, &d_->liverMre})
    if (s->rest.cols() > 0) renderer->AddViewProp(s->actor);
  for (const auto* bar : {&d_->bar, &d_->atlasBar})
    if (*bar) renderer->AddViewProp((*bar)->actor());
}

void LiveLayer::setPalette(render::Palette palette) {
  d_->colour = coloursOf(palette);
  d_->paintLiver();
}

void LiveLayer::move(const Eigen::Matrix3Xd& mre_mm, const Eigen::Matrix3Xd& atlas_mm, const Eigen::Vector3d& tool_mm,
                     const Eigen::Vector3d& atlasTool_mm) {
  const Eigen::Index liver = d_->liverMre.rest.cols(), vessels = d_->vesselsMre.rest.cols();
  d_->liverMre.move(mre_mm.leftCols(liver));
  d_->liverAtlas.move(atlas_mm.leftCols(liver));
  d_->vesselsMre.move(mre_mm.middleCols(liver, vessels));
  d_->vesselsAtlas.move(atlas_mm.middleCols(liver, vessels));
  const auto byte = [](float v) { return static_cast<unsigned char>(std::lround(v)); };
  for (Eigen::Index n = 0; n < vessels; ++n) {
    const double apart = (mre_mm.col(liver + n) - atlas_mm.col(liver + n)).norm();
    const auto t = static_cast<float>(std::min(apart / apart_mm, 1.0));
    for (const auto& [surface, own] :
         {std::pair{&d_->vesselsMre, d_->colour.mre}, {&d_->vesselsAtlas, d_->colour.atlas}}) {
      const Eigen::Vector3f c = (1.0F - t) * d_->colour.agree + t * own;
      unsigned char* raw = surface->colours->GetPointer(3 * n);
      for (int i = 0; i < 3; ++i) raw[i] = byte(c[i]);
    }
  }
  d_->vesselsMre.colours->Modified();
  d_->vesselsAtlas.colours->Modified();
  tool_lps_ = rest_lps_ + tool_mm;
  if (!d_->bar) return;
  d_->bar->shift(tool_mm);
  d_->atlasBar->shift(atlasTool_mm);
  d_->atlasBar->actor()->SetVisibility((atlasTool_mm - tool_mm).norm() > barsApart_mm);
}

}  // namespace glisson::views
