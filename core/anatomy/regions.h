// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "image/volume.h"

namespace glisson::anatomy {

/// Where the retractor lifts: a point on the inferior surface of the right lobe, LPS mm.
/// Rule: the right third of the liver by its extent along x (patient's right: x ≤ x_min + (x_max − x_min) / 3); of its
/// voxels those whose centre lies within 10 mm (or one slice, whichever is more) of the lowest; the centroid of these;
/// from there straight down (−z) to where the mask ends. Where the centroid lies outside the mask (a notch), the voxel
/// of the set nearest to it stands in. The liver is taken as it is: drop islands before (image::largestComponent).
/// Throws BadInput where the mask is empty.
Eigen::Vector3d inferiorRightLobePoint(const image::Mask& liver);

}  // namespace glisson::anatomy
