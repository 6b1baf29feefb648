// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "elastography/stiffness_map.h"

namespace glisson::elastography {

/// Which values of a stiffness map are used, and held to what.
struct FillOptions {
  double confidenceThreshold = defaults::confidenceThreshold;  ///< of 1
  double low_kPa = 0.0;  ///< values are held to [low, high] before they are used; 0 and infinity: as measured
  double high_kPa = 1e30;
};

/// A modulus for every voxel of a body.
struct FilledStiffness {
  image::ScalarVolume values_kPa;  ///< on the grid of the body, same quantity as the map; 0 outside the body
  StiffnessQuantity quantity = StiffnessQuantity::Shear;
  image::Mask origin;  ///< 0 outside the body, 1 interpolated between trusted voxels, 2 filled from the nearest
  double filledFraction = 0.0;  ///< of the body's voxels, those with origin 2
  double farthest_mm = 0.0;     ///< largest distance from which a voxel was filled
};

/// Stiffness on the voxels of body (any grid). Only trusted voxels of the map count (finite, > 0, confident, and inside
/// roi, a mask on the map's grid, where it is not null: a wave outside the liver says nothing about the liver).
/// Within the map: trilinear over the trusted ones of the eight neighbours, their weights divided by their own sum, so
/// that a constant map stays constant and nothing beyond the border leaks in. Elsewhere (low confidence all round,
/// outside the slices): the mean of the trusted voxels within 2 pixels, in the same slice, of the nearest trusted
/// voxel; the mean keeps a single noisy border voxel from spreading. Throws BadInput where the body is empty, or no
/// voxel of the map can be trusted.
FilledStiffness fillStiffness(const StiffnessMap& map, const image::Mask& body, const image::Mask* roi = nullptr,
                              const FillOptions& options = {});

}  // namespace glisson::elastography
