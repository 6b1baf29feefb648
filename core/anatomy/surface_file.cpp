#include "anatomy/surface_file.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <vector>

#include "anatomy/detail/surface_formats.h"
#include "base/error.h"
#include "base/text.h"

namespace glisson::anatomy {
namespace {

/// Points at the same place become one; triangles without area and repeated ones go; so do points that none names.
void tidy(TriangleMesh& mesh) {
  std::map<std::array<double, 3>, int> place;
  std::vector<int> to(static_cast<std::size_t>(mesh.vertices_lps_mm.cols()), -1);
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3i> kept;
  std::set<std::array<int, 3>> seen;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    Eigen::Vector3i c = mesh.triangles.col(t);
    for (int a = 0; a < 3; ++a) {
      int& n = to[static_cast<std::size_t>(c[a])];
      if (n < 0) {
        const Eigen::Vector3d p = mesh.vertices_lps_mm.col(c[a]);
        const auto [at, fresh] = place.emplace(std::array{p.x(), p.y(), p.z()}, static_cast<int>(points.size()));
        if (fresh) points.push_back(p);
        n = at->second;
      }
      c[a] = n;
    }
    if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) continue;
    std::array<int, 3> key{c[0], c[1], c[2]};
    std::sort(key.begin(), key.end());
    if (seen.insert(key).second) kept.push_back(c);
  }
  mesh.vertices_lps_mm.resize(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) mesh.vertices_lps_mm.col(static_cast<Eigen::Index>(i)) = points[i];
  mesh.triangles.resize(3, static_cast<Eigen::Index>(kept.size()));
  for (std::size_t i = 0; i < kept.size(); ++i) mesh.triangles.col(static_cast<Eigen::Index>(i)) = kept[i];
}

}  // namespace

void detail::refuseSurface(const std::filesystem::path& path, const std::string& why) {
  throw BadInput("'" + path.filename().string() + "' is not a usable surface: " + why);
}

bool isSurfaceFile(const std::filesystem::path& path) {
  static constexpr std::array known = {".stl", ".obj", ".vtp", ".vtu", ".vtk", ".msh"};
  return std::find(known.begin(), known.end(), extensionOf(path)) != known.end();
}

SurfaceFile readSurface(const std::filesystem::path& path) {
  constexpr std::uintmax_t most = 1'000'000'000;
  std::error_code failed;
  const auto bytes = std::filesystem::file_size(path, failed);
  if (failed) detail::refuseSurface(path, "it cannot be opened");
  if (bytes > most) detail::refuseSurface(path, "it is larger than 1 GB");
  const std::string e = extensionOf(path);
  SurfaceFile out = e == ".msh"   ? detail::readGmsh(path)
                    : e == ".stl" ? detail::readStl(path)
                    : e == ".obj" ? detail::readObj(path)
                                  : detail::readVtk(path, e != ".vtk", e == ".vtu");
  if (!out.mesh.vertices_lps_mm.allFinite()) detail::refuseSurface(path, "a coordinate is not a number");
  if (out.points == 0) out.points = static_cast<std::size_t>(out.mesh.vertices_lps_mm.cols());
  tidy(out.mesh);
  if (out.mesh.triangles.cols() == 0) detail::refuseSurface(path, "it holds no triangles");
  out.closed = isClosed(out.mesh);
  if (out.closed && volume_mm3(out.mesh) < 0) out.mesh.triangles.row(1).swap(out.mesh.triangles.row(2));
  return out;
}

}  // namespace glisson::anatomy
