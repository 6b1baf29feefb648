// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "image/volume.h"

namespace glisson::image {

/// Share of every cell that the mask's voxels fill, 0 to 1: exact, as both are boxes along the same axes.
/// Throws BadArgument where the axes of `cells` are not the mask's (1e-6).
ScalarVolume coverage(const Mask& mask, const Grid& cells);

/// The mask in other cells along the same axes, of the mask's volume: cells more than half covered are filled; of those
/// covered by half (a face that runs through their middle) the ones on one side, so that a layer between two cells
/// becomes one cell thick. Then cells that are covered by half, give or take 0.15, and share a face with a covered one
/// are added or taken away, the best covered first, until the volume is the mask's: half the cells of a curved surface
/// are not half its volume. What is thinner than a cell takes no part in that: it stays where it covers half a cell,
/// and is lost elsewhere. No cell is taken away that joins others.
/// Throws BadArgument as coverage does.
Mask resampleKeepingVolume(const Mask& mask, const Grid& cells);

}  // namespace glisson::image
