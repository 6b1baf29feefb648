// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "inversion/waves.h"

namespace glisson::inversion::detail {

/// Voxels where some offset was cut off at an end of the stored range (phases unwrapped before they were stored); empty
/// where the series is not clipped. It is where more than one in a thousand of the voxels that move stay at the same
/// end from one offset to the next: phases that wrap, and noise, do not rest at the very end of the scale.
image::Mask clippedVoxels(const PhaseOffsets& direction);

/// The first harmonic of clipped voxels, from the offsets that were not cut off: least squares for a constant and one
/// harmonic, where at least four are left. Other clipped voxels leave the mask. wave and noise of clipped voxels are
/// replaced; their noise is unknown: zero.
void fitUnclipped(const PhaseOffsets& direction, const image::Mask& clipped, Waves::Direction& out, image::Mask& mask);

}  // namespace glisson::inversion::detail
