#pragma once

#include <Eigen/Core>
#include <vector>

namespace glisson::mechanics {

/// A rigid round bar: all points within `radius_m` of a centre line of straight segments, ends and joints round. It
/// travels along `hoist` without turning. Grid axes, metres; the centre line is that at travel 0.
struct RigidBar {
  std::vector<Eigen::Vector3d> centreline_m;  ///< at least two points; one segment makes a capsule
  double radius_m = 0.005;
  Eigen::Vector3d hoist{0, -1, 0};  ///< unit

  void shift(const Eigen::Vector3d& by_m);
  Eigen::Vector3d centre_m() const;  ///< mean of the centre line, at travel 0
};

/// Signed distance of a point from the bar and its derivatives: ∇g = n, ∇∇g = (I − n nᵀ − t tᵀ)/ρ.
struct Gap {
  double g_m = 0;                                   ///< negative inside
  double rho_m = 0;                                 ///< distance from the centre line
  Eigen::Vector3d n = Eigen::Vector3d::Zero();      ///< unit, away from the bar
  Eigen::Vector3d t = Eigen::Vector3d::Zero();      ///< unit along the segment; 0 where an end or joint is nearest
};

/// Gap of the point p (m) with the bar at travel s (m).
Gap gapTo(const RigidBar& bar, const Eigen::Vector3d& p_m, double s_m);

/// The bar of a curved blade, in place of a straight one of the same length and centre: an arc of the given opening
/// angle in the plane of `axis` and `across`, bulging along `across`. Sixteen segments.
std::vector<Eigen::Vector3d> hookCentreline(const Eigen::Vector3d& centre_m, const Eigen::Vector3d& axis,
                                            const Eigen::Vector3d& across, double length_m, double angle_rad);

}  // namespace glisson::mechanics
