// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "image/volume.h"

namespace glisson::image {

/// Erosion within each slice by a disk of the given radius in pixels (index units; pixels ≥ 0): a voxel stays where
/// every voxel of its slice with di² + dj² ≤ pixels² is inside. Beyond the image counts as outside.
Mask erodeInPlane(const Mask& mask, int pixels);

/// Voxels whose centre lies deeper than radius_mm below the surface of the voxel solid (a ball, exact on anisotropic
/// grids). An empty mask stays empty. Throws BadArgument where radius_mm is negative or not finite.
Mask erode(const Mask& mask, double radius_mm);

/// Voxels inside, or whose centre lies at most radius_mm off the surface. erode(m, r) is the complement of dilating the
/// complement, away from the border of the image.
Mask dilate(const Mask& mask, double radius_mm);

/// Number of voxels inside.
std::size_t count(const Mask& mask);

/// Whether a voxel lies inside both. Throws BadArgument where the masks are of different sizes.
bool overlap(const Mask& a, const Mask& b);

/// Smallest and largest index inside along each axis; nothing for an empty mask.
struct Extent {
  Eigen::Vector3i low, high;
};
std::optional<Extent> extentOf(const Mask& mask);

}  // namespace glisson::image
