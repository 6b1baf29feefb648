// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "image/grid.h"

namespace glisson::image {

/// Voxel values on a grid, i fastest. values.size() == grid.voxelCount().
template <typename T>
struct Volume {
  Grid grid;
  std::vector<T> values;

  Volume() = default;
  explicit Volume(const Grid& g, T fill = T{}) : grid(g), values(g.voxelCount(), fill) {}

  T& at(int i, int j, int k) { return values[grid.linear(i, j, k)]; }
  const T& at(int i, int j, int k) const { return values[grid.linear(i, j, k)]; }
  T& at(const Eigen::Vector3i& ijk) { return values[grid.linear(ijk)]; }
  const T& at(const Eigen::Vector3i& ijk) const { return values[grid.linear(ijk)]; }
};

/// One number per voxel.
using ScalarVolume = Volume<float>;
using Mask = Volume<std::uint8_t>;  ///< 0 outside, 1 inside
/// One label per voxel, 0 for none.
using LabelMap = Volume<std::int32_t>;
/// Displacement of the material that rests at the voxel centre, LPS components, mm.
using DisplacementField = Volume<Eigen::Vector3f>;

}  // namespace glisson::image
