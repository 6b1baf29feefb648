// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "image/volume.h"

namespace glisson::image {

/// Signed distance from every voxel centre to the surface of the mask, mm: positive inside, negative outside. The
/// surface is that of the union of voxel boxes, and the distance to it is exact on anisotropic grids (a lone voxel has
/// half its smallest edge). Beyond the image counts as outside. Throws BadInput where the mask is empty.
ScalarVolume distanceToBoundary_mm(const Mask& mask);

/// The same within each slice on its own (k fixed): distance to the outline of the slice's pixels. Slices without mask
/// voxels hold −infinity.
ScalarVolume distanceToOutline_mm(const Mask& mask);

/// For every voxel the linear index of the mask voxel whose centre is nearest (Euclidean, mm; ties: the same choice
/// every time). Throws BadInput where the mask is empty.
std::vector<std::size_t> nearestInside(const Mask& mask);

}  // namespace glisson::image
