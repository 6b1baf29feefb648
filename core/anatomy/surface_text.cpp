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
  std::ifstream in(path);
  std::string word;
  std::map<long, int> index;
  std::vector<Eigen::Vector3d> points;
  std::map<std::array<int, 3>, std::array<int, 3>> open;  // sorted corners: corners from outside
  std::vector<std::array<int, 3>> drawn;
  SurfaceFile out;
  const auto count = [&] {
    long n = -1;
    if (!(in >> n) || n < 0) refuseSurface(path, "a count is missing");
    return n;
  };
  const auto corner = [&] {
    long id = 0;
    if (!(in >> id)) refuseSurface(path, "it ends within a cell");
    const auto at = index.find(id);
    if (at == index.end()) refuseSurface(path, "a cell names node " + std::to_string(id) + ", which is not there");
    return at->second;
  };
  bool second = false;
  while (in >> word) {
    if (word == "$MeshFormat") {
      double version = 0;
      int binary = 0;
      in >> version >> binary;
      if (!(version >= 2 && version < 3) || binary != 0)
        refuseSurface(path, "only ASCII Gmsh files of versions 1 and 2 are read; save it as version 2 ASCII");
      second = true;
    } else if (word == "$NOD" || word == "$Nodes") {
      for (long n = count(); n > 0; --n) {
        long id = 0;
        Eigen::Vector3d p;
        if (!(in >> id >> p.x() >> p.y() >> p.z())) refuseSurface(path, "it ends within its nodes");
        if (!index.emplace(id, static_cast<int>(points.size())).second)
          refuseSurface(path, "node " + std::to_string(id) + " is there twice");
        points.push_back(p);
      }
    } else if (word == "$ELM" || word == "$Elements") {
      for (long n = count(); n > 0; --n) {
        long id = 0, type = 0, more = 0;
        if (!(in >> id >> type)) refuseSurface(path, "it ends within its cells");
        if (second) {
          if (!(in >> more) || more < 0 || more > 100) refuseSurface(path, "a cell's tags cannot be read");
          for (long tag = 0; more > 0; --more) in >> tag;
        } else {
          long region = 0;
          if (!(in >> region >> region >> more)) refuseSurface(path, "it ends within its cells");
        }
        if (type == 2) {
          const int a = corner(), b = corner(), c = corner();
          drawn.push_back({a, b, c});
        } else if (type == 4) {
          std::array<int, 4> t{};
          for (int& c : t) c = corner();
          ++out.volumeCells;
          const Eigen::Vector3d o = points[static_cast<std::size_t>(t[0])];
          const double six = (points[static_cast<std::size_t>(t[1])] - o)
                                 .cross(points[static_cast<std::size_t>(t[2])] - o)
                                 .dot(points[static_cast<std::size_t>(t[3])] - o);
          if (six < 0) std::swap(t[0], t[1]);
          for (const auto& f : {std::array{t[0], t[2], t[1]}, std::array{t[0], t[1], t[3]},
                                std::array{t[1], t[2], t[3]}, std::array{t[0], t[3], t[2]}}) {
            auto key = f;
            std::sort(key.begin(), key.end());
            if (!open.emplace(key, f).second) open.erase(key);
          }
        } else if (type == 15 || type == 1) {
          for (int c = 0; c < (type == 1 ? 2 : 1); ++c) corner();
        } else {
          refuseSurface(path,
                        "it has cells of Gmsh type " + std::to_string(type) + "; triangles and tetrahedra are read");
        }
      }
    }
  }
  if (out.volumeCells > 0) {
    drawn.clear();
    for (const auto& [key, face] : open) drawn.push_back(face);
  }
  out.points = points.size();
  setMesh(out.mesh, points, drawn);
  return out;
}

}  // namespace glisson::anatomy::detail
