// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <initializer_list>
#include <numbers>
#include <utility>
#include <vector>

#include "roi/contour_stack.h"

namespace glisson::roi::test {

/// Upright, anisotropic, oblique and mirrored lattices.
inline std::vector<image::Grid> grids() {
  std::vector<image::Grid> result(5);
  for (image::Grid& g : result) {
    g.size = {24, 20, 5};
    g.origin_lps_mm = {-31.7, 12.3, 845.1};
  }
  result[1].spacing_mm = {0.7, 1.64, 10.0};
  result[2].spacing_mm = {1.64, 1.64, 10.0};
  result[2].direction = (Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, 3).normalized())).toRotationMatrix();
  result[3].spacing_mm = {1.1, 0.9, 3.0};
  result[3].direction = Eigen::Vector3d(-1, 1, 1).asDiagonal();
  result[4].spacing_mm = {1.3, 0.8, 5.0};
  result[4].direction = (Eigen::AngleAxisd(-1.1, Eigen::Vector3d(2, -1, 1).normalized())).toRotationMatrix() *
                        Eigen::Matrix3d(Eigen::Vector3d(1, -1, -1).asDiagonal());
  return result;
}

/// Polygon given in index coordinates of slice k.
inline Polygon polygon(const image::Grid& grid, double k, const std::vector<std::pair<double, double>>& ij) {
  Polygon p;
  p.points_lps_mm.resize(3, static_cast<Eigen::Index>(ij.size()));
  for (std::size_t v = 0; v < ij.size(); ++v)
    p.points_lps_mm.col(static_cast<Eigen::Index>(v)) = grid.indexToLps({ij[v].first, ij[v].second, k});
  return p;
}

inline Polygon rectangle(const image::Grid& grid, double k, double i0, double j0, double i1, double j1) {
  return polygon(grid, k, {{i0, j0}, {i1, j0}, {i1, j1}, {i0, j1}});
}

inline ContourStack stack(std::initializer_list<Polygon> polygons) {
  ContourStack s;
  s.polygons = polygons;
  return s;
}

inline std::size_t voxels(const image::Mask& mask) {
  std::size_t n = 0;
  for (const auto v : mask.values) n += v;
  return n;
}

}  // namespace glisson::roi::test
