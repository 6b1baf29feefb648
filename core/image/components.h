// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "image/volume.h"

namespace glisson::image {

/// Parts of a mask that hang together over voxel faces (6-connectivity).
struct Components {
  LabelMap labels;  ///< 0 outside; 1 is the largest part, 2 the next ... (equal sizes: lower index first)
  std::vector<std::size_t> voxels;  ///< voxels[n − 1]: size of part n
};

/// The parts of a mask: inside voxels that hang together over faces.
Components components(const Mask& mask);

/// The largest part; empty for an empty mask.
Mask largestComponent(const Mask& mask);

/// Fills every cavity: outside voxels that cannot reach the border of the image over faces.
Mask fillHoles(const Mask& mask);

}  // namespace glisson::image
