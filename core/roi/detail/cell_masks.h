// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <utility>

#include "image/volume.h"

namespace glisson::roi::detail {

/// The part that hangs together with the cell, or nothing where it is outside.
image::Mask partWith(const image::Mask& mask, const Eigen::Vector3i& cell);

void keepWithin(image::Mask& mask, const image::Mask& limit);

/// The cell of mask nearest to at (itself where it is inside), and how far, mm. 1e300 where the mask is empty.
std::pair<Eigen::Vector3i, double> nearestOf(const image::Mask& mask, const Eigen::Vector3i& at);

/// Whether a voxel of the mask lies on the border of the image.
bool touchesBorder(const image::Mask& mask);

double volume_mL(const image::Mask& mask);

/// Erosion by a ball as if the mask went on beyond the image.
image::Mask eroded(const image::Mask& mask, double radius_mm);

/// Closing by a ball that does not stick to the border of the image.
image::Mask closed(const image::Mask& mask, double radius_mm);

/// Box of cells around a mask that is not empty, with a margin, within its grid: first cell and grid.
std::pair<Eigen::Vector3i, image::Grid> boxAround(const image::Mask& mask, double margin_mm);

/// The values of a box of the whole.
template <typename V>
V boxOf(const V& whole, const Eigen::Vector3i& first, const image::Grid& box) {
  V result(box);
  for (int k = 0; k < box.size.z(); ++k)
    for (int j = 0; j < box.size.y(); ++j)
      for (int i = 0; i < box.size.x(); ++i) result.at(i, j, k) = whole.at(first + Eigen::Vector3i(i, j, k));
  return result;
}

/// A box put back into its whole grid.
image::Mask putBack(const image::Mask& box, const Eigen::Vector3i& first, const image::Grid& grid);

}  // namespace glisson::roi::detail
