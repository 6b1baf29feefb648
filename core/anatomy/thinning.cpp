// SPDX-License-Identifier: GPL-3.0-or-later
#include "anatomy/detail/thinning.h"

#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>

namespace glisson::anatomy {
namespace {

/// Voxels of a 3 × 3 × 3 neighbourhood, one bit each: (dx + 1) + 3 (dy + 1) + 9 (dz + 1).
using Cube = std::uint32_t;
constexpr int centre = 13;

constexpr Cube bit(int n) {
  return Cube{1} << n;
}

struct Neighbours {
  std::array<Cube, 27> touching26{}, touching6{};
  Cube inN18 = 0, inN6 = 0;
  Neighbours() {
    for (int a = 0; a < 27; ++a) {
      const int off = std::abs(a % 3 - 1) + std::abs(a / 3 % 3 - 1) + std::abs(a / 9 - 1);
      if (off == 1 || off == 2) inN18 |= bit(a);
      if (off == 1) inN6 |= bit(a);
      for (int b = 0; b < 27; ++b) {
        const int dx = std::abs(a % 3 - b % 3), dy = std::abs(a / 3 % 3 - b / 3 % 3), dz = std::abs(a / 9 - b / 9);
        if (a == b || dx > 1 || dy > 1 || dz > 1) continue;
        touching26[static_cast<std::size_t>(a)] |= bit(b);
        if (dx + dy + dz == 1) touching6[static_cast<std::size_t>(a)] |= bit(b);
      }
    }
  }
};

const Neighbours& neighbours() {
  static const Neighbours table;
  return table;
}

/// Everything that is reached from the first of the seeds among the allowed ones.
Cube flood(Cube seeds, Cube allowed, const std::array<Cube, 27>& touching) {
  Cube reached = seeds & (~seeds + 1), front = reached;
  while (front != 0) {
    const auto at = static_cast<std::size_t>(std::countr_zero(front));
    const Cube next = touching[at] & allowed & ~reached;
    reached |= next;
    front = (front & (front - 1)) | next;
  }
  return reached;
}

/// Simple: one 26-part of the foreground round the centre, and one 6-part of the background within the 18-neighbourhood
/// that touches the centre.
bool isSimple(Cube cube) {
  const Neighbours& table = neighbours();
  const Cube foreground = cube & ~bit(centre), background = ~cube & table.inN18, holes = background & table.inN6;
  if (foreground == 0 || flood(foreground, foreground, table.touching26) != foreground) return false;
  return holes != 0 && (holes & ~flood(holes, background, table.touching6)) == 0;
}

/// A mask that voxels are taken from.
class Thinning {
 public:
  explicit Thinning(image::Mask& mask) : mask_(mask), grid_(mask.grid) {
    for (int n = 0; n < 27; ++n) {
      const Eigen::Vector3i d = step(n);
      jumps_[static_cast<std::size_t>(n)] =
          d.x() + std::ptrdiff_t{grid_.size.x()} * (d.y() + std::ptrdiff_t{grid_.size.y()} * d.z());
    }
  }

  bool inside(const Eigen::Vector3i& p) const { return grid_.contains(p) && mask_.at(p) != 0; }
  bool removable(const Eigen::Vector3i& p) const {
    const Cube cube = around(p);
    return std::popcount(cube & ~bit(centre)) > 1 && isSimple(cube);
  }
  void remove(const Eigen::Vector3i& p) { mask_.at(p) = 0; }

 private:
  static Eigen::Vector3i step(int n) { return {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1}; }

  Cube around(const Eigen::Vector3i& p) const {
    const bool all = (p.array() > 0).all() && (p.array() + 1 < grid_.size.array()).all();
    const std::uint8_t* at = mask_.values.data() + grid_.linear(p);
    Cube cube = 0;
    for (int n = 0; n < 27; ++n)
      if (all ? at[jumps_[static_cast<std::size_t>(n)]] != 0 : inside(p + step(n))) cube |= bit(n);
    return cube;
  }

  image::Mask& mask_;
  const image::Grid& grid_;
  std::array<std::ptrdiff_t, 27> jumps_{};
};

}  // namespace

std::vector<Eigen::Vector3i> voxelsOf(const image::Mask& mask) {
  std::vector<Eigen::Vector3i> voxels;
  const image::Grid& grid = mask.grid;
  std::size_t n = 0;
  for (int k = 0; k < grid.size.z(); ++k)
    for (int j = 0; j < grid.size.y(); ++j)
      for (int i = 0; i < grid.size.x(); ++i, ++n)
        if (mask.values[n] != 0) voxels.emplace_back(i, j, k);
  return voxels;
}

void thin(image::Mask& mask, std::vector<Eigen::Vector3i>& voxels) {
  Thinning thinning(mask);
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
        if (!thinning.inside(p + side) && thinning.removable(p)) border.push_back(p);
      for (const Eigen::Vector3i& p : border) {
        if (!thinning.removable(p)) continue;  // a neighbour went first
        thinning.remove(p);
        changed = true;
      }
      std::erase_if(voxels, [&](const Eigen::Vector3i& p) { return mask.at(p) == 0; });
    }
  }
}

image::Mask skeleton(const image::Mask& mask) {
  image::Mask result = mask;
  std::vector<Eigen::Vector3i> voxels = voxelsOf(mask);
  thin(result, voxels);
  return result;
}

}  // namespace glisson::anatomy
