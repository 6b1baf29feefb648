// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "image/volume.h"

namespace glisson::image {

/// The lattice with its axes in another order: axis a of the result is axis axes[a] of the grid. Every voxel stays
/// where it lies in the patient. axes: a permutation of 0, 1, 2; throws BadArgument otherwise.
Grid permuted(const Grid& grid, const std::array<int, 3>& axes);

/// The voxels on that lattice, so that its slices are reformats of the volume.
ScalarVolume permuted(const ScalarVolume& volume, const std::array<int, 3>& axes);

}  // namespace glisson::image
