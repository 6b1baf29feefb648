// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/random.h"

namespace glisson::phantom {

/// Implicit shapes: a signed distance is negative inside, in mm, exact to first order near the surface.
using Point = Eigen::Vector3d;  ///< LPS, mm

/// An ellipsoid in any position.
struct Ellipsoid {
  Point centre_lps_mm = Point::Zero();
  Point radii_mm = Point::Ones();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns: the ellipsoid's own axes in LPS

  double distance_mm(const Point& p) const {
    const Point q = axes.transpose() * (p - centre_lps_mm);
    const Point s = q.cwiseQuotient(radii_mm);
    const double k0 = s.norm();
    const double k1 = s.cwiseQuotient(radii_mm).norm();
    return k1 < 1e-9 ? -radii_mm.minCoeff() : k0 * (k0 - 1.0) / k1;
  }
};

/// Rotation by the given angles about x, then y, then z (degrees).
Eigen::Matrix3d rotation(double x_deg, double y_deg, double z_deg);

/// Minimum of two distances with a rounded seam of width k_mm; never larger than std::min.
inline double smoothMin(double a, double b, double k_mm) {
  const double h = std::max(k_mm - std::abs(a - b), 0.0) / k_mm;
  return std::min(a, b) - 0.25 * h * h * k_mm;
}
inline double smoothMax(double a, double b, double k_mm) {
  return -smoothMin(-a, -b, k_mm);
}
/// What is in a and not in b.
inline double without(double a, double b, double k_mm) {
  return smoothMax(a, -b, k_mm);
}

/// From 0 at `from` to 1 at `to`, level at both ends.
inline double smoothStep(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// Independent generator for one purpose (salt) of one seed.
inline Random derived(std::uint64_t seed, std::uint64_t salt) {
  Random mix(seed ^ (salt * 0xd1342543de82ef95ULL + 0x632be59bd9b4e019ULL));
  mix.next();
  return Random(mix.next());
}

/// Smooth gradient noise over space, about [-1, 1], zero mean, correlation length about half of period_mm.
double noise(const Point& p, double period_mm, std::uint64_t seed);

/// A straight tube piece from a to b.
struct Capsule {
  Point a_lps_mm;
  Point b_lps_mm;
  double radius_mm = 0.0;
  double distance_mm(const Point& p) const;
};

/// Shortest distance between the segments a0-a1 and b0-b1, mm.
double segmentDistance_mm(const Point& a0, const Point& a1, const Point& b0, const Point& b1);

}  // namespace glisson::phantom
