// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/components.h"

#include <algorithm>
#include <numeric>

namespace glisson::image {
namespace {

/// Labels 1, 2, ... in order of first voxel, for voxels with the wanted value.
std::vector<std::size_t> flood(const Mask& mask, bool inside, LabelMap& labels) {
  const Eigen::Vector3i n = mask.grid.size;
  const std::size_t strides[3] = {1, static_cast<std::size_t>(n.x()), mask.grid.linear(0, 0, 1)};
  std::vector<std::size_t> sizes, stack;
  for (std::size_t seed = 0; seed < mask.values.size(); ++seed) {
    if ((mask.values[seed] != 0) != inside || labels.values[seed] != 0) continue;
    sizes.push_back(0);
    const auto label = static_cast<std::int32_t>(sizes.size());
    labels.values[seed] = label;
    stack.assign(1, seed);
    while (!stack.empty()) {
      const std::size_t at = stack.back();
      stack.pop_back();
      ++sizes.back();
      for (int a = 0; a < 3; ++a) {
        const auto index = static_cast<int>(at / strides[a] % static_cast<std::size_t>(n[a]));
        for (const bool up : {false, true}) {
          if (up ? index + 1 >= n[a] : index == 0) continue;
          const std::size_t next = up ? at + strides[a] : at - strides[a];
          if ((mask.values[next] != 0) != inside || labels.values[next] != 0) continue;
          labels.values[next] = label;
          stack.push_back(next);
        }
      }
    }
  }
  return sizes;
}

}  // namespace

Components components(const Mask& mask) {
  Components result{LabelMap(mask.grid), {}};
  const std::vector<std::size_t> sizes = flood(mask, true, result.labels);
  std::vector<std::size_t> order(sizes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return sizes[a] > sizes[b]; });
  std::vector<std::int32_t> rank(sizes.size() + 1, 0);
  for (std::size_t r = 0; r < order.size(); ++r) {
    rank[order[r] + 1] = static_cast<std::int32_t>(r + 1);
    result.voxels.push_back(sizes[order[r]]);
  }
  for (std::int32_t& label : result.labels.values) label = rank[static_cast<std::size_t>(label)];
  return result;
}

Mask largestComponent(const Mask& mask) {
  const Components parts = components(mask);
  Mask result(mask.grid);
  for (std::size_t i = 0; i < result.values.size(); ++i) result.values[i] = parts.labels.values[i] == 1 ? 1 : 0;
  return result;
}

Mask fillHoles(const Mask& mask) {
  LabelMap labels(mask.grid);
  const std::size_t count = flood(mask, false, labels).size();
  std::vector<bool> open(count + 1, false);
  const Eigen::Vector3i n = mask.grid.size;
  for (int k = 0; k < n.z(); ++k)
    for (int j = 0; j < n.y(); ++j)
      for (int i = 0; i < n.x(); ++i)
        if (i == 0 || j == 0 || k == 0 || i == n.x() - 1 || j == n.y() - 1 || k == n.z() - 1)
          open[static_cast<std::size_t>(labels.at(i, j, k))] = true;
  Mask result(mask.grid);
  for (std::size_t i = 0; i < result.values.size(); ++i)
    result.values[i] = (mask.values[i] != 0 || !open[static_cast<std::size_t>(labels.values[i])]) ? 1 : 0;
  return result;
}

}  // namespace glisson::image
