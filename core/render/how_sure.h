// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "anatomy/triangle_mesh.h"
#include "image/volume.h"

namespace glisson::render {

/// How sure a retraction is, as pictures show it.
struct HowSure {
  /// Probability that both answers place the tissue further apart than what matters clinically: per cell, at rest, not
  /// a number outside the body. Without voxels where there is one answer only.
  image::ScalarVolume beyond;
  /// Around the vessels where the first answer puts them: each of their places lies inside with 95 %. May be empty.
  anatomy::TriangleMesh tube;
  /// Per vertex of the vessels' surface: radius of the ball that holds its true place with 95 %.
  Eigen::VectorXf vessel95_mm;
};

/// Value of a field that is known at some voxels only (finite there): tri-linear over those around a continuous index,
/// not a number where none of them is known.
float sampleKnown(const image::ScalarVolume& field, const Eigen::Vector3d& index);

/// End of the colour scale of the vessels: the radius that 98 % of their surface stays below, rounded up to 1, 2, 3, 4,
/// 6 or 8 times a power of ten. 1 mm where there is none.
double placeScale_mm(const HowSure& sure);

}  // namespace glisson::render
