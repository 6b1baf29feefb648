// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

#include "base/parallel.h"
#include "base/progress.h"
#include "image/volume.h"
#include "inversion/detail/stencil.h"

namespace glisson::inversion::detail {

/// body(voxel) for every voxel of the mask, row by row on several threads.
inline void forEachVoxel(const image::Mask& mask, const Progress& progress,
                         const std::function<void(std::size_t)>& body) {
  const auto row = static_cast<std::size_t>(mask.grid.size.x());
  parallelChunks(mask.values.size(), 8 * row, [&](std::size_t begin, std::size_t end) {
    progress.check();
    for (std::size_t v = begin; v < end; ++v)
      if (mask.values[v] != 0) body(v);
  });
}

/// The taps of a stencil as steps in linear index, for voxels whose window lies wholly inside a mask.
class Window {
 public:
  Window(const image::Grid& grid, const Stencil& stencil) : grid_(grid) {
    for (const Stencil::Tap& tap : stencil.taps()) {
      offsets_.push_back(tap.offset);
      steps_.push_back((static_cast<std::ptrdiff_t>(tap.offset.z()) * grid.size.y() + tap.offset.y()) * grid.size.x() +
                       tap.offset.x());
    }
  }

  std::size_t size() const { return steps_.size(); }
  std::size_t neighbour(std::size_t voxel, std::size_t tap) const {
    return static_cast<std::size_t>(static_cast<std::ptrdiff_t>(voxel) + steps_[tap]);
  }

  /// Voxels all of whose taps lie in the mask.
  image::Mask complete(const image::Mask& mask) const {
    image::Mask result(grid_);
    parallelChunks(static_cast<std::size_t>(grid_.size.z()), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k)
        for (int j = 0; j < grid_.size.y(); ++j)
          for (int i = 0; i < grid_.size.x(); ++i) {
            const Eigen::Vector3i at(i, j, static_cast<int>(k));
            bool all = true;
            for (std::size_t t = 0; t < offsets_.size() && all; ++t)
              all = grid_.contains(at + offsets_[t]) && mask.at(at + offsets_[t]) != 0;
            result.at(at) = all ? 1 : 0;
          }
    });
    return result;
  }

 private:
  image::Grid grid_;
  std::vector<Eigen::Vector3i> offsets_;
  std::vector<std::ptrdiff_t> steps_;
};

}  // namespace glisson::inversion::detail
