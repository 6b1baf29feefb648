// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/detail/scene3d_parts.h"

#include <vtkActor.h>
#include <vtkProp.h>
#include <vtkSmartPointer.h>

#include <vtkActor2D.h>
#include <vtkBillboardTextActor3D.h>
#include <vtkCellArray.h>
#include <vtkCoordinate.h>
#include <vtkFloatArray.h>
#include <vtkLineSource.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkPolyDataNormals.h>
#include <vtkProperty.h>
#include <vtkProperty2D.h>
#include <vtkShaderProperty.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkUnsignedCharArray.h>

#include <cmath>
#include <cstdio>

#include "render/slice_frame.h"

namespace glisson::render {
namespace {

Eigen::Vector3d unit(Rgb c) {
  return Eigen::Vector3d(c.r, c.g, c.b) / 255.0;
}

Eigen::Vector3d still(const Eigen::Vector3d& p) {
  return p;
}

vtkSmartPointer<vtkPolyData> asPolyData(const anatomy::TriangleMesh& mesh, const Motion& motion) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(mesh.vertices_lps_mm.cols());
  for (Eigen::Index n = 0; n < mesh.vertices_lps_mm.cols(); ++n)
    points->SetPoint(n, motion(mesh.vertices_lps_mm.col(n)).data());
  vtkNew<vtkCellArray> cells;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    const vtkIdType corners[3] = {mesh.triangles(0, t), mesh.triangles(1, t), mesh.triangles(2, t)};
    cells->InsertNextCell(3, corners);
  }
  auto poly = vtkSmartPointer<vtkPolyData>::New();
  poly->SetPoints(points);
  poly->SetPolys(cells);
  return poly;
}

/// Vertex normals of the moved surface; vertices are neither split nor merged, so colours stay with them.
vtkSmartPointer<vtkPolyData> withNormals(vtkPolyData* poly) {
  vtkNew<vtkPolyDataNormals> normals;
  normals->SetInputData(poly);
  normals->SplittingOff();
  normals->ConsistencyOff();
  normals->Update();
  return normals->GetOutput();
}

vtkSmartPointer<vtkActor> actorOf(vtkPolyData* poly) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(poly);
  mapper->ScalarVisibilityOff();
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  return actor;
}

}  // namespace

vtkSmartPointer<vtkActor> solidSurface(const anatomy::TriangleMesh& mesh, const Motion& motion, const Paint& paint) {
  anatomy::TriangleMesh moved = mesh;
  std::vector<Rgb> colours;
  colours.reserve(static_cast<std::size_t>(mesh.vertices_lps_mm.cols()));
  for (Eigen::Index n = 0; n < mesh.vertices_lps_mm.cols(); ++n) {
    moved.vertices_lps_mm.col(n) = motion(mesh.vertices_lps_mm.col(n));
    colours.push_back(paint(mesh.vertices_lps_mm.col(n)));
  }
  return colouredSurface(moved, colours);
}

vtkSmartPointer<vtkActor> colouredSurface(const anatomy::TriangleMesh& mesh, const std::vector<Rgb>& colours) {
  const vtkSmartPointer<vtkPolyData> poly = withNormals(asPolyData(mesh, still));
  vtkNew<vtkUnsignedCharArray> colour;
  colour->SetNumberOfComponents(3);
  colour->SetNumberOfTuples(mesh.vertices_lps_mm.cols());
  for (Eigen::Index n = 0; n < mesh.vertices_lps_mm.cols(); ++n) {
    const Rgb c = colours[static_cast<std::size_t>(n)];
    const unsigned char bytes[3] = {c.r, c.g, c.b};
    colour->SetTypedTuple(n, bytes);
  }
  poly->GetPointData()->SetScalars(colour);
  vtkSmartPointer<vtkActor> actor = actorOf(poly);
  actor->GetMapper()->ScalarVisibilityOn();
  vtkProperty* p = actor->GetProperty();
  p->SetInterpolationToPhong();
  p->SetAmbient(0.25);
  p->SetDiffuse(0.8);
  p->SetSpecular(0.25);
  p->SetSpecularPower(30);
  return actor;
}

vtkSmartPointer<vtkActor> glassSurface(const anatomy::TriangleMesh& mesh, const Motion& motion, Rgb colour,
                                       double faceOpacity, double rimOpacity) {
  vtkSmartPointer<vtkActor> actor = actorOf(withNormals(asPolyData(mesh, motion)));
  vtkProperty* p = actor->GetProperty();
  p->SetColor(unit(colour).data());
  p->SetOpacity(0.5);  // marks it as translucent; the shader sets the value
  p->SetInterpolationToPhong();
  p->SetAmbient(0.5);
  p->SetDiffuse(0.5);
  p->SetSpecular(0.0);
  p->BackfaceCullingOn();
  char shader[240];
  std::snprintf(shader, sizeof shader,
                "//VTK::Light::Impl\n"
                "  float rimness = pow(1.0 - abs(normalVCVSOutput.z), 2.5);\n"
                "  fragOutput0.a = mix(%.4f, %.4f, rimness);\n",
                faceOpacity, rimOpacity);
  actor->GetShaderProperty()->AddFragmentShaderReplacement("//VTK::Light::Impl", true, shader, false);
  return actor;
}

vtkSmartPointer<vtkActor> steel(const anatomy::TriangleMesh& mesh) {
  vtkSmartPointer<vtkActor> actor = actorOf(withNormals(asPolyData(mesh, still)));
  vtkProperty* p = actor->GetProperty();
  p->SetInterpolationToPhong();
  p->SetColor(0.72, 0.75, 0.79);
  p->SetAmbient(0.18);
  p->SetDiffuse(0.65);
  p->SetSpecular(0.9);
  p->SetSpecularPower(55);
  return actor;
}

vtkSmartPointer<vtkActor> segments(const std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>>& lines, Rgb colour,
                                   double lineWidth_px) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  for (const auto& [a, b] : lines) {
    const vtkIdType ends[2] = {points->InsertNextPoint(a.data()), points->InsertNextPoint(b.data())};
    cells->InsertNextCell(2, ends);
  }
  vtkNew<vtkPolyData> poly;
  poly->SetPoints(points);
  poly->SetLines(cells);
  vtkSmartPointer<vtkActor> actor = actorOf(poly);
  actor->GetProperty()->LightingOff();
  actor->GetProperty()->SetColor(unit(colour).data());
  actor->GetProperty()->SetLineWidth(static_cast<float>(lineWidth_px));
  actor->PickableOff();
  return actor;
}

vtkSmartPointer<vtkActor> gridLines(const Eigen::AlignedBox3d& box, int axis, double at_mm, double spacing_mm,
                                    bool majorOnly, double lineWidth_px) {
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> lines;
  for (const int moving : {(axis + 1) % 3, (axis + 2) % 3}) {
    const int across = 3 - axis - moving;
    for (const double v : gridLines_mm(box.min()[moving], box.max()[moving], spacing_mm)) {
      if ((std::lround(v / spacing_mm) % 5 == 0) != majorOnly) continue;
      Eigen::Vector3d a, b;
      a[axis] = b[axis] = at_mm;
      a[moving] = b[moving] = v;
      a[across] = box.min()[across];
      b[across] = box.max()[across];
      lines.emplace_back(a, b);
    }
  }
  return segments(lines, majorOnly ? Rgb{50, 170, 95} : Rgb{28, 92, 58}, lineWidth_px);
}

vtkSmartPointer<vtkProp> label3D(const Eigen::Vector3d& at_lps, const std::string& text, Rgb colour, double size_px,
                                 bool bold) {
  auto actor = vtkSmartPointer<vtkBillboardTextActor3D>::New();
  actor->SetInput(text.c_str());
  actor->SetPosition(at_lps.x(), at_lps.y(), at_lps.z());
  vtkTextProperty* p = actor->GetTextProperty();
  p->SetFontSize(static_cast<int>(std::lround(size_px)));
  p->SetColor(unit(colour).data());
  p->SetBold(bold);
  p->SetJustificationToCentered();
  p->SetVerticalJustificationToCentered();
  return actor;
}

vtkSmartPointer<vtkProp> screenText(double x, double y, const std::string& text, Rgb colour, double size_px, bool bold,
                                    bool centred, double angle_deg) {
  auto actor = vtkSmartPointer<vtkTextActor>::New();
  actor->SetInput(text.c_str());
  actor->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
  actor->SetPosition(x, y);
  actor->SetOrientation(static_cast<float>(angle_deg));
  vtkTextProperty* p = actor->GetTextProperty();
  p->SetFontSize(static_cast<int>(std::lround(size_px)));
  p->SetColor(unit(colour).data());
  p->SetBold(bold);
  if (centred) {
    p->SetJustificationToCentered();
    p->SetVerticalJustificationToCentered();
  }
  return actor;
}

vtkSmartPointer<vtkProp> screenSwatch(double x, double y, double width, double height, Rgb colour) {
  vtkNew<vtkPoints> points;
  points->InsertNextPoint(x, y, 0.0);
  points->InsertNextPoint(x + width, y, 0.0);
  points->InsertNextPoint(x + width, y + height, 0.0);
  points->InsertNextPoint(x, y + height, 0.0);
  vtkNew<vtkCellArray> cells;
  const vtkIdType corners[4] = {0, 1, 2, 3};
  cells->InsertNextCell(4, corners);
  vtkNew<vtkPolyData> poly;
  poly->SetPoints(points);
  poly->SetPolys(cells);
  vtkNew<vtkPolyDataMapper2D> mapper;
  vtkNew<vtkCoordinate> coordinate;
  coordinate->SetCoordinateSystemToNormalizedViewport();
  mapper->SetTransformCoordinate(coordinate);
  mapper->SetInputData(poly);
  auto actor = vtkSmartPointer<vtkActor2D>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(unit(colour).data());
  return actor;
}

}  // namespace glisson::render
