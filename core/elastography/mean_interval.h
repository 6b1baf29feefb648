// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "elastography/bootstrap.h"
#include "image/volume.h"

namespace glisson::elastography {

/// How well the mean of a map over a region is known, two ways; the larger standard error counts.
struct MeanInterval {
  /// Within slices: covariance nugget + sill exp(−(d/ℓ)^p), p 1 or 2, fitted to the variogram of pairs within a slice,
  /// and summed over all pairs of the region's voxels; slices count as independent.
  struct Correlation {
    double length_mm = 0.0;  ///< ℓ; 0: neighbours are not correlated
    double exponent = 2.0;   ///< p
    double effective = 1.0;  ///< independent voxels that know the mean as well, variance / se²
    double se_kPa = 0.0;
  } correlation;
  Interval bySlices;  ///< bootstrap over slices: what slices share among their voxels, whatever its reach
  std::size_t slices = 0;
  Interval mean;  ///< the larger se of the two, with Student's t of its degrees of freedom
};

/// Of the mean over the voxels of counts, a mask on the map's grid. Throws BadArgument where the grids differ.
MeanInterval meanInterval(const image::ScalarVolume& values_kPa, const image::Mask& counts);

}  // namespace glisson::elastography
