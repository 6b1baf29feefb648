// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "image/volume.h"

namespace glisson::anatomy {

/// Middle line of a tube-like mask.
struct Centreline {
  std::vector<Eigen::Vector3d> points_lps_mm;  ///< about one per voxel along the line
  std::vector<double> radius_mm;               ///< per point: median way to the tube's wall, across the line
  std::vector<std::array<int, 2>> edges;       ///< neighbours along the line, indices of points
};

/// Skeleton of the mask with side branches that do not leave the tube (shorter than 1.5 radii at their root) cut off,
/// ends trimmed where they bend into a corner of the tip, moved to the deepest place nearby across the line, and
/// smoothed along the line; within a radius of an end it follows the straight line before. Grids whose spacings
/// differ by more than a quarter are first made isotropic by shape (surface.h). An empty mask gives no points.
Centreline centrelineOf(const image::Mask& mask);

}  // namespace glisson::anatomy
