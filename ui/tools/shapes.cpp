// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace glisson::tools {

namespace {

constexpr int fewest = 12, most = 360;
constexpr int finest = 64;  ///< pieces of the curve between two points

}  // namespace

Outline ellipse(const Eigen::Vector2d& from, const Eigen::Vector2d& to, bool circle, double tolerance_mm) {
  Eigen::Vector2d size = to - from;
  if (circle) {
    const double side = size.cwiseAbs().maxCoeff();
    size = Eigen::Vector2d(std::copysign(side, size.x()), std::copysign(side, size.y()));
  }
  const Eigen::Vector2d centre = from + 0.5 * size, half = 0.5 * size.cwiseAbs();
  if (!(half.minCoeff() > 0.0)) return Outline(2, 0);
  // Of the height of an arc over its chord, equal areas leave two thirds outside at the vertices.
  const double cosine = std::clamp(1.0 - 1.5 * tolerance_mm / half.maxCoeff(), -1.0, 1.0);
  const int n =
      std::clamp(static_cast<int>(std::ceil(std::numbers::pi / std::max(std::acos(cosine), 1e-3))), fewest, most);
  const double step = 2.0 * std::numbers::pi / n;
  const double larger = std::sqrt(step / std::sin(step));
  Outline ring(2, n);
  for (int v = 0; v < n; ++v)
    ring.col(v) = centre + larger * half.cwiseProduct(Eigen::Vector2d(std::cos(v * step), std::sin(v * step)));
  return ring;
}

Outline closedSpline(const Outline& through, double tolerance_mm) {
  std::vector<Eigen::Vector2d> knots;
  for (const auto p : through.colwise())
    if (knots.empty() || p != knots.back()) knots.push_back(p);
  while (knots.size() > 1 && knots.front() == knots.back()) knots.pop_back();
  const auto n = knots.size();
  if (n < 3) return through;
  std::vector<Eigen::Vector2d> curve;
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d p[4] = {knots[(i + n - 1) % n], knots[i], knots[(i + 1) % n], knots[(i + 2) % n]};
    double t[4] = {0.0};
    for (int k = 1; k < 4; ++k) t[k] = t[k - 1] + std::sqrt((p[k] - p[k - 1]).norm());
    const auto blend = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b, double ta, double tb, double at) {
      return Eigen::Vector2d(((tb - at) * a + (at - ta) * b) / (tb - ta));
    };
    const auto at = [&](double s) {
      const Eigen::Vector2d a = blend(p[0], p[1], t[0], t[1], s), b = blend(p[1], p[2], t[1], t[2], s),
                            c = blend(p[2], p[3], t[2], t[3], s);
      return blend(blend(a, b, t[0], t[2], s), blend(b, c, t[1], t[3], s), t[1], t[2], s);
    };
    // Sampled finely, then without what lies on straight runs.
    Outline piece(2, finest + 1);
    for (int s = 0; s <= finest; ++s) piece.col(s) = at(t[1] + (t[2] - t[1]) * s / finest);
    piece.col(0) = p[1];
    piece.col(finest) = p[2];
    const std::vector<Eigen::Index> kept = simplify(piece, tolerance_mm);
    for (std::size_t k = 0; k + 1 < kept.size(); ++k) curve.emplace_back(piece.col(kept[k]));
  }
  Outline ring(2, static_cast<Eigen::Index>(curve.size()));
  for (std::size_t v = 0; v < curve.size(); ++v) ring.col(static_cast<Eigen::Index>(v)) = curve[v];
  return ring;
}

}  // namespace glisson::tools
