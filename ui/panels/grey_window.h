// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "image/volume.h"

namespace glisson::panels {

/// Window that holds the middle 99 % of the voxels that are not black.
inline std::pair<double, double> windowOf(const image::ScalarVolume& volume) {
  std::vector<float> sample;
  const std::size_t step = std::max<std::size_t>(1, volume.values.size() / 200000);
  for (std::size_t i = 0; i < volume.values.size(); i += step)
    if (std::isfinite(volume.values[i]) && volume.values[i] != 0.0F) sample.push_back(volume.values[i]);
  if (sample.size() < 10) return {0.0, 1.0};
  const auto at = [&sample](double q) {
    const auto n = static_cast<std::ptrdiff_t>(q * static_cast<double>(sample.size() - 1));
    std::nth_element(sample.begin(), sample.begin() + n, sample.end());
    return static_cast<double>(sample[static_cast<std::size_t>(n)]);
  };
  const double low = at(0.005), high = at(0.995);
  return {low, high > low ? high : low + 1.0};
}

/// The presets under keys 1 to 5, as parts of the window of the image: {low, high}.
inline std::pair<double, double> presetOf(int preset, std::pair<double, double> whole) {
  constexpr double parts[5][2] = {{0.0, 1.0}, {0.15, 0.75}, {0.3, 0.95}, {0.4, 1.0}, {0.0, 0.5}};
  const double width = whole.second - whole.first;
  return {whole.first + parts[preset][0] * width, whole.first + parts[preset][1] * width};
}

}  // namespace glisson::panels
