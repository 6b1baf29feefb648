// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "render/overlay.h"

namespace glisson::render {

/// Where a place at rest goes in both answers, LPS mm.
struct DisplacementArrow {
  Eigen::Vector3d rest, mre, atlas;
};

/// Arrows on a lattice of the patient's axes inside the liver, spacing_mm apart, or further where there would be more
/// than `most`. With a slice (k of the MRI grid): places in its plane, displacements projected into it.
/// Throws BadArgument where spacing_mm or most is not positive.
std::vector<DisplacementArrow> displacementArrows(const RetractionScene& scene, double spacing_mm, int most,
                                                  int slice = -1);

}  // namespace glisson::render
