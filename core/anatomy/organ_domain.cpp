// SPDX-License-Identifier: GPL-3.0-or-later
#include "anatomy/detail/organ_domain.h"

#include <algorithm>
#include <limits>
#include <map>

#include "anatomy/detail/isosurface.h"
#include "base/disjoint_sets.h"

namespace glisson::anatomy {
namespace {

constexpr std::size_t leastPoints = 16, mostPoints = 2000;  // per part

/// Part of the surface that each vertex belongs to, named after its first vertex.
std::vector<int> partsOf(const TriangleMesh& mesh) {
  std::vector<int> parts(static_cast<std::size_t>(mesh.vertices_lps_mm.cols()));
  DisjointSets sets(parts.size());
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t)
    for (int c = 1; c < 3; ++c) sets.join(mesh.triangles(0, t), mesh.triangles(c, t));
  for (std::size_t i = 0; i < parts.size(); ++i) parts[i] = sets.find(static_cast<int>(i));
  return parts;
}

}  // namespace

OrganDomain::OrganDomain(const SurfaceField& field) : field_(field) {
  const image::Grid& g = field.values_mm.grid;
  toIndex_ = g.spacing_mm.cwiseInverse().asDiagonal() * g.direction.transpose();
  low_.setConstant(std::numeric_limits<double>::infinity());
  high_ = -low_;
  for (int c = 0; c < 8; ++c) {
    const Eigen::Vector3d corner =
        Eigen::Vector3d(c & 1, c >> 1 & 1, c >> 2 & 1).cwiseProduct((g.size - Eigen::Vector3i::Ones()).cast<double>());
    low_ = low_.cwiseMin(g.indexToLps(corner));
    high_ = high_.cwiseMax(g.indexToLps(corner));
  }
}

double OrganDomain::depth_mm(const Eigen::Vector3d& p_lps) const {
  const image::ScalarVolume& v = field_.values_mm;
  const Eigen::Vector3d index = toIndex_ * (p_lps - v.grid.origin_lps_mm);
  Eigen::Vector3i low;
  for (int a = 0; a < 3; ++a) {
    if (!(index[a] >= 0.0 && index[a] <= v.grid.size[a] - 1)) return -v.grid.spacing_mm.maxCoeff();
    low[a] = std::min(static_cast<int>(index[a]), v.grid.size[a] - 2);
  }
  const Eigen::Vector3d t = index - low.cast<double>();
  const float* first = v.values.data() + v.grid.linear(low);
  const auto row = static_cast<std::size_t>(v.grid.size.x());
  const std::size_t slice = row * static_cast<std::size_t>(v.grid.size.y());
  const auto along = [&](std::size_t at) {
    return (1.0 - t.x()) * static_cast<double>(first[at]) + t.x() * static_cast<double>(first[at + 1]);
  };
  return (1.0 - t.z()) * ((1.0 - t.y()) * along(0) + t.y() * along(row)) +
         t.z() * ((1.0 - t.y()) * along(slice) + t.y() * along(slice + row)) - field_.level_mm;
}

std::vector<Eigen::Vector3d> OrganDomain::pointsOnSurface(double apart_mm) const {
  const TriangleMesh mesh = isosurface(field_.values_mm, field_.level_mm, 0);
  const std::vector<int> part = partsOf(mesh);
  std::map<int, std::vector<Eigen::Index>> members;
  for (std::size_t v = 0; v < part.size(); ++v) members[part[v]].push_back(static_cast<Eigen::Index>(v));
  std::vector<Eigen::Vector3d> result;
  for (const auto& [name, vertices] : members) {
    // Farthest point first: they spread over the part.
    std::vector<double> away(vertices.size(), std::numeric_limits<double>::infinity());
    std::size_t next = 0;
    for (std::size_t n = 0; n < mostPoints && away[next] > (n < leastPoints ? 0.0 : apart_mm * apart_mm); ++n) {
      const Eigen::Vector3d p = mesh.vertices_lps_mm.col(vertices[next]);
      result.push_back(p);
      for (std::size_t v = 0; v < vertices.size(); ++v)
        away[v] = std::min(away[v], (mesh.vertices_lps_mm.col(vertices[v]) - p).squaredNorm());
      next = static_cast<std::size_t>(std::max_element(away.begin(), away.end()) - away.begin());
    }
  }
  return result;
}

}  // namespace glisson::anatomy
