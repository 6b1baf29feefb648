// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "image/volume.h"
#include "roi/contour_stack.h"

namespace glisson::phantom {

/// Contours of distance_mm < 0 (voxel-centre samples of a signed distance) on every slice, as a careful hand draws
/// them: vertices unevenly spaced, off the true edge by a smooth wobble of at most one pixel. Loops under 60 mm² are
/// left out. Polygons never cross themselves. Holes come as polygons of their own (even-odd rule).
roi::ContourStack drawByHand(const image::ScalarVolume& distance_mm, std::uint64_t seed);

}  // namespace glisson::phantom
