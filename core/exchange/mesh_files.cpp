// SPDX-License-Identifier: GPL-3.0-or-later
#include "exchange/mesh_files.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include "base/error.h"
#include "base/xml_text.h"
#include "exchange/text_file.h"
#include "retraction/body.h"

namespace glisson::exchange {
namespace {

/// A VTK XML file with its numbers appended raw: eight bytes of length, then little-endian values.
class VtkXml {
 public:
  explicit VtkXml(const char* type) : type_(type) {
    static_assert(std::endian::native == std::endian::little, "numbers are written as they lie in memory");
  }
  void line(const std::string& text) { xml_ += text + "\n"; }
  template <typename Number>
  void array(const char* kind, const std::string& name, std::size_t components, const std::vector<Number>& values) {
    xml_ += std::string("<DataArray type=\"") + kind + "\" Name=\"" + xmlEscaped(name) + "\" NumberOfComponents=\"" +
            std::to_string(components) + "\" format=\"appended\" offset=\"" + std::to_string(data_.size()) + "\"/>\n";
    const std::uint64_t bytes = values.size() * sizeof(Number);
    data_.append(reinterpret_cast<const char*>(&bytes), sizeof bytes);
    data_.append(reinterpret_cast<const char*>(values.data()), bytes);
  }
  void matrix(const std::string& name, const Eigen::MatrixXd& m) {
    array("Float64", name, static_cast<std::size_t>(m.rows()), std::vector<double>(m.data(), m.data() + m.size()));
  }
  void arrays(const char* section, const std::vector<NamedArray>& all, Eigen::Index count) {
    line(std::string("<") + section + ">");
    for (const NamedArray& a : all) {
      if (a.values.cols() != count)
        throw BadArgument("array '" + a.name + "' has " + std::to_string(a.values.cols()) + " values for " +
                          std::to_string(count) + " points or cells");
      matrix(a.name, a.values);
    }
    line(std::string("</") + section + ">");
  }
  void points(const Eigen::Matrix3Xd& p) {
    line("<Points>");
    matrix("Points", p);
    line("</Points>");
  }
  /// space: say in the field data, too, that points are LPS, as 3D Slicer does; readers of unstructured grids other
  /// than VTK's know no texts there.
  std::string text(bool space) const {
    const std::string type(type_);
    const std::string fieldData =
        "<FieldData>\n<Array type=\"String\" Name=\"SPACE\" NumberOfTuples=\"1\" "
        "format=\"ascii\">\n76 80 83 0\n</Array>\n</FieldData>\n";  // "LPS" as character codes
    return "<?xml version=\"1.0\"?>\n<!-- points in mm, LPS; research use only, not for clinical use -->\n<VTKFile "
           "type=\"" +
           type + "\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<" + type + ">\n" +
           (space ? fieldData : std::string()) + xml_ + "</" + type + ">\n<AppendedData encoding=\"raw\">\n_" + data_ +
           "\n</AppendedData>\n</VTKFile>\n";
  }

 private:
  const char* type_;
  std::string xml_, data_;
};

/// Where each cell of equal size ends in the list of its points.
std::vector<std::int64_t> ends(Eigen::Index cells, std::int64_t size) {
  std::vector<std::int64_t> out;
  for (std::int64_t c = 1; c <= cells; ++c) out.push_back(size * c);
  return out;
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
  const std::array<int, 8> order =
      flipped ? std::array<int, 8>{4, 5, 7, 6, 0, 1, 3, 2} : std::array<int, 8>{0, 1, 3, 2, 4, 5, 7, 6};
  for (int c = 0; c < mesh.cellCount(); ++c) {
    const std::array<int, 8> nodes = mesh.nodesOf(c);
    for (int a = 0; a < 8; ++a) out.hexes(a, c) = nodes[static_cast<std::size_t>(order[static_cast<std::size_t>(a)])];
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
            const double d =
                (g.indexToLps({static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)}) - list[n])
                    .squaredNorm();
            if (nearest >= 0.0 && d >= nearest) continue;
            nearest = d;
            out.col(column) = result.u_mm.at(i, j, k).cast<double>();
          }
  }
  return out;
}

void writeVtu(const std::filesystem::path& file, const HexMesh& mesh) {
  VtkXml xml("UnstructuredGrid");
  const Eigen::Index points = mesh.nodes_lps_mm.cols(), cells = mesh.hexes.cols();
  xml.line("<Piece NumberOfPoints=\"" + std::to_string(points) + "\" NumberOfCells=\"" + std::to_string(cells) + "\">");
  xml.arrays("PointData", mesh.pointArrays, points);
  xml.arrays("CellData", mesh.cellArrays, cells);
  xml.points(mesh.nodes_lps_mm);
  xml.line("<Cells>");
  xml.array("Int64", "connectivity", 1,
            std::vector<std::int64_t>(mesh.hexes.data(), mesh.hexes.data() + mesh.hexes.size()));
  xml.array("Int64", "offsets", 1, ends(cells, 8));
  constexpr std::uint8_t hexahedron = 12;
  xml.array("UInt8", "types", 1, std::vector<std::uint8_t>(static_cast<std::size_t>(cells), hexahedron));
  xml.line("</Cells>\n</Piece>");
  writeTextFile(file, xml.text(false));
}

void writeVtp(const std::filesystem::path& file, const anatomy::TriangleMesh& mesh,
              const std::vector<NamedArray>& pointArrays) {
  VtkXml xml("PolyData");
  const Eigen::Index points = mesh.vertices_lps_mm.cols(), cells = mesh.triangles.cols();
  xml.line("<Piece NumberOfPoints=\"" + std::to_string(points) + "\" NumberOfPolys=\"" + std::to_string(cells) + "\">");
  xml.arrays("PointData", pointArrays, points);
  xml.points(mesh.vertices_lps_mm);
  xml.line("<Polys>");
  xml.array("Int64", "connectivity", 1,
            std::vector<std::int64_t>(mesh.triangles.data(), mesh.triangles.data() + mesh.triangles.size()));
  xml.array("Int64", "offsets", 1, ends(cells, 3));
  xml.line("</Polys>\n</Piece>");
  writeTextFile(file, xml.text(true));
}

void writePvd(const std::filesystem::path& file, const std::vector<std::pair<double, std::string>>& timeAndFile) {
  std::string xml =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
      "  <Collection>\n";
  for (const auto& [time_s, name] : timeAndFile)
    xml += "    <DataSet timestep=\"" + shortest(time_s) + "\" group=\"\" part=\"0\" file=\"" + xmlEscaped(name) +
           "\"/>\n";
  writeTextFile(file, xml + "  </Collection>\n</VTKFile>\n");
}

}  // namespace glisson::exchange
