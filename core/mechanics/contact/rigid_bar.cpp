#include "mechanics/contact/rigid_bar.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace glisson::mechanics {

void RigidBar::shift(const Eigen::Vector3d& by_m) {
  for (Eigen::Vector3d& p : centreline_m) p += by_m;
}

Eigen::Vector3d RigidBar::centre_m() const {
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
  Gap gap;
  gap.rho_m = std::sqrt(best);
  gap.g_m = gap.rho_m - bar.radius_m;
  // On the centre line itself any direction is as good as another: back against the hoist.
  gap.n = gap.rho_m > 1e-12 ? Eigen::Vector3d(away / gap.rho_m) : Eigen::Vector3d(bar.hoist);
  gap.t = along;
  return gap;
}

std::vector<Eigen::Vector3d> hookCentreline(const Eigen::Vector3d& centre_m, const Eigen::Vector3d& axis,
                                            const Eigen::Vector3d& across, double length_m, double angle_rad) {
  constexpr int segments = 16;
  const double radius = length_m / angle_rad;
  std::vector<Eigen::Vector3d> line;
  for (int i = 0; i <= segments; ++i) {
    const double a = angle_rad * (static_cast<double>(i) / segments - 0.5);
    line.push_back(centre_m + radius * std::sin(a) * axis + radius * (std::cos(a) - std::sin(angle_rad / 2) * 2 / angle_rad) * across);
  }
  return line;
}

}  // namespace glisson::mechanics
