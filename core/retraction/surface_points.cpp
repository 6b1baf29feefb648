// SPDX-License-Identifier: GPL-3.0-or-later
#include "retraction/surface_points.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"

namespace glisson::retraction {
namespace {

/// Barycentric weights of the point of a triangle that is nearest to p.
Eigen::Vector3d nearestWeights(const std::array<Eigen::Vector3d, 3>& x, const Eigen::Vector3d& p) {
  const Eigen::Vector3d n = (x[1] - x[0]).cross(x[2] - x[0]);
  Eigen::Vector3d w;
  for (std::size_t i = 0; i < 3; ++i)
    w[static_cast<Eigen::Index>(i)] =
        (x[(i + 2) % 3] - x[(i + 1) % 3]).cross(p - x[(i + 1) % 3]).dot(n) / n.squaredNorm();
  if (w.minCoeff() >= 0.0) return w / w.sum();
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {  // beyond an edge: the nearest point lies on one
    const std::size_t j = (i + 1) % 3;
    const Eigen::Vector3d edge = x[j] - x[i];
    const double t = std::clamp((p - x[i]).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
    const double away = (x[i] + t * edge - p).squaredNorm();
    if (away >= best) continue;
    best = away;
    w.setZero();
    w[static_cast<Eigen::Index>(i)] = 1.0 - t;
    w[static_cast<Eigen::Index>(j)] = t;
  }
  return w;
}

}  // namespace

SurfaceFinder::SurfaceFinder(const mechanics::TetMesh& mesh) : mesh_(mesh) {
  for (const mechanics::TetFace& face : mechanics::exteriorFaces(mesh)) {
    Triangle t;
    t.face = face;
    const std::vector<int> nodes = mechanics::nodesOf(mesh, face);
    for (std::size_t c = 0; c < 3; ++c) t.corner[c] = mesh.nodes_m.col(nodes[c]);
    t.centre = (t.corner[0] + t.corner[1] + t.corner[2]) / 3.0;
    for (const Eigen::Vector3d& c : t.corner) t.radius = std::max(t.radius, (c - t.centre).norm());
    triangles_.push_back(t);
  }
}

SurfacePoint SurfaceFinder::nearest(const Eigen::Vector3d& p) const {
  // The nearest centre bounds the answer; only triangles whose sphere comes closer are looked at.
  double bound = std::numeric_limits<double>::infinity();
  for (const Triangle& t : triangles_) bound = std::min(bound, (t.centre - p).norm());
  bound *= 1.0 + 1e-12;
  SurfacePoint best;
  double least = std::numeric_limits<double>::infinity();
  for (const Triangle& t : triangles_) {
    const double reach = bound + t.radius;
    if ((t.centre - p).squaredNorm() > reach * reach) continue;
    const Eigen::Vector3d w = nearestWeights(t.corner, p);
    const Eigen::Vector3d at = w[0] * t.corner[0] + w[1] * t.corner[1] + w[2] * t.corner[2];
    const double away = (at - p).squaredNorm();
    if (away >= least) continue;
    least = away;
    bound = std::min(bound, std::sqrt(away));
    best = {t.face, w, at};
  }
  return best;
}

std::vector<SurfacePoint> SurfaceFinder::nearest(const std::vector<Eigen::Vector3d>& points_m) const {
  std::vector<SurfacePoint> result(points_m.size());
  parallelChunks(points_m.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) result[i] = nearest(points_m[i]);
  });
  return result;
}

std::vector<std::pair<int, double>> SurfaceFinder::shares(const SurfacePoint& place) const {
  const std::vector<int> n = mechanics::nodesOf(mesh_, place.face);
  const Eigen::Vector3d& w = place.weight;
  if (n.size() == 3) return {{n[0], w[0]}, {n[1], w[1]}, {n[2], w[2]}};
  // Middles 3, 4, 5 lie between corners 01, 12, 20.
  Eigen::Index most = 0;
  if (w.maxCoeff(&most) >= 0.5) {
    const auto c = static_cast<std::size_t>(most);
    const double next = w[(most + 1) % 3], last = w[(most + 2) % 3];
    return {{n[c], 1.0 - 2.0 * (next + last)}, {n[3 + c], 2.0 * next}, {n[3 + (c + 2) % 3], 2.0 * last}};
  }
  return {{n[3], 1.0 - 2.0 * w[2]}, {n[4], 1.0 - 2.0 * w[0]}, {n[5], 1.0 - 2.0 * w[1]}};
}

}  // namespace glisson::retraction
