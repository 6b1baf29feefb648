// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/model_layer.h"

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <list>
#include <optional>

#include "views/bar_actor.h"
#include "views/colour_map.h"
#include "views/mesh_data.h"

namespace glisson::views {

namespace {

struct Part {
  vtkNew<vtkPolyData> data;
  vtkNew<vtkPolyDataMapper> mapper;
  vtkNew<vtkActor> actor;
  Part() {
    mapper->SetInputData(data);
    mapper->ScalarVisibilityOff();
    actor->SetMapper(mapper);
  }
  void colour(double r, double g, double b) { actor->GetProperty()->SetColor(r, g, b); }
};

void takeMesh(Part& part, const anatomy::TriangleMesh& mesh) {
  part.data->ShallowCopy(meshWithNormals(mesh));
}

void takePoints(Part& part, const Eigen::Matrix3Xd& at, double size_px) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  for (Eigen::Index n = 0; n < at.cols(); ++n) {
    const vtkIdType id = points->InsertNextPoint(at.col(n).data());
    cells->InsertNextCell(1, &id);
  }
  part.data->SetPoints(points);
  part.data->SetVerts(cells);
  part.actor->GetProperty()->SetPointSize(static_cast<float>(size_px));
  part.actor->GetProperty()->LightingOff();
}

}  // namespace

struct ModelLayer::Private {
  Part liver, vessels, sites;
  std::list<Part> supports;
  std::optional<BarActor> bar;
  Eigen::VectorXf shear_kPa;

  void paintStiffness(bool on, double most_kPa) {
    liver.mapper->SetScalarVisibility(on && shear_kPa.size() > 0);
    liver.colour(0.72, 0.60, 0.55);
    if (!on || shear_kPa.size() == 0) return;
    const auto& table = stiffnessColours();
    vtkNew<vtkUnsignedCharArray> colours;
    colours->SetNumberOfComponents(3);
    colours->SetNumberOfTuples(shear_kPa.size());
    for (Eigen::Index n = 0; n < shear_kPa.size(); ++n) {
      const double t = std::clamp(static_cast<double>(shear_kPa[n]) / most_kPa, 0.0, 1.0);
      const QRgb c = table[static_cast<std::size_t>(std::lround(255.0 * t))];
      const unsigned char rgb[3] = {static_cast<unsigned char>(qRed(c)), static_cast<unsigned char>(qGreen(c)),
                                    static_cast<unsigned char>(qBlue(c))};
      colours->SetTypedTuple(n, rgb);
    }
    liver.data->GetPointData()->SetScalars(colours);
  }
};

ModelLayer::ModelLayer(const tools::ModelPicture& picture, double pixelRatio) : d_(std::make_unique<Private>()) {
  takeMesh(d_->liver, picture.liver);
  d_->shear_kPa = picture.shear_kPa;
  vtkProperty* glass = d_->liver.actor->GetProperty();
  glass->SetInterpolationToPhong();
  glass->SetAmbient(0.35);
  glass->SetDiffuse(0.7);
  glass->SetSpecular(0.05);
  glass->BackfaceCullingOn();
  takeMesh(d_->vessels, picture.vessels);
  d_->vessels.colour(0.36, 0.55, 1.0);
  d_->vessels.actor->GetProperty()->SetInterpolationToPhong();
  d_->vessels.actor->GetProperty()->SetAmbient(0.35);
  d_->vessels.actor->GetProperty()->SetSpecular(0.25);
  takePoints(d_->sites, picture.sites_lps, (picture.meshfree ? 6.0 : 1.6) * pixelRatio);
  d_->sites.colour(1.0, 1.0, 1.0);
  for (const auto& support : picture.supports) {
    Part& part = d_->supports.emplace_back();
    takePoints(part, support.points_lps, (support.fixed ? 5.0 : 2.2) * pixelRatio);
    support.fixed ? part.colour(1.0, 0.55, 0.0) : part.colour(0.25, 0.85, 0.80);
  }
  if (picture.bar) d_->bar.emplace(*picture.bar);
}

ModelLayer::~ModelLayer() = default;

void ModelLayer::addTo(vtkRenderer& renderer) {
  for (Part* part : {&d_->vessels, &d_->sites}) renderer.AddViewProp(part->actor);
  for (Part& part : d_->supports) renderer.AddViewProp(part.actor);
  if (d_->bar) renderer.AddViewProp(d_->bar->actor());
  renderer.AddViewProp(d_->liver.actor);
}

void ModelLayer::show(const ModelParts& parts) {
  d_->liver.actor->SetVisibility(parts.surface);
  d_->paintStiffness(parts.stiffness, parts.most_kPa);
  // What lies inside is to be seen through the surface; with nothing inside it is a solid body.
  const bool inside = (parts.vessels && d_->vessels.data->GetNumberOfPoints() > 0) || parts.sites;
  d_->liver.actor->GetProperty()->SetOpacity(inside ? 0.5 : 1.0);
  d_->vessels.actor->SetVisibility(parts.vessels);
  d_->sites.actor->SetVisibility(parts.sites);
  for (Part& part : d_->supports) part.actor->SetVisibility(parts.supports);
  if (d_->bar) d_->bar->actor()->SetVisibility(parts.bar);
}

}  // namespace glisson::views
