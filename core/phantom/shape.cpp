// SPDX-License-Identifier: GPL-3.0-or-later
#include "phantom/detail/shape.h"

#include <Eigen/Geometry>
#include <numbers>

namespace glisson::phantom {
namespace {

// Dot product of a hashed lattice gradient with the offset from that lattice point. The twelve edge directions of a
// cube are enough for an isotropic look and need no normalising [perlin2002improving].
double gradientDot(std::int64_t i, std::int64_t j, std::int64_t k, std::uint64_t seed, double x, double y, double z) {
  std::uint64_t h = seed + static_cast<std::uint64_t>(i) * 0x9e3779b97f4a7c15ULL +
                    static_cast<std::uint64_t>(j) * 0xc2b2ae3d27d4eb4fULL +
                    static_cast<std::uint64_t>(k) * 0x165667b19e3779f9ULL;
  h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9ULL;
  h = (h ^ (h >> 27)) * 0x94d049bb133111ebULL;
  h ^= h >> 31;
  const unsigned axis = static_cast<unsigned>((h >> 8) % 3);
  const double s = (h & 1U) ? 1.0 : -1.0;
  const double t = (h & 2U) ? 1.0 : -1.0;
  if (axis == 0) return s * y + t * z;
  if (axis == 1) return s * x + t * z;
  return s * x + t * y;
}

double fade(double t) {
  return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}
double mix(double a, double b, double t) {
  return a + t * (b - a);
}

}  // namespace

Eigen::Matrix3d rotation(double x_deg, double y_deg, double z_deg) {
  constexpr double rad = std::numbers::pi / 180.0;
  return (Eigen::AngleAxisd(z_deg * rad, Point::UnitZ()) * Eigen::AngleAxisd(y_deg * rad, Point::UnitY()) *
          Eigen::AngleAxisd(x_deg * rad, Point::UnitX()))
      .toRotationMatrix();
}

double noise(const Point& p, double period_mm, std::uint64_t seed) {
  const Point q = p / period_mm;
  const Point base(std::floor(q.x()), std::floor(q.y()), std::floor(q.z()));
  const Point f = q - base;
  const auto i = static_cast<std::int64_t>(base.x());
  const auto j = static_cast<std::int64_t>(base.y());
  const auto k = static_cast<std::int64_t>(base.z());
  const double u = fade(f.x());
  const double v = fade(f.y());
  const double w = fade(f.z());
  auto corner = [&](int a, int b, int c) {
    return gradientDot(i + a, j + b, k + c, seed, f.x() - a, f.y() - b, f.z() - c);
  };
  const double low = mix(mix(corner(0, 0, 0), corner(1, 0, 0), u), mix(corner(0, 1, 0), corner(1, 1, 0), u), v);
  const double high = mix(mix(corner(0, 0, 1), corner(1, 0, 1), u), mix(corner(0, 1, 1), corner(1, 1, 1), u), v);
  return mix(low, high, w);
}

double Capsule::distance_mm(const Point& p) const {
  const Point d = b_lps_mm - a_lps_mm;
  const double length2 = d.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp((p - a_lps_mm).dot(d) / length2, 0.0, 1.0) : 0.0;
  return (p - a_lps_mm - t * d).norm() - radius_mm;
}

double segmentDistance_mm(const Point& a0, const Point& a1, const Point& b0, const Point& b1) {
  // Closest points of two segments [ericson2005realtime, section 5.1.9].
  const Point d1 = a1 - a0;
  const Point d2 = b1 - b0;
  const Point r = a0 - b0;
  const double a = d1.squaredNorm();
  const double e = d2.squaredNorm();
  const double f = d2.dot(r);
  double s = 0.0;
  double t = 0.0;
  if (a <= 1e-12 && e <= 1e-12) return r.norm();
  if (a <= 1e-12) {
    t = std::clamp(f / e, 0.0, 1.0);
  } else {
    const double c = d1.dot(r);
    if (e <= 1e-12) {
      s = std::clamp(-c / a, 0.0, 1.0);
    } else {
      const double b = d1.dot(d2);
      const double denominator = a * e - b * b;
      if (denominator > 1e-12) s = std::clamp((b * f - c * e) / denominator, 0.0, 1.0);
      t = (b * s + f) / e;
      if (t < 0.0) {
        t = 0.0;
        s = std::clamp(-c / a, 0.0, 1.0);
      } else if (t > 1.0) {
        t = 1.0;
        s = std::clamp((b - c) / a, 0.0, 1.0);
      }
    }
  }
  return (r + s * d1 - t * d2).norm();
}

}  // namespace glisson::phantom
