// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/morphology.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/error.h"
#include "image/distance.h"

namespace glisson::image {
namespace {

void checkRadius(double radius_mm) {
  if (!(radius_mm >= 0.0) || !std::isfinite(radius_mm))
    throw BadArgument("the radius of an erosion or dilation is " + std::to_string(radius_mm) +
                      " mm; it must be a number of at least 0");
}

}  // namespace

std::size_t count(const Mask& mask) {
  return static_cast<std::size_t>(
      std::count_if(mask.values.begin(), mask.values.end(), [](std::uint8_t v) { return v != 0; }));
}

std::optional<Extent> extentOf(const Mask& mask) {
  Eigen::Vector3i low = mask.grid.size, high = Eigen::Vector3i::Constant(-1);
  for (int k = 0; k < mask.grid.size.z(); ++k)
    for (int j = 0; j < mask.grid.size.y(); ++j)
      for (int i = 0; i < mask.grid.size.x(); ++i)
        if (mask.at(i, j, k) != 0) {
          low = low.cwiseMin(Eigen::Vector3i(i, j, k));
          high = high.cwiseMax(Eigen::Vector3i(i, j, k));
        }
  if (high.x() < 0) return {};
  return Extent{low, high};
}

Mask erodeInPlane(const Mask& mask, int pixels) {
  if (pixels < 0)
    throw BadArgument("an erosion by " + std::to_string(pixels) + " pixels was asked for; it must be at least 0");
  std::vector<std::pair<int, int>> disk;
  for (int dj = -pixels; dj <= pixels; ++dj)
    for (int di = -pixels; di <= pixels; ++di)
      if (di * di + dj * dj <= pixels * pixels) disk.emplace_back(di, dj);
  const Eigen::Vector3i n = mask.grid.size;
  Mask result(mask.grid);
  for (int k = 0; k < n.z(); ++k)
    for (int j = 0; j < n.y(); ++j)
      for (int i = 0; i < n.x(); ++i)
        result.at(i, j, k) = mask.at(i, j, k) != 0 && std::all_of(disk.begin(), disk.end(), [&](const auto& d) {
                               const Eigen::Vector3i p(i + d.first, j + d.second, k);
                               return mask.grid.contains(p) && mask.at(p) != 0;
                             });
  return result;
}

Mask erode(const Mask& mask, double radius_mm) {
  checkRadius(radius_mm);
  Mask result(mask.grid);
  if (count(mask) == 0) return result;
  const ScalarVolume distance_mm = distanceToBoundary_mm(mask);
  for (std::size_t i = 0; i < result.values.size(); ++i)
    result.values[i] = static_cast<double>(distance_mm.values[i]) > radius_mm ? 1 : 0;
  return result;
}

Mask dilate(const Mask& mask, double radius_mm) {
  checkRadius(radius_mm);
  Mask result(mask.grid);
  if (count(mask) == 0) return result;
  const ScalarVolume distance_mm = distanceToBoundary_mm(mask);
  for (std::size_t i = 0; i < result.values.size(); ++i)
    result.values[i] = static_cast<double>(distance_mm.values[i]) >= -radius_mm ? 1 : 0;
  return result;
}

bool overlap(const Mask& a, const Mask& b) {
  if (a.values.size() != b.values.size()) throw BadArgument("overlap: the masks are of different sizes");
  for (std::size_t v = 0; v < a.values.size(); ++v)
    if (a.values[v] != 0 && b.values[v] != 0) return true;
  return false;
}

}  // namespace glisson::image
