// SPDX-License-Identifier: GPL-3.0-or-later
#include "anatomy/detail/thinning.h"

#include <array>
#include <vector>

namespace glisson::anatomy {
namespace {

using Cube =
    std::array<bool, 27>;  // 3 × 3 × 3 neighbourhood, index (dx + 1) + 3 (dy + 1) + 9 (dz + 1); 13 is the centre

struct Neighbours {
  std::array<std::vector<int>, 27> touching26, touching6;
  std::array<bool, 27> inN18{}, inN6{};
  Neighbours() {
    for (int a = 0; a < 27; ++a) {
      const int off = std::abs(a % 3 - 1) + std::abs(a / 3 % 3 - 1) + std::abs(a / 9 - 1);
      inN18[static_cast<std::size_t>(a)] = off == 1 || off == 2;
      inN6[static_cast<std::size_t>(a)] = off == 1;
      for (int b = 0; b < 27; ++b) {
        const int dx = std::abs(a % 3 - b % 3), dy = std::abs(a / 3 % 3 - b / 3 % 3), dz = std::abs(a / 9 - b / 9);
        if (a == b || dx > 1 || dy > 1 || dz > 1) continue;
        touching26[static_cast<std::size_t>(a)].push_back(b);
        if (dx + dy + dz == 1) touching6[static_cast<std::size_t>(a)].push_back(b);
      }
    }
  }
};

const Neighbours& neighbours() {
  static const Neighbours table;
  return table;
}

/// Marks everything reachable from start among the allowed members.
void flood(std::size_t start, const Cube& allowed, const std::array<std::vector<int>, 27>& touching, Cube& seen) {
  std::array<std::size_t, 27> stack{};
  std::size_t top = 0;
  stack[top++] = start;
  seen[start] = true;
  while (top > 0) {
    const std::size_t at = stack[--top];
    for (const int next : touching[at]) {
      const auto n = static_cast<std::size_t>(next);
      if (!allowed[n] || seen[n]) continue;
      seen[n] = true;
      stack[top++] = n;
    }
  }
}

/// Simple: one 26-part of the foreground round the centre, and one 6-part of the background within the 18-neighbourhood
/// that touches the centre.
bool isSimple(const Cube& cube) {
  const Neighbours& table = neighbours();
  Cube foreground = cube, background{}, seen{};
  foreground[13] = false;
  int parts = 0;
  for (std::size_t i = 0; i < 27; ++i) {
    background[i] = !cube[i] && table.inN18[i];
    if (!foreground[i] || seen[i]) continue;
    if (++parts > 1) return false;
    flood(i, foreground, table.touching26, seen);
  }
  if (parts != 1) return false;
  seen = Cube{};
  int holes = 0;
  for (std::size_t i = 0; i < 27; ++i) {
    if (!background[i] || !table.inN6[i] || seen[i]) continue;
    if (++holes > 1) return false;
    flood(i, background, table.touching6, seen);
  }
  return holes == 1;
}

}  // namespace

image::Mask skeleton(const image::Mask& mask) {
  image::Mask result = mask;
  const image::Grid& grid = mask.grid;
  std::vector<Eigen::Vector3i> voxels;
  for (int k = 0; k < grid.size.z(); ++k)
    for (int j = 0; j < grid.size.y(); ++j)
      for (int i = 0; i < grid.size.x(); ++i)
        if (mask.at(i, j, k) != 0) voxels.emplace_back(i, j, k);

  auto inside = [&](const Eigen::Vector3i& p) { return grid.contains(p) && result.at(p) != 0; };
  auto removable = [&](const Eigen::Vector3i& p) {
    Cube cube{};
    int count = 0;
    for (int n = 0; n < 27; ++n) {
      cube[static_cast<std::size_t>(n)] = inside(p + Eigen::Vector3i(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1));
      if (n != 13 && cube[static_cast<std::size_t>(n)]) ++count;
    }
    return count > 1 && isSimple(cube);
  };
  const std::array<Eigen::Vector3i, 6> sides = {Eigen::Vector3i(0, 0, 1), Eigen::Vector3i(0, 0, -1),
                                                Eigen::Vector3i(0, 1, 0), Eigen::Vector3i(0, -1, 0),
                                                Eigen::Vector3i(1, 0, 0), Eigen::Vector3i(-1, 0, 0)};
  bool changed = true;
  std::vector<Eigen::Vector3i> border;
  while (changed) {
    changed = false;
    for (const Eigen::Vector3i& side : sides) {
      border.clear();
      for (const Eigen::Vector3i& p : voxels)
        if (!inside(p + side) && removable(p)) border.push_back(p);
      for (const Eigen::Vector3i& p : border) {
        if (!removable(p)) continue;  // a neighbour went first
        result.at(p) = 0;
        changed = true;
      }
      std::erase_if(voxels, [&](const Eigen::Vector3i& p) { return result.at(p) == 0; });
    }
  }
  return result;
}

}  // namespace glisson::anatomy
