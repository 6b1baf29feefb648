// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/bar_actor.h"

#include <vtkActor.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkTransform.h>

#include <algorithm>

#include "render/rigid_bar.h"
#include "views/mesh_data.h"

namespace glisson::views {

namespace {

/// It lies against the liver on the side that the hoist comes from. The length of a rigid bar is that between the
/// centres of its round ends, that of a patch all of it.
anatomy::TriangleMesh meshOf(const tools::BarPlace& place) {
  const double radius = 0.5 * place.diameter_mm;
  if (!place.line_lps.empty()) return render::barMesh(place.line_lps, radius);
  const Eigen::Vector3d centre = place.contact_lps - radius * place.direction.normalized();
  const double length_mm = place.rigid ? place.length_mm : std::max(0.02, place.length_mm - place.diameter_mm);
  const Eigen::Vector3d half = 0.5 * length_mm * place.axis;
  return render::barMesh({centre - half, centre + half}, radius);
}

}  // namespace

BarActor::BarActor(const tools::BarPlace& place) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(meshWithNormals(meshOf(place)));
  actor_->SetMapper(mapper);
  actor_->GetProperty()->SetColor(0.80, 0.82, 0.85);
  actor_->GetProperty()->SetSpecular(0.5);
  actor_->GetProperty()->SetInterpolationToPhong();
  actor_->SetUserTransform(transform_);
}

BarActor::~BarActor() = default;

void BarActor::shift(const Eigen::Vector3d& by_mm) {
  transform_->Identity();
  transform_->Translate(by_mm.data());
}

}  // namespace glisson::views
