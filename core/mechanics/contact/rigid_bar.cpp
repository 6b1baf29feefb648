// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/contact/rigid_bar.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace glisson::mechanics {
namespace {

/// Distance and directions; on the centre line itself any direction is as good as another: back against the hoist.
Gap awayFrom(const RigidBar& bar, const Eigen::Vector3d& away, double rho_m) {
  Gap gap;
  gap.rho_m = rho_m;
  gap.g_m = rho_m - bar.radius_m;
  gap.n = rho_m > 1e-12 ? Eigen::Vector3d(away / rho_m) : bar.hoist;
  return gap;
}

Gap gapToArc(const RigidBar& bar, const Eigen::Vector3d& p) {
  const Arc& arc = *bar.arc;
  const Eigen::Vector3d q = p - arc.centre_m;
  const double x = q.dot(arc.middle), y = q.dot(arc.along), from_axis = std::hypot(x, y);
  if (std::abs(std::atan2(y, x)) > arc.half_rad || !(from_axis > 0)) {
    const Eigen::Vector3d away = p - arc.at(y < 0 ? -arc.half_rad : arc.half_rad);
    return awayFrom(bar, away, away.norm());
  }
  const Eigen::Vector3d out = (x * arc.middle + y * arc.along) / from_axis;
  const Eigen::Vector3d away = q - arc.radius_m * out;
  Gap gap = awayFrom(bar, away, away.norm());
  gap.t = (x * arc.along - y * arc.middle) / from_axis;
  gap.bend_1_m = gap.n.dot(out) / from_axis;
  return gap;
}

}  // namespace

Eigen::Vector3d Arc::at(double angle_rad) const {
  return centre_m + radius_m * (std::cos(angle_rad) * middle + std::sin(angle_rad) * along);
}

void RigidBar::shift(const Eigen::Vector3d& by_m) {
  for (Eigen::Vector3d& p : centreline_m) p += by_m;
  if (arc) arc->centre_m += by_m;
}

Eigen::Vector3d RigidBar::centre_m() const {
  if (arc) return arc->centre_m + arc->radius_m * std::sin(arc->half_rad) / arc->half_rad * arc->middle;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double length = 0;
  for (std::size_t i = 0; i + 1 < centreline_m.size(); ++i) {
    const double l = (centreline_m[i + 1] - centreline_m[i]).norm();
    sum += 0.5 * l * (centreline_m[i] + centreline_m[i + 1]);
    length += l;
  }
  return length > 0 ? Eigen::Vector3d(sum / length) : centreline_m.front();
}

Gap gapTo(const RigidBar& bar, const Eigen::Vector3d& p_m, double s_m) {
  const Eigen::Vector3d p = p_m - s_m * bar.hoist;
  if (bar.arc) return gapToArc(bar, p);
  double best = std::numeric_limits<double>::infinity();
  Eigen::Vector3d away = Eigen::Vector3d::Zero(), along = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i + 1 < bar.centreline_m.size(); ++i) {
    const Eigen::Vector3d& a = bar.centreline_m[i];
    const Eigen::Vector3d ab = bar.centreline_m[i + 1] - a;
    const double raw = (p - a).dot(ab) / ab.squaredNorm();
    const double at = std::clamp(raw, 0.0, 1.0);
    const Eigen::Vector3d d = p - a - at * ab;
    const double square = d.squaredNorm();
    if (square >= best) continue;
    best = square;
    away = d;
    along = raw > 0 && raw < 1 ? Eigen::Vector3d(ab.normalized()) : Eigen::Vector3d::Zero();
  }
  Gap gap = awayFrom(bar, away, std::sqrt(best));
  gap.t = along;
  return gap;
}

RigidBar hook(const Eigen::Vector3d& centre_m, const Eigen::Vector3d& axis, const Eigen::Vector3d& across,
              double length_m, double angle_rad) {
  constexpr int chords = 16;
  RigidBar bar;
  Arc arc{Eigen::Vector3d::Zero(), across, axis, length_m / angle_rad, angle_rad / 2};
  arc.centre_m = centre_m - arc.radius_m * std::sin(arc.half_rad) / arc.half_rad * across;
  for (int i = 0; i <= chords; ++i)
    bar.centreline_m.push_back(arc.at(angle_rad * (static_cast<double>(i) / chords - 0.5)));
  bar.arc = arc;
  return bar;
}

}  // namespace glisson::mechanics
