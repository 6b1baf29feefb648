// SPDX-License-Identifier: GPL-3.0-or-later

// What lies over a slice from another grid: a map in its colours, and the cut of a region.
#include <algorithm>
#include <cmath>

#include "views/colour_map.h"
#include "views/slice_view.h"

namespace glisson::views {

void SliceView::setFusion(const Fusion& fusion) {
  if (fusion == fusion_) return;
  fusion_ = fusion;
  stale_ = true;
  update();
}

void SliceView::setRegion(std::shared_ptr<const image::Mask> region) {
  if (region == region_) return;
  region_ = std::move(region);
  cutRegion();
  update();
}

void SliceView::cutRegion() {
  cut_.clear();
  if (region_ && hasVolume()) cut_ = tools::cutOf(*region_, volume_.values->grid, slice_);
}

std::optional<double> SliceView::fusedAt(const Eigen::Vector3d& p_lps) const {
  if (!fusion_.values || !(fusion_.opacity > 0.0)) return std::nullopt;
  const Eigen::Vector3i voxel =
      (fusion_.values->grid.lpsToIndex(p_lps).array() + 0.5 + 1e-6).floor().matrix().cast<int>();
  if (!fusion_.values->grid.contains(voxel) || !(fusion_.values->at(voxel) > 0.0F)) return std::nullopt;
  return fusion_.values->at(voxel);
}

// The voxel of the map that holds the centre of each pixel: no value is made up between two of them.
void SliceView::fuse() {
  if (!fusion_.values || !(fusion_.opacity > 0.0)) return;
  const image::Grid& grid = volume_.values->grid;
  const image::Grid& map = fusion_.values->grid;
  const auto indexOf = [&](int i, int j) { return map.lpsToIndex(grid.indexToLps({1.0 * i, 1.0 * j, 1.0 * slice_})); };
  const Eigen::Vector3d first = indexOf(0, 0), right = indexOf(1, 0) - first, down = indexOf(0, 1) - first;
  const auto& colours = stiffnessColours();
  const double scale = 255.0 / fusion_.high_kPa;
  const int over = std::clamp(static_cast<int>(std::lround(256.0 * fusion_.opacity)), 0, 256);
  const auto mixed = [over](int below, int above) { return (below * (256 - over) + above * over) / 256; };
  for (int j = 0; j < image_.height(); ++j) {
    auto* line = reinterpret_cast<QRgb*>(image_.scanLine(j));
    for (int i = 0; i < image_.width(); ++i) {
      const Eigen::Vector3d at = first + i * right + j * down;
      const Eigen::Vector3i voxel = (at.array() + 0.5 + 1e-6).floor().matrix().cast<int>();
      if (!map.contains(voxel)) continue;
      const float value = fusion_.values->at(voxel);
      if (!(value > 0.0F) || !std::isfinite(value)) continue;
      const double level = std::clamp(static_cast<double>(value) * scale, 0.0, 255.0);
      const QRgb above = colours[static_cast<std::size_t>(level)];
      line[i] = qRgb(mixed(qRed(line[i]), qRed(above)), mixed(qGreen(line[i]), qGreen(above)),
                     mixed(qBlue(line[i]), qBlue(above)));
    }
  }
}

}  // namespace glisson::views
