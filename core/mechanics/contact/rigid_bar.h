// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace glisson::mechanics {

/// An arc of a circle, m.
struct Arc {
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();  ///< of the circle
  Eigen::Vector3d middle{0, 1, 0};                     ///< unit, from there to the middle of the arc
  Eigen::Vector3d along{1, 0, 0};                      ///< unit, the arc's direction at its middle
  double radius_m = 0;
  double half_rad = 0;  ///< half of the opening angle, at most π

  Eigen::Vector3d at(double angle_rad) const;  ///< counted from the middle
};

/// A rigid round bar: all points within `radius_m` of a centre line, its ends round. The centre line is an arc, or of
/// straight segments with round joints. It travels along `hoist` without turning. Grid axes, metres; places are those
/// at travel 0.
struct RigidBar {
  std::vector<Eigen::Vector3d>
      centreline_m;  ///< at least two points; one segment makes a capsule; of an arc: to draw it
  double radius_m = 0.005;
  Eigen::Vector3d hoist{0, -1, 0};  ///< unit
  std::optional<Arc> arc = std::nullopt;

  Eigen::Vector3d centre_m() const;  ///< mean of the centre line, at travel 0
  void shift(const Eigen::Vector3d& by_m);
};

/// Signed distance of a point from the bar and its derivatives: ∇g = n, ∇∇g = (I − n nᵀ − t tᵀ)/ρ + bend t tᵀ.
struct Gap {
  double g_m = 0;                               ///< negative inside
  double rho_m = 0;                             ///< distance from the centre line
  Eigen::Vector3d n = Eigen::Vector3d::Zero();  ///< unit, away from the bar
  Eigen::Vector3d t = Eigen::Vector3d::Zero();  ///< unit along the centre line; 0 where an end or joint is nearest
  double bend_1_m = 0;                          ///< curvature along t: 0 beside a straight bar

  Eigen::Matrix3d curvature() const {
    const Eigen::Matrix3d tt = t * t.transpose();
    return (Eigen::Matrix3d::Identity() - n * n.transpose() - tt) / rho_m + bend_1_m * tt;
  }
};

/// Gap of the point p (m) with the bar at travel s (m).
Gap gapTo(const RigidBar& bar, const Eigen::Vector3d& p_m, double s_m);

/// The bar of a curved blade, in place of a straight one of the same length and centre: an arc of the given opening
/// angle in the plane of `axis` and `across`, bulging along `across`. The points of its centre line are those of
/// sixteen chords.
RigidBar hook(const Eigen::Vector3d& centre_m, const Eigen::Vector3d& axis, const Eigen::Vector3d& across,
              double length_m, double angle_rad);

}  // namespace glisson::mechanics
