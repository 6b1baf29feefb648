// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "image/volume.h"

namespace glisson::anatomy::test {

struct Lattice {
  std::string name;
  image::Grid grid;
};

/// Lattices over a box of half width half_mm round centre: fine, thick-sliced, oblique, mirrored.
inline std::vector<Lattice> lattices(const Eigen::Vector3d& centre, double half_mm, const Eigen::Vector3d& spacing_mm) {
  std::vector<Lattice> result;
  const std::vector<std::pair<std::string, Eigen::Matrix3d>> axes = {
      {"upright", Eigen::Matrix3d::Identity()},
      {"mirrored", Eigen::Vector3d(1, -1, 1).asDiagonal()},
      {"oblique", Eigen::AngleAxisd(0.5, Eigen::Vector3d(1, 2, -0.5).normalized()).toRotationMatrix()},
      {"oblique and mirrored", Eigen::AngleAxisd(-0.35, Eigen::Vector3d(0.3, 1, 1).normalized()).toRotationMatrix() *
                                   Eigen::Matrix3d(Eigen::Vector3d(-1, -1, -1).asDiagonal())}};
  for (const auto& [name, direction] : axes) {
    image::Grid g;
    g.direction = direction;
    g.spacing_mm = spacing_mm;
    for (int a = 0; a < 3; ++a) g.size[a] = static_cast<int>(std::ceil(2.0 * half_mm / spacing_mm[a])) + 1;
    const Eigen::Vector3d middle = 0.5 * (g.size.cast<double>().array() - 1.0).matrix();
    g.origin_lps_mm = centre - direction * spacing_mm.cwiseProduct(middle) + Eigen::Vector3d(0.31, -0.17, 0.23);
    result.push_back({name, g});
  }
  return result;
}

inline image::Mask maskOf(const image::Grid& g, const std::function<bool(const Eigen::Vector3d&)>& inside) {
  image::Mask m(g);
  for (int k = 0; k < g.size.z(); ++k)
    for (int j = 0; j < g.size.y(); ++j)
      for (int i = 0; i < g.size.x(); ++i) m.at(i, j, k) = inside(g.indexToLps(Eigen::Vector3d(i, j, k))) ? 1 : 0;
  return m;
}

inline double distanceToSegment(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d d = b - a;
  return (p - a - std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0) * d).norm();
}

}  // namespace glisson::anatomy::test
