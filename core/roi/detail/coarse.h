// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "image/volume.h"

namespace glisson::roi::detail {

/// Means of blocks of voxels, each at least about edge_mm long (whole voxels; 1 where they are that large already).
/// Voxels that are not finite do not count; a block without finite ones holds the smallest finite value.
/// Throws BadInput where no voxel is finite.
image::ScalarVolume blockMeans(const image::ScalarVolume& image, double edge_mm);

/// Median over the ball of radius_mm around every voxel, its neighbours over faces in the slice at least.
image::ScalarVolume medianSmoothed(const image::ScalarVolume& image, double radius_mm);

/// Weighted mean of values around every voxel: a Gaussian of standard deviation sigma_mm over the voxels of mask, by
/// their distance (cut off at 2.5 sigma). 0 where none is in reach: see weight.
struct LocalMean {
  image::ScalarVolume mean, weight;
};
LocalMean localMean(const image::ScalarVolume& image, const image::Mask& mask, double sigma_mm);

/// The mask on another grid of the same place: inside where the signed distance to its surface, interpolated linearly,
/// is at least -out_mm.
image::Mask refined(const image::Mask& coarse, const image::Grid& grid, double out_mm);

}  // namespace glisson::roi::detail
