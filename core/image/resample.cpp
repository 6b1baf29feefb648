// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/resample.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace glisson::image {
namespace {

constexpr double snap = 1e-6;  // voxels

/// Index coordinates of the voxel centres of target in the frame of source: affine, so three columns and an offset.
struct IndexMap {
  Eigen::Matrix3d columns;
  Eigen::Vector3d offset;
  IndexMap(const Grid& source, const Grid& target)
      : columns(source.spacing_mm.cwiseInverse().asDiagonal() * source.direction.transpose() * target.direction *
                target.spacing_mm.asDiagonal()),
        offset(source.lpsToIndex(target.origin_lps_mm)) {}
  Eigen::Vector3d operator()(int i, int j, int k) const { return columns * Eigen::Vector3d(i, j, k) + offset; }
};

std::optional<Eigen::Vector3i> nearest(const Grid& grid, const Eigen::Vector3d& index) {
  Eigen::Vector3i ijk;
  for (int a = 0; a < 3; ++a) {
    if (!(index[a] >= -0.5 - snap && index[a] < grid.size[a] - 0.5 + snap)) return std::nullopt;
    ijk[a] = std::clamp(static_cast<int>(std::floor(index[a] + 0.5 + snap)), 0, grid.size[a] - 1);
  }
  return ijk;
}

float linear(const ScalarVolume& volume, const Eigen::Vector3d& index, float outside) {
  int low[3], high[3];
  double weight[3];
  for (int a = 0; a < 3; ++a) {
    const int last = volume.grid.size[a] - 1;
    if (!(index[a] >= -0.5 - snap && index[a] <= last + 0.5 + snap)) return outside;
    double x = std::clamp(index[a], 0.0, static_cast<double>(last));
    const double whole = std::round(x);
    if (std::abs(x - whole) < snap) x = whole;
    low[a] = static_cast<int>(x);
    weight[a] = x - low[a];
    high[a] = std::min(low[a] + 1, last);
  }
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    double w = 1.0;
    int at[3];
    for (int a = 0; a < 3; ++a) {
      const bool upper = (corner >> a & 1) != 0;
      w *= upper ? weight[a] : 1.0 - weight[a];
      at[a] = upper ? high[a] : low[a];
    }
    if (w > 0.0) sum += w * static_cast<double>(volume.at(at[0], at[1], at[2]));
  }
  return static_cast<float>(sum);
}

/// Calls body(i, j, k, linear index) for all voxels, in parallel by rows.
template <typename Body>
void forVoxels(const Grid& grid, const Body& body) {
  const auto rows = static_cast<std::size_t>(grid.size.y()) * static_cast<std::size_t>(grid.size.z());
  parallelChunks(rows, 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const int j = static_cast<int>(row % static_cast<std::size_t>(grid.size.y()));
      const int k = static_cast<int>(row / static_cast<std::size_t>(grid.size.y()));
      for (int i = 0; i < grid.size.x(); ++i) body(i, j, k, grid.linear(i, j, k));
    }
  });
}

template <typename T>
Volume<T> nearestVolume(const Volume<T>& source, const Grid& target, T outside) {
  target.check();
  Volume<T> result(target, outside);
  const IndexMap map(source.grid, target);
  forVoxels(target, [&](int i, int j, int k, std::size_t at) {
    if (const auto ijk = nearest(source.grid, map(i, j, k))) result.values[at] = source.at(*ijk);
  });
  return result;
}

}  // namespace

std::optional<Eigen::Vector3i> voxelAt(const Grid& grid, const Eigen::Vector3d& p_lps) {
  return nearest(grid, grid.lpsToIndex(p_lps));
}

float sampleLinear(const ScalarVolume& volume, const Eigen::Vector3d& p_lps, float outside) {
  return linear(volume, volume.grid.lpsToIndex(p_lps), outside);
}

ScalarVolume resampleLinear(const ScalarVolume& volume, const Grid& target, float outside) {
  target.check();
  ScalarVolume result(target, outside);
  const IndexMap map(volume.grid, target);
  forVoxels(target,
            [&](int i, int j, int k, std::size_t at) { result.values[at] = linear(volume, map(i, j, k), outside); });
  return result;
}

Mask resampleNearest(const Mask& mask, const Grid& target) {
  return nearestVolume<std::uint8_t>(mask, target, 0);
}

LabelMap resampleNearest(const LabelMap& labels, const Grid& target) {
  return nearestVolume<std::int32_t>(labels, target, 0);
}

ScalarVolume resampleNearest(const ScalarVolume& volume, const Grid& target, float outside) {
  return nearestVolume<float>(volume, target, outside);
}

}  // namespace glisson::image
