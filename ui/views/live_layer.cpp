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

#include "views/bar_actor.h"

namespace glisson::views {

namespace {

constexpr double apart_mm = 3.0;  // vessels this far apart have fully their own colour, as in the picture of the run

struct Colours {
  Eigen::Vector3f mre, atlas, agree;  // 0..255
};

Colours coloursOf(render::Palette palette) {
  if (palette == render::Palette::ColourBlind) return {{40, 130, 255}, {255, 140, 0}, {245, 245, 245}};
  return {{50, 80, 255}, {255, 40, 40}, {190, 60, 230}};
}

/// One surface that moves; normals are those at rest, which is what small strains change least.
struct Surface {
  vtkNew<vtkPoints> points;
  vtkNew<vtkUnsignedCharArray> colours;
  vtkNew<vtkPolyData> data;
  vtkNew<vtkPolyDataMapper> mapper;
  vtkNew<vtkActor> actor;
  Eigen::Matrix3Xd rest;

  void make(const anatomy::TriangleMesh& mesh, bool coloured) {
    rest = mesh.vertices_lps_mm;
    points->SetDataTypeToFloat();
    points->SetNumberOfPoints(rest.cols());
    Eigen::Matrix3Xd normals = Eigen::Matrix3Xd::Zero(3, rest.cols());
    vtkNew<vtkCellArray> cells;
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
      const Eigen::Vector3i v = mesh.triangles.col(t);
      const vtkIdType ids[3] = {v[0], v[1], v[2]};
      cells->InsertNextCell(3, ids);
      const Eigen::Vector3d a = rest.col(v[0]), b = rest.col(v[1]), c = rest.col(v[2]);
      const Eigen::Vector3d n = (b - a).cross(c - a);
      for (int i = 0; i < 3; ++i) normals.col(v[i]) += n;
    }
    vtkNew<vtkFloatArray> normal;
    normal->SetNumberOfComponents(3);
    normal->SetNumberOfTuples(rest.cols());
    for (Eigen::Index n = 0; n < rest.cols(); ++n) {
      const Eigen::Vector3f unit = normals.col(n).normalized().cast<float>();
      normal->SetTypedTuple(n, unit.data());
    }
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
    auto* raw = static_cast<float*>(points->GetVoidPointer(0));
    Eigen::Map<Eigen::Matrix3Xf>(raw, 3, rest.cols()) = (rest + u_mm).cast<float>();
    points->Modified();
  }
};

}  // namespace

struct LiveLayer::Private {
  Colours colour;
  Surface liverMre, liverAtlas, vesselsMre, vesselsAtlas;
  std::optional<BarActor> bar;

  void paintLiver() {
    for (const auto& [surface, own] : {std::pair{&liverMre, colour.mre}, {&liverAtlas, colour.atlas}}) {
      const Eigen::Vector3d c = own.cast<double>() / 255.0;
      surface->actor->GetProperty()->SetColor(c.x(), c.y(), c.z());
      surface->actor->GetProperty()->SetOpacity(0.16);
      // Behind the vessels the back of the glass adds nothing but haze.
      surface->actor->GetProperty()->BackfaceCullingOn();
    }
  }
};

LiveLayer::LiveLayer(const render::RetractionScene& scene, render::Palette palette) : d_(std::make_unique<Private>()) {
  d_->liverMre.make(scene.liverSurface, false);
  d_->liverAtlas.make(scene.liverSurface, false);
  d_->vesselsMre.make(scene.vesselSurface, true);
  d_->vesselsAtlas.make(scene.vesselSurface, true);
  if (scene.retractorPoint_lps_mm) {
    rest_lps_ = tool_lps_ = *scene.retractorPoint_lps_mm;
    d_->bar.emplace(tools::BarPlace{rest_lps_, scene.retractorAxis, scene.retractorDirection,
                                    scene.retractorDiameter_mm, scene.retractorLength_mm});
  }
  setPalette(palette);
  const auto points = scene.liverSurface.vertices_lps_mm.cols() + scene.vesselSurface.vertices_lps_mm.cols();
  move(Eigen::Matrix3Xd::Zero(3, points), Eigen::Matrix3Xd::Zero(3, points), Eigen::Vector3d::Zero());
}

LiveLayer::~LiveLayer() = default;

void LiveLayer::addTo(vtkRenderer* renderer) {
  for (Surface* s : {&d_->vesselsAtlas, &d_->vesselsMre, &d_->liverAtlas, &d_->liverMre})
    if (s->rest.cols() > 0) renderer->AddViewProp(s->actor);
  if (d_->bar) renderer->AddViewProp(d_->bar->actor());
}

void LiveLayer::setPalette(render::Palette palette) {
  d_->colour = coloursOf(palette);
  d_->paintLiver();
}

void LiveLayer::move(const Eigen::Matrix3Xd& mre_mm, const Eigen::Matrix3Xd& atlas_mm, const Eigen::Vector3d& tool_mm) {
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
  if (d_->bar) d_->bar->shift(tool_mm);
}

}  // namespace glisson::views
