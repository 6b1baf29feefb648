#include "exchange/mesh_files.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <cmath>

#include "base/error.h"
#include "exchange/write_text.h"
#include "retraction/body.h"

namespace glisson::exchange {
namespace {

void addArrays(vtkDataSetAttributes* to, const std::vector<NamedArray>& arrays, Eigen::Index count) {
  for (const NamedArray& a : arrays) {
    if (a.values.cols() != count)
      throw BadArgument("array '" + a.name + "' has " + std::to_string(a.values.cols()) + " values for " +
                        std::to_string(count) + " points or cells");
    vtkNew<vtkDoubleArray> array;
    array->SetName(a.name.c_str());
    array->SetNumberOfComponents(static_cast<int>(a.values.rows()));
    array->SetNumberOfTuples(a.values.cols());
    for (Eigen::Index n = 0; n < a.values.cols(); ++n)
      for (Eigen::Index c = 0; c < a.values.rows(); ++c)
        array->SetComponent(n, static_cast<int>(c), a.values(c, n));
    to->AddArray(array);
  }
}

void describe(vtkDataSet* data) {
  vtkNew<vtkStringArray> space;
  space->SetName("SPACE");
  space->InsertNextValue("LPS");
  data->GetFieldData()->AddArray(space);
  vtkNew<vtkStringArray> note;
  note->SetName("NOTE");
  note->InsertNextValue("points in mm; research use only, not for clinical use");
  data->GetFieldData()->AddArray(note);
}

vtkNew<vtkPoints> pointsOf(const Eigen::Matrix3Xd& p) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(p.cols());
  for (Eigen::Index n = 0; n < p.cols(); ++n) points->SetPoint(n, p(0, n), p(1, n), p(2, n));
  return points;
}

template <typename Writer>
void write(Writer* writer, vtkDataObject* data, const std::filesystem::path& file) {
  writer->SetInputData(data);
  writer->WriteToOutputStringOn();
  writer->SetDataModeToBinary();
  if (writer->Write() == 0) throw BadInput("'" + file.filename().string() + "' cannot be written");
  writeBytes(file, writer->GetOutputString());
}

}  // namespace

HexMesh hexMeshOf(const retraction::Model& model, const retraction::Result* result) {
  const retraction::Body body(model);
  const mechanics::VoxelMesh& mesh = body.mesh();
  HexMesh out;
  out.nodes_lps_mm.resize(3, mesh.nodeCount());
  for (int n = 0; n < mesh.nodeCount(); ++n) out.nodes_lps_mm.col(n) = body.nodePosition_mm(n);
  out.hexes.resize(8, mesh.cellCount());
  NamedArray E{"E_kPa", Eigen::MatrixXd(1, mesh.cellCount())};
  // A flipped grid would turn the cells inside out: then top and bottom change places.
  const bool flipped = model.youngs_kPa.grid.direction.determinant() < 0.0;
  const std::array<int, 8> order = flipped ? std::array<int, 8>{4, 5, 7, 6, 0, 1, 3, 2}
                                           : std::array<int, 8>{0, 1, 3, 2, 4, 5, 7, 6};
  for (int c = 0; c < mesh.cellCount(); ++c) {
    const std::array<int, 8> nodes = mesh.nodesOf(c);
    for (int a = 0; a < 8; ++a)
      out.hexes(a, c) = nodes[static_cast<std::size_t>(order[static_cast<std::size_t>(a)])];
    E.values(0, c) = static_cast<double>(model.youngs_kPa.at(mesh.cellOf(c)));
  }
  out.cellArrays.push_back(std::move(E));
  if (result == nullptr) return out;
  NamedArray u{"u_mm", {}};
  if (result->nodal_u_m.cols() == mesh.nodeCount())
    u.values = 1e3 * model.youngs_kPa.grid.direction * result->nodal_u_m;
  else
    u.values = displacementsNear(model, *result, out.nodes_lps_mm);
  out.pointArrays.push_back(std::move(u));
  return out;
}

HexMesh deformed(const HexMesh& mesh) {
  for (const NamedArray& a : mesh.pointArrays)
    if (a.name == "u_mm") {
      HexMesh moved = mesh;
      moved.nodes_lps_mm += a.values;
      return moved;
    }
  throw BadArgument("a mesh without displacements (u_mm) has no deformed state");
}

Eigen::Matrix3Xd displacementsNear(const retraction::Model& model, const retraction::Result& result,
                                   const Eigen::Matrix3Xd& points) {
  std::vector<Eigen::Vector3d> list;
  for (Eigen::Index n = 0; n < points.cols(); ++n) list.emplace_back(points.col(n));
  const std::vector<Eigen::Vector3d> u = retraction::displacementAt(model, result, list);
  const image::Grid& g = model.youngs_kPa.grid;
  Eigen::Matrix3Xd out(3, points.cols());
  for (std::size_t n = 0; n < u.size(); ++n) {
    const auto column = static_cast<Eigen::Index>(n);
    if (u[n].allFinite()) {
      out.col(column) = u[n];
      continue;
    }
    // The nearest filled cell, looked for in growing boxes round the point.
    const Eigen::Vector3i at = g.lpsToIndex(list[n]).array().round().cast<int>();
    double nearest = -1.0;
    out.col(column).setZero();
    for (int reach = 1; reach <= g.size.maxCoeff() && nearest < 0.0; reach *= 2)
      for (int k = std::max(0, at.z() - reach); k <= std::min(g.size.z() - 1, at.z() + reach); ++k)
        for (int j = std::max(0, at.y() - reach); j <= std::min(g.size.y() - 1, at.y() + reach); ++j)
          for (int i = std::max(0, at.x() - reach); i <= std::min(g.size.x() - 1, at.x() + reach); ++i) {
            if (model.youngs_kPa.at(i, j, k) == 0.0f) continue;
            const double d = (g.indexToLps({double(i), double(j), double(k)}) - list[n]).squaredNorm();
            if (nearest >= 0.0 && d >= nearest) continue;
            nearest = d;
            out.col(column) = result.u_mm.at(i, j, k).cast<double>();
          }
  }
  return out;
}

void writeVtu(const std::filesystem::path& file, const HexMesh& mesh) {
  vtkNew<vtkUnstructuredGrid> grid;
  grid->SetPoints(pointsOf(mesh.nodes_lps_mm));
  grid->Allocate(mesh.hexes.cols());
  for (Eigen::Index c = 0; c < mesh.hexes.cols(); ++c) {
    vtkIdType ids[8];
    for (Eigen::Index a = 0; a < 8; ++a) ids[a] = mesh.hexes(a, c);
    grid->InsertNextCell(VTK_HEXAHEDRON, 8, ids);
  }
  addArrays(grid->GetPointData(), mesh.pointArrays, mesh.nodes_lps_mm.cols());
  addArrays(grid->GetCellData(), mesh.cellArrays, mesh.hexes.cols());
  describe(grid);
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  write(writer.Get(), grid, file);
}

void writeVtp(const std::filesystem::path& file, const anatomy::TriangleMesh& mesh,
              const std::vector<NamedArray>& pointArrays) {
  vtkNew<vtkPolyData> surface;
  surface->SetPoints(pointsOf(mesh.vertices_lps_mm));
  vtkNew<vtkCellArray> triangles;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    const vtkIdType ids[3] = {mesh.triangles(0, t), mesh.triangles(1, t), mesh.triangles(2, t)};
    triangles->InsertNextCell(3, ids);
  }
  surface->SetPolys(triangles);
  addArrays(surface->GetPointData(), pointArrays, mesh.vertices_lps_mm.cols());
  describe(surface);
  vtkNew<vtkXMLPolyDataWriter> writer;
  write(writer.Get(), surface, file);
}

void writePvd(const std::filesystem::path& file, const std::vector<std::pair<double, std::string>>& timeAndFile) {
  std::string xml =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
      "  <Collection>\n";
  for (const auto& [time_s, name] : timeAndFile)
    xml += "    <DataSet timestep=\"" + number(time_s) + "\" group=\"\" part=\"0\" file=\"" + xmlEscaped(name) + "\"/>\n";
  writeBytes(file, xml + "  </Collection>\n</VTKFile>\n");
}

}  // namespace glisson::exchange
