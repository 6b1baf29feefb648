// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>

#include "image/volume.h"

namespace glisson::image {

/// Index of the voxel whose box holds p_lps (half-open: a point on the border of two voxels belongs to the higher
/// index); empty outside the volume. Rounding of up to 1e-6 voxel is absorbed, so that coincident lattices map exactly.
std::optional<Eigen::Vector3i> voxelAt(const Grid& grid, const Eigen::Vector3d& p_lps);

/// Trilinear value at p_lps (LPS mm). The volume ends at the outer faces of its voxels; in the outermost half voxel the
/// border value holds. outside: returned beyond. A value that is not finite spreads to where its weight is not zero.
float sampleLinear(const ScalarVolume& volume, const Eigen::Vector3d& p_lps, float outside);

/// sampleLinear at every voxel centre of target.
ScalarVolume resampleLinear(const ScalarVolume& volume, const Grid& target, float outside);

/// Value of the voxel that holds each voxel centre of target (see voxelAt); 0 outside.
Mask resampleNearest(const Mask& mask, const Grid& target);
LabelMap resampleNearest(const LabelMap& labels, const Grid& target);
/// The same for values; outside: value beyond the volume.
ScalarVolume resampleNearest(const ScalarVolume& volume, const Grid& target, float outside);

}  // namespace glisson::image
