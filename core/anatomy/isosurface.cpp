// SPDX-License-Identifier: GPL-3.0-or-later
#include "anatomy/detail/isosurface.h"

#include <vtkCellArray.h>
#include <vtkCommand.h>
#include <vtkFloatArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkWindowedSincPolyDataFilter.h>

#include <cmath>
#include <string>

#include "base/error.h"

namespace glisson::anatomy {
namespace {

/// VTK reports failures as events; here they become exceptions.
class ErrorCatcher : public vtkCommand {
 public:
  static ErrorCatcher* New() { return new ErrorCatcher; }
  void Execute(vtkObject*, unsigned long, void* data) override {
    if (message.empty() && data != nullptr) message = static_cast<const char*>(data);
  }
  void check() const {
    if (!message.empty()) throw BadInput("the surface could not be built: " + message);
  }
  std::string message;
};

}  // namespace

TriangleMesh isosurface(const image::ScalarVolume& field, double level, int smoothing) {
  const image::Grid& grid = field.grid;
  // A value equal to the level would make triangles of no area.
  const auto nudge = static_cast<float>(1e-4 * grid.spacing_mm.minCoeff());
  vtkNew<vtkFloatArray> values;
  values->SetNumberOfValues(static_cast<vtkIdType>(field.values.size()));
  for (std::size_t i = 0; i < field.values.size(); ++i) {
    const float above = field.values[i] - static_cast<float>(level);
    values->SetValue(static_cast<vtkIdType>(i), std::abs(above) < nudge ? -nudge : above);
  }
  vtkNew<vtkImageData> image;  // index coordinates scaled by the spacing; moved to LPS below
  image->SetDimensions(grid.size.x(), grid.size.y(), grid.size.z());
  image->SetSpacing(grid.spacing_mm.x(), grid.spacing_mm.y(), grid.spacing_mm.z());
  image->GetPointData()->SetScalars(values);

  vtkNew<ErrorCatcher> errors;
  vtkNew<vtkFlyingEdges3D> contour;
  contour->AddObserver(vtkCommand::ErrorEvent, errors);
  contour->SetInputData(image);
  contour->SetValue(0, 0.0);
  contour->ComputeNormalsOff();
  contour->ComputeGradientsOff();
  contour->ComputeScalarsOff();
  vtkNew<vtkWindowedSincPolyDataFilter> smooth;
  smooth->AddObserver(vtkCommand::ErrorEvent, errors);
  vtkPolyData* surface = nullptr;
  contour->Update();
  surface = contour->GetOutput();
  if (smoothing > 0 && surface->GetNumberOfPoints() > 0) {
    smooth->SetInputData(surface);
    smooth->SetNumberOfIterations(smoothing);
    smooth->SetPassBand(0.1);
    smooth->FeatureEdgeSmoothingOff();
    smooth->BoundarySmoothingOff();
    smooth->NonManifoldSmoothingOn();
    smooth->NormalizeCoordinatesOn();
    smooth->Update();
    surface = smooth->GetOutput();
  }
  errors->check();

  TriangleMesh mesh;
  mesh.vertices_lps_mm.resize(3, surface->GetNumberOfPoints());
  for (vtkIdType p = 0; p < surface->GetNumberOfPoints(); ++p) {
    double x[3];
    surface->GetPoint(p, x);
    mesh.vertices_lps_mm.col(p) = grid.origin_lps_mm + grid.direction * Eigen::Vector3d(x[0], x[1], x[2]);
  }
  vtkCellArray* cells = surface->GetPolys();
  mesh.triangles.resize(3, cells->GetNumberOfCells());
  for (vtkIdType t = 0; t < cells->GetNumberOfCells(); ++t) {
    vtkIdType n = 0;
    const vtkIdType* ids = nullptr;
    cells->GetCellAtId(t, n, ids);
    for (int c = 0; c < 3; ++c) mesh.triangles(c, t) = static_cast<int>(ids[c]);
  }
  if (volume_mm3(mesh) < 0.0) mesh.triangles.row(1).swap(mesh.triangles.row(2));
  return mesh;
}

}  // namespace glisson::anatomy
