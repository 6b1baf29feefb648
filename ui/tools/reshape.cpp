// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/reshape.h"

#include <algorithm>
#include <cmath>

namespace glisson::tools {

Eigen::Matrix3Xd withHalvedEdges(const Eigen::Matrix3Xd& points, const std::vector<Eigen::Index>& chosen) {
  const Eigen::Index n = points.cols();
  std::vector<char> in(static_cast<std::size_t>(n), 0);
  for (const Eigen::Index v : chosen)
    if (v >= 0 && v < n) in[static_cast<std::size_t>(v)] = 1;
  std::vector<Eigen::Vector3d> out;
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Index next = (i + 1) % n;
    out.push_back(points.col(i));
    if (in[static_cast<std::size_t>(i)] && in[static_cast<std::size_t>(next)])
      out.push_back(0.5 * (points.col(i) + points.col(next)));
  }
  Eigen::Matrix3Xd longer(3, static_cast<Eigen::Index>(out.size()));
  for (std::size_t i = 0; i < out.size(); ++i) longer.col(static_cast<Eigen::Index>(i)) = out[i];
  return longer;
}

std::optional<std::pair<Eigen::Index, Eigen::Index>> cutBetween(Eigen::Index n,
                                                                const std::vector<Eigen::Index>& chosen) {
  if (chosen.size() != 2) return std::nullopt;
  const auto [a, b] = std::minmax(chosen[0], chosen[1]);
  const bool neighbours = b - a < 2 || (a == 0 && b == n - 1);
  if (neighbours || a < 0 || b >= n) return std::nullopt;
  return std::pair(a, b);
}

std::pair<Eigen::Matrix3Xd, Eigen::Matrix3Xd> cut(const Eigen::Matrix3Xd& points, Eigen::Index a, Eigen::Index b) {
  const Eigen::Index n = points.cols(), inner = b - a + 1, outer = n - b + a + 1;
  Eigen::Matrix3Xd first = points.middleCols(a, inner), second(3, outer);
  second.leftCols(a + 1) = points.leftCols(a + 1);
  second.rightCols(n - b) = points.rightCols(n - b);
  return {first, second};
}

Outline pushed(const Outline& outline, const Eigen::Vector2d& centre, double radius, double step) {
  const Eigen::Index n = outline.cols();
  std::vector<Eigen::Vector2d> out;
  bool touched = false;
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Vector2d a = outline.col(i), b = outline.col((i + 1) % n);
    const auto push = [&](const Eigen::Vector2d& p) -> Eigen::Vector2d {
      const double d = (p - centre).norm();
      if (d >= radius) return p;
      touched = true;
      // A point right in the centre has no direction of its own: it goes where its edge's normal points.
      if (d < 1e-9 * radius) {
        const Eigen::Vector2d along = (b - a).normalized();
        return centre + radius * Eigen::Vector2d(-along.y(), along.x());
      }
      return centre + (radius / d) * (p - centre);
    };
    out.push_back(push(a));
    if (distanceToSegment(centre, a, b) >= radius) continue;
    // Only the part of the edge within reach gets vertices of its own.
    const int parts = std::max(1, static_cast<int>(std::ceil((b - a).norm() / step)));
    for (int s = 1; s < parts; ++s) {
      const Eigen::Vector2d p = a + (b - a) * (static_cast<double>(s) / parts);
      if ((p - centre).norm() < radius + step) out.push_back(push(p));
    }
  }
  if (!touched && static_cast<Eigen::Index>(out.size()) == n) return outline;
  // Vertices that were pushed onto each other become one.
  std::vector<Eigen::Vector2d> kept;
  for (const Eigen::Vector2d& p : out)
    if (kept.empty() || (p - kept.back()).norm() > 0.25 * step || (p - centre).norm() > radius * (1.0 + 1e-9))
      kept.push_back(p);
  Outline result(2, static_cast<Eigen::Index>(kept.size()));
  for (std::size_t i = 0; i < kept.size(); ++i) result.col(static_cast<Eigen::Index>(i)) = kept[i];
  return result;
}

}  // namespace glisson::tools
