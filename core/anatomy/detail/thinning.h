// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "image/volume.h"

namespace glisson::anatomy {

/// Curve skeleton of a mask: border voxels are taken away from the six sides in turn as long as they are simple (taking
/// them away changes neither the parts (26-connected), nor the cavities and tunnels of the background (6-connected)
/// [malandain1994]) and no end of a curve (one neighbour). One voxel thick, centred to about a voxel, the same every
/// time.
image::Mask skeleton(const image::Mask& mask);

/// The same in place, of a mask whose voxels are known: `voxels` holds them in the order of the grid (x fastest), and
/// afterwards those that are left. Costs what they are, whatever the grid's size.
void thin(image::Mask& mask, std::vector<Eigen::Vector3i>& voxels);

/// Voxels of a mask in the order of the grid.
std::vector<Eigen::Vector3i> voxelsOf(const image::Mask& mask);

}  // namespace glisson::anatomy
