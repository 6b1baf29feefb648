// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/reorient.h"

#include "base/error.h"

namespace glisson::image {

Grid permuted(const Grid& grid, const std::array<int, 3>& axes) {
  std::array<bool, 3> taken{};
  Grid out = grid;
  for (int a = 0; a < 3; ++a) {
    const int from = axes[static_cast<std::size_t>(a)];
    if (from < 0 || from > 2 || taken[static_cast<std::size_t>(from)])
      throw BadArgument("the axes of a reformat are a permutation of 0, 1, 2");
    taken[static_cast<std::size_t>(from)] = true;
    out.size[a] = grid.size[from];
    out.spacing_mm[a] = grid.spacing_mm[from];
    out.direction.col(a) = grid.direction.col(from);
  }
  return out;
}

ScalarVolume permuted(const ScalarVolume& volume, const std::array<int, 3>& axes) {
  ScalarVolume out(permuted(volume.grid, axes));
  std::array<std::size_t, 3> step{};  // in the volume, per axis of the result
  for (std::size_t a = 0; a < 3; ++a) {
    Eigen::Vector3i one = Eigen::Vector3i::Zero();
    one[axes[a]] = 1;
    step[a] = volume.grid.linear(one);
  }
  std::size_t at = 0;
  const Eigen::Vector3i& size = out.grid.size;
  for (std::size_t k = 0; k < static_cast<std::size_t>(size.z()); ++k)
    for (std::size_t j = 0; j < static_cast<std::size_t>(size.y()); ++j) {
      std::size_t from = k * step[2] + j * step[1];
      for (int i = 0; i < size.x(); ++i, from += step[0]) out.values[at++] = volume.values[from];
    }
  return out;
}

}  // namespace glisson::image
