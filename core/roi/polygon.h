// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "roi/contour_stack.h"

namespace glisson::roi {

/// Vertices of a closed polygon (3 x n) without those equal to the one before, the last before the first included.
Eigen::Matrix3Xd distinctRing(const Eigen::Matrix3Xd& points);

/// The ring without its second half where that repeats the first one point by point (within repeatedWithin_mm): an
/// outline that was stored twice as one. Empty where it does not.
std::optional<Eigen::Matrix3Xd> onceRound(const Eigen::Matrix3Xd& ring);

/// Whether two edges of the polygon meet anywhere else than at the vertex that neighbours share (crossing, touching, or
/// running over each other). Judged in the polygon's own plane.
bool selfCrosses(const Polygon& polygon);

/// Why a polygon cannot be accepted on this grid, as a sentence; empty where it can: at least three distinct vertices,
/// finite, parallel to the slices, at least four voxels inside.
std::optional<std::string> refusal(const Polygon& polygon, const image::Grid& grid);

/// Smallest number of voxels of an accepted polygon.
inline constexpr std::size_t leastVoxels = 4;

/// Leaves out vertices that lie within tolerance_mm of the line through the kept ones (Douglas-Peucker on the closed
/// ring); never fewer than three vertices. Throws BadArgument where tolerance_mm is negative.
Polygon simplified(const Polygon& polygon, double tolerance_mm);

/// Polygons whose rasterise() on mask.grid is exactly the mask: outlines and holes of every slice, vertices half-way
/// between inside and outside voxel centres, straight runs merged. No polygon crosses itself or another one. Pixels
/// that touch at a corner only are kept apart. Polygons of a slice with rings so thin that they would be taken for one
/// outline drawn twice (arrangement.h) are Combine::Parity. Throws BadInput where the mask is empty.
ContourStack contoursOf(const image::Mask& mask);

}  // namespace glisson::roi
