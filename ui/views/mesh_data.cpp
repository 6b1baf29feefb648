// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/mesh_data.h"

#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataNormals.h>

namespace glisson::views {

vtkSmartPointer<vtkPolyData> meshWithNormals(const anatomy::TriangleMesh& mesh) {
  vtkNew<vtkPoints> points;
  points->SetNumberOfPoints(mesh.vertices_lps_mm.cols());
  for (Eigen::Index n = 0; n < mesh.vertices_lps_mm.cols(); ++n)
    points->SetPoint(n, mesh.vertices_lps_mm.col(n).data());
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
  normals->Update();
  return normals->GetOutput();
}

}  // namespace glisson::views
