// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "mechanics/contact/triangle_surface.h"

namespace glisson::retraction {

/// Axes of a hoist, unit vectors in LPS: along the hoist; up, the direction nearest to the head across it; and aside,
/// across both, towards the patient's left. A hoist along z takes anterior as up.
struct HoistFrame {
  Eigen::Vector3d hoist, up, aside;
  explicit HoistFrame(const Eigen::Vector3d& direction);
};

/// What of a bar's length bears, seen along the hoist.
struct BarView {
  double covered_mm = 0.0;    ///< length of the bar with liver before it
  double thickness_mm = 0.0;  ///< of the liver before it along the hoist, mean over what is covered
  double slope = 0.0;         ///< of the surface along the bar: mm along the hoist per mm, least squares
  double tilt = 0.0;          ///< the same across the bar, towards `up` turned with the bar
};

/// A closed surface seen from far behind along a hoist: per pixel of 1 mm across the hoist, how deep the surface lies
/// and how thick the body is from there to where it first ends.
class HoistView {
 public:
  HoistView(const mechanics::TriangleSurface& surface_lps_mm, const HoistFrame& frame);

  const HoistFrame& frame() const { return frame_; }
  /// Range of the surface along aside and up, mm.
  const Eigen::Vector2d& low_mm() const { return low_mm_; }
  const Eigen::Vector2d& high_mm() const { return high_mm_; }

  /// The body along the hoist.
  struct Ray {
    double depth_mm;      ///< along the hoist, from the origin of LPS
    double thickness_mm;  ///< of the first stretch inside
  };
  /// Of the pixel at a place (aside, up); nothing where the body is not met.
  std::optional<Ray> ray(const Eigen::Vector2d& at_mm) const;

  /// A bar of this length and diameter, its middle at a place (aside, up), turned by an angle from aside towards up.
  BarView bar(const Eigen::Vector2d& at_mm, double angle_rad, double length_mm, double diameter_mm) const;

 private:
  HoistFrame frame_;
  Eigen::Vector2d low_mm_, high_mm_;
  Eigen::Vector2i size_;
  std::vector<float> depth_mm_, thickness_mm_;  ///< per pixel, aside fastest; thickness < 0: not met
};

}  // namespace glisson::retraction
