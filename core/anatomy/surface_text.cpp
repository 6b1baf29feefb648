// SPDX-License-Identifier: GPL-3.0-or-later

// OBJ, STL and Gmsh, read without a library: VTK's readers of these bring its rendering along.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>
#include <vector>

#include "anatomy/detail/surface_formats.h"

namespace glisson::anatomy::detail {
namespace {

/// Corners as they come, three for each triangle.
void setMesh(TriangleMesh& mesh, const std::vector<Eigen::Vector3d>& points,
             const std::vector<std::array<int, 3>>& triangles) {
  mesh.vertices_lps_mm.resize(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) mesh.vertices_lps_mm.col(static_cast<Eigen::Index>(i)) = points[i];
  mesh.triangles.resize(3, static_cast<Eigen::Index>(triangles.size()));
  for (std::size_t i = 0; i < triangles.size(); ++i)
    mesh.triangles.col(static_cast<Eigen::Index>(i)) = Eigen::Map<const Eigen::Vector3i>(triangles[i].data());
}

void turnWhereRas(SurfaceFile& file, const std::string& comment) {
  if (comment.find("SPACE=RAS") == std::string::npos) return;
  file.mesh.vertices_lps_mm.topRows(2) *= -1.0;
  file.warnings.emplace_back("its coordinates are RAS; they were turned into LPS");
}

/// 80 bytes of comment, the number of facets, 50 bytes for each (little-endian floats: normal, three corners).
SurfaceFile binaryStl(std::ifstream& in, const std::string& header, std::uint32_t facets) {
  static_assert(std::endian::native == std::endian::little);
  SurfaceFile out;
  std::vector<Eigen::Vector3d> points;
  std::vector<std::array<int, 3>> triangles;
  in.seekg(84);
  for (std::uint32_t f = 0; f < facets; ++f) {
    std::array<char, 50> record{};
    in.read(record.data(), record.size());
    std::array<float, 12> values{};
    std::memcpy(values.data(), record.data(), sizeof values);
    const int first = static_cast<int>(points.size());
    for (std::size_t c = 1; c < 4; ++c) points.emplace_back(values[3 * c], values[3 * c + 1], values[3 * c + 2]);
    triangles.push_back({first, first + 1, first + 2});
  }
  setMesh(out.mesh, points, triangles);
  turnWhereRas(out, header);
  return out;
}

/// The nodes and cells of a Gmsh file, section by section.
class GmshFile {
 public:
  explicit GmshFile(const std::filesystem::path& path) : path_(path), in_(path) {}
  SurfaceFile read();

 private:
  using Triangle = std::array<int, 3>;

  long count();
  /// The next node that a cell names, by its place among the points.
  int corner();
  void readFormat();
  void readNodes();
  void readCells();
  /// The type of a cell, once what stands before its corners has been read.
  long cellType();
  void addTetrahedron();

  const std::filesystem::path& path_;
  std::ifstream in_;
  bool second_ = false;  ///< version 2
  std::map<long, int> index_;
  std::vector<Eigen::Vector3d> points_;
  std::map<Triangle, Triangle> open_;  ///< faces of one tetrahedron only; sorted corners: corners from outside
  std::vector<Triangle> drawn_;
  SurfaceFile out_;
};

long GmshFile::count() {
  long n = -1;
  if (!(in_ >> n) || n < 0) refuseSurface(path_, "a count is missing");
  return n;
}

int GmshFile::corner() {
  long id = 0;
  if (!(in_ >> id)) refuseSurface(path_, "it ends within a cell");
  const auto at = index_.find(id);
  if (at == index_.end()) refuseSurface(path_, "a cell names node " + std::to_string(id) + ", which is not there");
  return at->second;
}

void GmshFile::readFormat() {
  double version = 0;
  int binary = 0;
  in_ >> version >> binary;
  if (!(version >= 2 && version < 3) || binary != 0)
    refuseSurface(path_, "only ASCII Gmsh files of versions 1 and 2 are read; save it as version 2 ASCII");
  second_ = true;
}

void GmshFile::readNodes() {
  for (long n = count(); n > 0; --n) {
    long id = 0;
    Eigen::Vector3d p;
    if (!(in_ >> id >> p.x() >> p.y() >> p.z())) refuseSurface(path_, "it ends within its nodes");
    if (!index_.emplace(id, static_cast<int>(points_.size())).second)
      refuseSurface(path_, "node " + std::to_string(id) + " is there twice");
    points_.push_back(p);
  }
}

long GmshFile::cellType() {
  long id = 0, type = 0, more = 0;
  if (!(in_ >> id >> type)) refuseSurface(path_, "it ends within its cells");
  if (second_) {
    if (!(in_ >> more) || more < 0 || more > 100) refuseSurface(path_, "a cell's tags cannot be read");
    for (long tag = 0; more > 0; --more) in_ >> tag;
  } else {
    long region = 0;
    if (!(in_ >> region >> region >> more)) refuseSurface(path_, "it ends within its cells");
  }
  return type;
}

void GmshFile::addTetrahedron() {
  std::array<int, 4> t{};
  for (int& c : t) c = corner();
  ++out_.volumeCells;
  const Eigen::Vector3d o = points_[static_cast<std::size_t>(t[0])];
  const double six = (points_[static_cast<std::size_t>(t[1])] - o)
                         .cross(points_[static_cast<std::size_t>(t[2])] - o)
                         .dot(points_[static_cast<std::size_t>(t[3])] - o);
  if (six < 0) std::swap(t[0], t[1]);
  for (const auto& f : {Triangle{t[0], t[2], t[1]}, Triangle{t[0], t[1], t[3]}, Triangle{t[1], t[2], t[3]},
                        Triangle{t[0], t[3], t[2]}}) {
    auto key = f;
    std::sort(key.begin(), key.end());
    if (!open_.emplace(key, f).second) open_.erase(key);
  }
}

void GmshFile::readCells() {
  enum Type : long { Line = 1, TriangleCell = 2, Tetrahedron = 4, PointCell = 15 };
  for (long n = count(); n > 0; --n) {
    const long type = cellType();
    if (type == TriangleCell) {
      const int a = corner(), b = corner(), c = corner();
      drawn_.push_back({a, b, c});
    } else if (type == Tetrahedron) {
      addTetrahedron();
    } else if (type == PointCell || type == Line) {
      for (int c = 0; c < (type == Line ? 2 : 1); ++c) corner();
    } else {
      refuseSurface(path_, "it has cells of Gmsh type " + std::to_string(type) + "; triangles and tetrahedra are read");
    }
  }
}

SurfaceFile GmshFile::read() {
  for (std::string word; in_ >> word;) {
    if (word == "$MeshFormat")
      readFormat();
    else if (word == "$NOD" || word == "$Nodes")
      readNodes();
    else if (word == "$ELM" || word == "$Elements")
      readCells();
  }
  if (out_.volumeCells > 0) {
    drawn_.clear();
    for (const auto& [key, face] : open_) drawn_.push_back(face);
  }
  out_.points = points_.size();
  setMesh(out_.mesh, points_, drawn_);
  return std::move(out_);
}

}  // namespace

SurfaceFile readStl(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::string header(80, '\0');
  std::uint32_t facets = 0;
  in.read(header.data(), 80);
  in.read(reinterpret_cast<char*>(&facets), 4);
  // ASCII files begin with "solid", but so do some binary ones: the length tells.
  const std::uintmax_t bytes = std::filesystem::file_size(path);
  if (in && bytes == 84 + 50 * static_cast<std::uintmax_t>(facets)) return binaryStl(in, header, facets);
  if (header.compare(0, 5, "solid") != 0)
    refuseSurface(path, "it is neither ASCII STL nor binary STL of the length that its header says");

  in.clear();
  in.seekg(0);
  SurfaceFile out;
  std::vector<Eigen::Vector3d> points;
  std::vector<std::array<int, 3>> triangles;
  std::string comment, word;
  std::getline(in, comment);
  int corners = 0;
  while (in >> word) {
    if (word == "vertex") {
      Eigen::Vector3d p;
      if (!(in >> p.x() >> p.y() >> p.z())) refuseSurface(path, "a vertex is not three numbers");
      points.push_back(p);
      ++corners;
    } else if (word == "endloop") {
      if (corners != 3) refuseSurface(path, "a facet has " + std::to_string(corners) + " corners");
      const int last = static_cast<int>(points.size()) - 1;
      triangles.push_back({last - 2, last - 1, last});
      corners = 0;
    }
  }
  if (corners != 0) refuseSurface(path, "it ends within a facet");
  setMesh(out.mesh, points, triangles);
  turnWhereRas(out, comment);
  return out;
}

SurfaceFile readObj(const std::filesystem::path& path) {
  std::ifstream in(path);
  SurfaceFile out;
  std::vector<Eigen::Vector3d> points;
  std::vector<std::array<int, 3>> triangles;
  std::string line, comments;
  for (std::size_t number = 1; std::getline(in, line); ++number) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind.starts_with('#') && number < 20) comments += line;
    if (kind == "v") {
      Eigen::Vector3d p;
      if (!(words >> p.x() >> p.y() >> p.z()))
        refuseSurface(path, "line " + std::to_string(number) + ": a vertex is not three numbers");
      points.push_back(p);
    } else if (kind == "f") {
      // Corners are "vertex", "vertex/texture" or "vertex/texture/normal"; negative ones count back from the last.
      std::vector<int> corners;
      for (std::string corner; words >> corner;) {
        char* end = nullptr;
        const long id = std::strtol(corner.c_str(), &end, 10);
        const long at = id < 0 ? static_cast<long>(points.size()) + id : id - 1;
        if (end == corner.c_str() || id == 0 || at < 0 || at >= static_cast<long>(points.size()))
          refuseSurface(path, "line " + std::to_string(number) + ": a face names a vertex that is not there");
        corners.push_back(static_cast<int>(at));
      }
      for (std::size_t c = 2; c < corners.size(); ++c) triangles.push_back({corners[0], corners[c - 1], corners[c]});
    }
  }
  setMesh(out.mesh, points, triangles);
  turnWhereRas(out, comments);
  return out;
}

/// The nodes and tetrahedra of a Gmsh file as a surface: the faces that belong to one tetrahedron.
SurfaceFile readGmsh(const std::filesystem::path& path) {
  return GmshFile(path).read();
}

}  // namespace glisson::anatomy::detail
