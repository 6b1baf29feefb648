// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "image/volume.h"

namespace glisson::roi {

/// Column and row index doubled, so that a point half-way between two voxel centres has whole numbers. One of the two
/// is odd: the point lies between centres that are neighbours along that axis.
using HalfPoint = std::array<int, 2>;

/// Closed rings that part the voxels of slice k from the others: every vertex lies half-way between a centre inside and
/// one outside, the inside to the left (column to the right, row up). Pixels that touch at a corner only are kept
/// apart. Outlines and holes alike; empty for an empty slice.
std::vector<std::vector<HalfPoint>> ringsOf(const image::Mask& mask, int k);

}  // namespace glisson::roi
