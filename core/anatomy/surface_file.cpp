// SPDX-License-Identifier: GPL-3.0-or-later
#include "anatomy/surface_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "anatomy/detail/surface_formats.h"
#include "base/error.h"
#include "base/text.h"

namespace glisson::anatomy {
namespace {

/// Part of the size of a surface within which two points are one: single precision, and seams computed twice.
constexpr double samePlace = 1e-6;

/// Gives points that lie within a distance of an earlier one that one's number.
class Places {
 public:
  /// within 0: equal coordinates only.
  explicit Places(double within) : within_(within) {}

  int of(const Eigen::Vector3d& p) {
    const Eigen::Vector3d scaled = within_ > 0.0 ? (p / within_).array().floor().matrix().eval() : p;
    std::array<double, 3> cell{scaled.x() + 0.0, scaled.y() + 0.0, scaled.z() + 0.0};  // no negative zero
    for (int n = within_ > 0.0 ? 0 : 13; n < (within_ > 0.0 ? 27 : 14); ++n) {
      const std::array<double, 3> at{cell[0] + n % 3 - 1, cell[1] + n / 3 % 3 - 1, cell[2] + n / 9 - 1};
      const auto found = cells_.find(at);
      if (found == cells_.end()) continue;
      for (const int id : found->second)
        if ((points[static_cast<std::size_t>(id)] - p).norm() <= within_) return id;
    }
    cells_[cell].push_back(static_cast<int>(points.size()));
    points.push_back(p);
    return static_cast<int>(points.size()) - 1;
  }

  std::vector<Eigen::Vector3d> points;

 private:
  double within_;
  std::map<std::array<double, 3>, std::vector<int>> cells_;
};

enum class Walls { KeepOne, CancelOpposite };

/// Triangles with the same corners: the first of them, and whether another one is turned against it.
struct SameCorners {
  Eigen::Vector3i first;
  bool turned = false, against = false;
};

/// Triangles without area go, so do points that none names. Of triangles with the same corners the first stays (one
/// shell of a surface that is stored twice), or, where two of them are turned against each other (the wall between
/// bodies that touch), none.
TriangleMesh tidied(const TriangleMesh& mesh, double within_mm, Walls walls) {
  Places places(within_mm);
  std::vector<int> to(static_cast<std::size_t>(mesh.vertices_lps_mm.cols()), -1);
  std::map<std::array<int, 3>, SameCorners> kept;
  std::vector<std::array<int, 3>> order;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    Eigen::Vector3i c = mesh.triangles.col(t);
    for (int a = 0; a < 3; ++a) {
      int& n = to[static_cast<std::size_t>(c[a])];
      if (n < 0) n = places.of(mesh.vertices_lps_mm.col(c[a]));
      c[a] = n;
    }
    if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) continue;
    std::array<int, 3> key{c[0], c[1], c[2]};
    std::sort(key.begin(), key.end());
    const bool turned = (c[0] < c[1]) + (c[1] < c[2]) + (c[2] < c[0]) == 1;
    const auto [there, isNew] = kept.try_emplace(key, SameCorners{c, turned, false});
    if (isNew)
      order.push_back(key);
    else
      there->second.against = there->second.against || there->second.turned != turned;
  }
  std::vector<Eigen::Vector3i> triangles;
  for (const auto& key : order) {
    const SameCorners& same = kept.at(key);
    if (!same.against || walls == Walls::KeepOne) triangles.push_back(same.first);
  }
  std::vector<int> used(places.points.size(), -1);
  TriangleMesh out;
  std::vector<Eigen::Vector3d> points;
  out.triangles.resize(3, static_cast<Eigen::Index>(triangles.size()));
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (int c = 0; c < 3; ++c) {
      const auto p = static_cast<std::size_t>(triangles[t][c]);
      if (used[p] < 0) {
        used[p] = static_cast<int>(points.size());
        points.push_back(places.points[p]);
      }
      out.triangles(c, static_cast<Eigen::Index>(t)) = used[p];
    }
  out.vertices_lps_mm.resize(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) out.vertices_lps_mm.col(static_cast<Eigen::Index>(i)) = points[i];
  return out;
}

/// The first way of tidying that closes the surface: points exactly at one place, within samePlace, walls gone; else
/// the first.
TriangleMesh tidied(const TriangleMesh& mesh) {
  const Eigen::Vector3d extent_mm =
      mesh.vertices_lps_mm.rowwise().maxCoeff() - mesh.vertices_lps_mm.rowwise().minCoeff();
  const double within_mm = samePlace * extent_mm.norm();
  TriangleMesh exact = tidied(mesh, 0.0, Walls::KeepOne);
  if (isClosed(exact)) return exact;
  for (const Walls walls : {Walls::KeepOne, Walls::CancelOpposite})
    if (TriangleMesh merged = tidied(mesh, within_mm, walls); isClosed(merged)) return merged;
  return exact;
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
  if (out.mesh.triangles.cols() > 0) out.mesh = tidied(out.mesh);
  if (out.mesh.triangles.cols() == 0) detail::refuseSurface(path, "it holds no triangles");
  out.closed = isClosed(out.mesh);
  if (out.closed && volume_mm3(out.mesh) < 0) out.mesh.triangles.row(1).swap(out.mesh.triangles.row(2));
  return out;
}

}  // namespace glisson::anatomy
