// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "roi/contour_stack.h"

namespace glisson::roi {

/// Slices of grid that hold no counting include polygon but lie between two that do, ascending. Throws BadInput as
/// rasterise does for the polygons themselves.
std::vector<int> emptySlicesBetween(const ContourStack& contours, const image::Grid& grid);

/// Shape-based interpolation [raya1990] of a mask: every empty slice between two slices with voxels gets the voxels
/// where the signed in-plane distances (mm, positive inside) to the outlines of these two slices, weighted linearly by
/// position, sum to more than 0. Slices with voxels stay as they are; nothing is added before the first or behind the
/// last. Where the shapes of the two slices do not overlap, slices between them may stay empty. Throws BadInput where
/// the mask is empty.
image::Mask interpolateSlices(const image::Mask& mask);

/// The same for outlines: contours, with polygons of state Interpolated appended for the slices of
/// emptySlicesBetween(). Holes and exclusions of the drawn slices are part of their shape. Vertices lie where the
/// interpolated distance is 0 (linear between voxel centres), simplified within a fifth of a pixel; parts of fewer than
/// leastVoxels voxels are left out. Polygons that are there already are kept, interpolated ones too. Throws BadInput as
/// rasterise does.
ContourStack interpolateBetween(const ContourStack& contours, const image::Grid& grid);

}  // namespace glisson::roi
