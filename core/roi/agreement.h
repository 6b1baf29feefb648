// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "image/volume.h"

namespace glisson::roi {

/// How two outlines of the same organ agree. Volumes in mL, distances in mm between the centres of border voxels.
struct Agreement {
  double dice = 0.0;     ///< 2 |A ∩ B| / (|A| + |B|)
  double jaccard = 0.0;  ///< |A ∩ B| / |A ∪ B|
  double volumeA_mL = 0.0, volumeB_mL = 0.0;
  double volumeDifference_mL = 0.0;       ///< B − A
  double volumeDifference_percent = 0.0;  ///< of the mean of both
  double hausdorff_mm = 0.0;              ///< largest distance from the border of one to the border of the other
  double hausdorff95_mm = 0.0;            ///< the larger of the two directed 95 % quantiles (nearest rank)
  double meanSurfaceDistance_mm = 0.0;    ///< over the border voxels of both
  std::vector<int> slicesOnlyInA, slicesOnlyInB;  ///< k
};

/// Which border the distances between two masks run along.
enum class Border {
  Surface,  ///< voxels with an outside neighbour over any face; distances in space
  Outline   ///< in each slice on its own: for few, thick slices. Slices that only one holds take no part in distances
};

/// Compares b with a. Throws BadInput where the masks lie on different grids or one is empty, and for Border::Outline
/// where no slice holds both.
Agreement agreement(const image::Mask& a, const image::Mask& b, Border border = Border::Surface);

}  // namespace glisson::roi
