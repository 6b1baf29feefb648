// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "image/components.h"
#include "image/morphology.h"
#include "roi/detail/cell_masks.h"

namespace glisson::roi::detail {
namespace {

/// The mask with a border that repeats its outermost cells (repeat) or is outside, so that morphology does not stick to
/// the border of the image.
image::Mask padded(const image::Mask& mask, int by, bool repeat) {
  image::Grid grid = mask.grid;
  grid.size.array() += 2 * by;
  grid.origin_lps_mm = mask.grid.indexToLps(Eigen::Vector3d::Constant(-by));
  image::Mask result(grid);
  const Eigen::Vector3i last = mask.grid.size.array() - 1;
  for (int k = 0; k < grid.size.z(); ++k)
    for (int j = 0; j < grid.size.y(); ++j)
      for (int i = 0; i < grid.size.x(); ++i) {
        const Eigen::Vector3i from = Eigen::Vector3i(i, j, k).array() - by;
        const Eigen::Vector3i within = from.cwiseMax(0).cwiseMin(last);
        if (repeat || from == within) result.at(i, j, k) = mask.at(within);
      }
  return result;
}

image::Mask cropped(const image::Mask& mask, const image::Grid& grid, int by) {
  image::Mask result(grid);
  for (int k = 0; k < grid.size.z(); ++k)
    for (int j = 0; j < grid.size.y(); ++j)
      for (int i = 0; i < grid.size.x(); ++i) result.at(i, j, k) = mask.at(i + by, j + by, k + by);
  return result;
}

int margin(const image::Grid& grid, double radius_mm) {
  return static_cast<int>(std::ceil(2.0 * radius_mm / grid.spacing_mm.minCoeff())) + 1;
}

}  // namespace

image::Mask partWith(const image::Mask& mask, const Eigen::Vector3i& cell) {
  image::Mask result(mask.grid);
  const image::Components parts = image::components(mask);
  const std::int32_t label = parts.labels.at(cell);
  if (label == 0) return result;
  for (std::size_t v = 0; v < result.values.size(); ++v) result.values[v] = parts.labels.values[v] == label ? 1 : 0;
  return result;
}

void keepWithin(image::Mask& mask, const image::Mask& limit) {
  for (std::size_t v = 0; v < mask.values.size(); ++v)
    if (limit.values[v] == 0) mask.values[v] = 0;
}

std::pair<Eigen::Vector3i, double> nearestOf(const image::Mask& mask, const Eigen::Vector3i& at) {
  Eigen::Vector3i best = at;
  double nearest_mm = 1e300;
  for (int k = 0; k < mask.grid.size.z(); ++k)
    for (int j = 0; j < mask.grid.size.y(); ++j)
      for (int i = 0; i < mask.grid.size.x(); ++i) {
        if (mask.at(i, j, k) == 0) continue;
        const double d_mm = mask.grid.spacing_mm.cwiseProduct((Eigen::Vector3i(i, j, k) - at).cast<double>()).norm();
        if (d_mm < nearest_mm) {
          nearest_mm = d_mm;
          best = {i, j, k};
        }
      }
  return {best, nearest_mm};
}

bool touchesBorder(const image::Mask& mask) {
  const Eigen::Vector3i n = mask.grid.size;
  for (int k = 0; k < n.z(); ++k)
    for (int j = 0; j < n.y(); ++j)
      for (int i = 0; i < n.x(); ++i)
        if (mask.at(i, j, k) != 0 && (i == 0 || j == 0 || k == 0 || i == n.x() - 1 || j == n.y() - 1 || k == n.z() - 1))
          return true;
  return false;
}

image::Mask eroded(const image::Mask& mask, double radius_mm) {
  const int by = margin(mask.grid, radius_mm);
  return cropped(image::erode(padded(mask, by, true), radius_mm), mask.grid, by);
}

image::Mask closed(const image::Mask& mask, double radius_mm) {
  const int by = margin(mask.grid, radius_mm);
  return cropped(image::erode(image::dilate(padded(mask, by, false), radius_mm), radius_mm), mask.grid, by);
}

double volume_mL(const image::Mask& mask) {
  return 1e-3 * mask.grid.voxelVolume_mm3() * static_cast<double>(image::count(mask));
}

std::pair<Eigen::Vector3i, image::Grid> boxAround(const image::Mask& mask, double margin_mm) {
  auto [low, high] = image::extentOf(mask).value();
  const Eigen::Vector3i by = (margin_mm / mask.grid.spacing_mm.array()).ceil().cast<int>();
  low = (low - by).cwiseMax(0);
  high = (high + by).cwiseMin(mask.grid.size - Eigen::Vector3i::Ones());
  image::Grid grid = mask.grid;
  grid.size = high - low + Eigen::Vector3i::Ones();
  grid.origin_lps_mm = mask.grid.indexToLps(low.cast<double>());
  return {low, grid};
}

image::Mask putBack(const image::Mask& box, const Eigen::Vector3i& first, const image::Grid& grid) {
  image::Mask result(grid);
  for (int k = 0; k < box.grid.size.z(); ++k)
    for (int j = 0; j < box.grid.size.y(); ++j)
      for (int i = 0; i < box.grid.size.x(); ++i) result.at(first + Eigen::Vector3i(i, j, k)) = box.at(i, j, k);
  return result;
}

}  // namespace glisson::roi::detail
