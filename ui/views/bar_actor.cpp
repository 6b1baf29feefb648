#include "views/bar_actor.h"

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyDataNormals.h>
#include <vtkProperty.h>
#include <vtkTransform.h>

#include <algorithm>

#include "render/rigid_bar.h"

namespace glisson::views {

namespace {

/// It lies against the liver on the side that the hoist comes from. The length of a rigid bar is that between the centres
/// of its round ends, that of a patch all of it.
anatomy::TriangleMesh meshOf(const tools::BarPlace& place) {
  const double radius = 0.5 * place.diameter_mm;
  const Eigen::Vector3d centre = place.contact_lps - radius * place.direction.normalized();
  const double length_mm = place.rigid ? place.length_mm : std::max(0.02, place.length_mm - place.diameter_mm);
  const Eigen::Vector3d half = 0.5 * length_mm * place.axis;
  return render::barMesh({centre - half, centre + half}, radius);
}

}  // namespace

BarActor::BarActor(const tools::BarPlace& place) {
  const anatomy::TriangleMesh mesh = meshOf(place);
  vtkNew<vtkPoints> points;
  for (Eigen::Index n = 0; n < mesh.vertices_lps_mm.cols(); ++n)
    points->InsertNextPoint(mesh.vertices_lps_mm.col(n).data());
  vtkNew<vtkCellArray> cells;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    const vtkIdType corners[3] = {mesh.triangles(0, t), mesh.triangles(1, t), mesh.triangles(2, t)};
    cells->InsertNextCell(3, corners);
  }
  vtkNew<vtkPolyData> bare;
  bare->SetPoints(points);
  bare->SetPolys(cells);
  vtkNew<vtkPolyDataNormals> normals;
  normals->SetInputData(bare);
  normals->SplittingOff();
  normals->ConsistencyOff();
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(normals->GetOutputPort());
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
