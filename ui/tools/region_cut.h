// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "image/volume.h"

namespace glisson::tools {

/// A border between a pixel of a slice that lies in a region and one that does not, in pixels of the slice: from one
/// corner of the pixels to the next (half-integer coordinates).
struct BorderEdge {
  Eigen::Vector2d from, to;
};

/// How a slice k of a grid cuts a region given on any grid: the border of its pixels whose centre lies in a voxel of
/// the region. What counts is seen as it counts, steps between slices included. Collinear edges that follow each other
/// along a row or a column are one.
std::vector<BorderEdge> cutOf(const image::Mask& region, const image::Grid& grid, int k);

}  // namespace glisson::tools
