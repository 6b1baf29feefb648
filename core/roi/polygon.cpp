// SPDX-License-Identifier: GPL-3.0-or-later
#include "roi/polygon.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/error.h"
#include "image/morphology.h"
#include "roi/arrangement.h"
#include "roi/plane.h"

namespace glisson::roi {
namespace {

double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const Eigen::Vector2d u = b - a, v = c - a;
  return u.x() * v.y() - u.y() * v.x();
}

int sign(double x) {
  return (x > 0.0) - (x < 0.0);
}

bool between(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p) {
  return (p.array() >= a.array().min(b.array())).all() && (p.array() <= a.array().max(b.array())).all();
}

bool meet(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c, const Eigen::Vector2d& d) {
  const int s1 = sign(turn(a, b, c)), s2 = sign(turn(a, b, d)), s3 = sign(turn(c, d, a)), s4 = sign(turn(c, d, b));
  if (s1 * s2 < 0 && s3 * s4 < 0) return true;
  return (s1 == 0 && between(a, b, c)) || (s2 == 0 && between(a, b, d)) || (s3 == 0 && between(c, d, a)) ||
         (s4 == 0 && between(c, d, b));
}

double distanceToSegment(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d d = b - a;
  const double length2 = d.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp((p - a).dot(d) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * d).norm();
}

}  // namespace

Eigen::Matrix3Xd distinctRing(const Eigen::Matrix3Xd& points) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    if (kept.empty() || points.col(i) != points.col(kept.back())) kept.push_back(i);
  while (kept.size() > 1 && points.col(kept.back()) == points.col(kept.front())) kept.pop_back();
  Eigen::Matrix3Xd ring(3, static_cast<Eigen::Index>(kept.size()));
  for (std::size_t i = 0; i < kept.size(); ++i) ring.col(static_cast<Eigen::Index>(i)) = points.col(kept[i]);
  return ring;
}

std::optional<Eigen::Matrix3Xd> onceRound(const Eigen::Matrix3Xd& ring) {
  const Eigen::Index half = ring.cols() / 2;
  if (ring.cols() % 2 != 0 || half < 3) return std::nullopt;
  const double farthest_mm = (ring.leftCols(half) - ring.rightCols(half)).colwise().norm().maxCoeff();
  // Of an outline as small as that nothing is repeated, but turned back on itself.
  const double size_mm = (ring.rowwise().maxCoeff() - ring.rowwise().minCoeff()).norm();
  if (farthest_mm > repeatedWithin_mm || size_mm < 4.0 * repeatedWithin_mm) return std::nullopt;
  return ring.leftCols(half).eval();
}

bool selfCrosses(const Polygon& polygon) {
  Polygon ring = polygon;
  ring.points_lps_mm = distinctRing(polygon.points_lps_mm);
  if (ring.points_lps_mm.cols() < 3) return false;
  const Plane plane = planeOf(ring);
  const Eigen::Matrix2Xd uv =
      plane.axes.leftCols<2>().transpose() * (ring.points_lps_mm.colwise() - plane.centre_lps_mm);
  const Eigen::Index n = uv.cols();
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Vector2d a = uv.col(i), b = uv.col((i + 1) % n), after = uv.col((i + 2) % n);
    // Neighbours share b; they overlap only where the next edge turns straight back.
    if (turn(a, b, after) == 0.0 && (a - b).dot(after - b) > 0.0) return true;
    for (Eigen::Index j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;
      const Eigen::Vector2d c = uv.col(j), d = uv.col((j + 1) % n);
      if (std::max(a.x(), b.x()) < std::min(c.x(), d.x()) || std::max(c.x(), d.x()) < std::min(a.x(), b.x())) continue;
      if (meet(a, b, c, d)) return true;
    }
  }
  return false;
}

std::optional<std::string> refusal(const Polygon& polygon, const image::Grid& grid) {
  std::vector<Eigen::Vector3d> distinct;
  for (Eigen::Index i = 0; i < polygon.points_lps_mm.cols() && distinct.size() < 3; ++i)
    if (std::find(distinct.begin(), distinct.end(), polygon.points_lps_mm.col(i)) == distinct.end())
      distinct.emplace_back(polygon.points_lps_mm.col(i));
  if (distinct.size() < 3)
    return "the polygon has " + std::to_string(distinct.size()) + " distinct vertices; at least 3 are needed";
  ContourStack alone;
  alone.polygons.push_back(polygon);
  alone.polygons.front().exclude = false;
  alone.polygons.front().state = PolygonState::Accepted;
  try {
    const std::size_t voxels = image::count(rasterise(alone, grid));
    if (voxels < leastVoxels)
      return "the polygon holds " + std::to_string(voxels) + " voxel centres; at least " + std::to_string(leastVoxels) +
             " are needed";
  } catch (const BadInput& reason) {
    return reason.what();
  }
  return std::nullopt;
}

Polygon simplified(const Polygon& polygon, double tolerance_mm) {
  if (!(tolerance_mm >= 0.0))
    throw BadArgument("a simplification tolerance of " + std::to_string(tolerance_mm) + " mm; it must be at least 0");
  Polygon result = polygon;
  const Eigen::Matrix3Xd ring = distinctRing(polygon.points_lps_mm);
  const Eigen::Index n = ring.cols();
  if (n <= 3) return result;
  // The ring is cut at its first vertex and at the one farthest from it, the two ends of an open chain each.
  Eigen::Index far = 0;
  (ring.colwise() - ring.col(0)).colwise().squaredNorm().maxCoeff(&far);
  std::vector<bool> keep(static_cast<std::size_t>(n), false);
  keep[0] = keep[static_cast<std::size_t>(far)] = true;
  std::vector<std::pair<Eigen::Index, Eigen::Index>> open{{0, far}, {far, n}};
  Eigen::Index farthest = -1;
  double farthest_mm = -1.0;
  while (!open.empty()) {
    const auto [from, to] = open.back();
    open.pop_back();
    Eigen::Index worst = -1;
    double worst_mm = -1.0;
    for (Eigen::Index i = from + 1; i < to; ++i) {
      const double d_mm = distanceToSegment(ring.col(i), ring.col(from), ring.col(to % n));
      if (d_mm > worst_mm) {
        worst_mm = d_mm;
        worst = i;
      }
    }
    if (worst < 0) continue;
    if (worst_mm > tolerance_mm) {
      keep[static_cast<std::size_t>(worst)] = true;
      open.emplace_back(from, worst);
      open.emplace_back(worst, to);
    } else if (worst_mm > farthest_mm) {
      farthest_mm = worst_mm;
      farthest = worst;
    }
  }
  if (std::count(keep.begin(), keep.end(), true) < 3) keep[static_cast<std::size_t>(farthest)] = true;
  result.points_lps_mm.resize(3, std::count(keep.begin(), keep.end(), true));
  Eigen::Index at = 0;
  for (Eigen::Index i = 0; i < n; ++i)
    if (keep[static_cast<std::size_t>(i)]) result.points_lps_mm.col(at++) = ring.col(i);
  return result;
}

}  // namespace glisson::roi
