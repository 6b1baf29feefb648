// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "base/parallel.h"
#include "render/overlay.h"
#include "render/sampling.h"

namespace glisson::render {

image::ScalarVolume warp(const image::ScalarVolume& image, const image::DisplacementField& u_mm,
                         const image::Grid& target) {
  target.check();
  const InverseMap inverse(u_mm, false);
  const LpsToIndex toImage(image.grid);
  image::ScalarVolume out(target);
  const auto rows = static_cast<std::size_t>(target.size.y()) * static_cast<std::size_t>(target.size.z());
  parallelChunks(rows, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const int j = static_cast<int>(row % static_cast<std::size_t>(target.size.y()));
      const int k = static_cast<int>(row / static_cast<std::size_t>(target.size.y()));
      for (int i = 0; i < target.size.x(); ++i) {
        const Eigen::Vector3d y = target.indexToLps(Eigen::Vector3i(i, j, k).cast<double>());
        out.at(i, j, k) = sampleLinear(image, toImage(inverse.rest(y).x_lps));
      }
    }
  });
  return out;
}

int sliceOfLargestDifference(const RetractionScene& scene) {
  const image::Grid& grid = scene.mri.grid;
  const LpsToIndex toLiver(scene.liver.grid), toMre(scene.u_mre_mm.grid), toAtlas(scene.u_atlas_mm.grid);
  const image::ScalarVolume liver = asScalar(scene.liver);
  std::vector<double> largest(static_cast<std::size_t>(grid.size.z()), -1.0);
  parallelChunks(largest.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      for (int j = 0; j < grid.size.y(); ++j)
        for (int i = 0; i < grid.size.x(); ++i) {
          const Eigen::Vector3d p = grid.indexToLps(Eigen::Vector3i(i, j, static_cast<int>(k)).cast<double>());
          if (sampleLinear(liver, toLiver(p)) < 0.5F) continue;
          Eigen::Vector3f d = sampleLinear(scene.u_mre_mm, toMre(p));
          if (scene.compared) d -= sampleLinear(scene.u_atlas_mm, toAtlas(p));
          largest[k] = std::max(largest[k], static_cast<double>(d.norm()));
        }
  });
  return static_cast<int>(std::max_element(largest.begin(), largest.end()) - largest.begin());
}

}  // namespace glisson::render
