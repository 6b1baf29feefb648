// SPDX-License-Identifier: GPL-3.0-or-later
#include "anatomy/surface_field.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "image/distance.h"
#include "image/morphology.h"

namespace glisson::anatomy {
namespace {

/// The mask's bounding box with a margin of empty voxels on every side.
image::Mask cropped(const image::Mask& mask, int margin) {
  const auto [low, high] = image::extentOf(mask).value();
  image::Grid grid = mask.grid;
  grid.size = high - low + Eigen::Vector3i::Constant(1 + 2 * margin);
  const Eigen::Vector3i first = low - Eigen::Vector3i::Constant(margin);
  grid.origin_lps_mm = mask.grid.indexToLps(first.cast<double>());
  image::Mask result(grid);
  for (int k = margin; k < grid.size.z() - margin; ++k)
    for (int j = margin; j < grid.size.y() - margin; ++j)
      for (int i = margin; i < grid.size.x() - margin; ++i)
        result.at(i, j, k) = mask.at(first + Eigen::Vector3i(i, j, k)) != 0 ? 1 : 0;
  return result;
}

/// Signed distances to the outline per slice. A slice without voxels mirrors the nearest one that has some, all
/// negative, so that the zero lies half-way between the two.
image::ScalarVolume shapeField(const image::Mask& mask) {
  image::ScalarVolume field = image::distanceToOutline_mm(mask);
  const int slices = mask.grid.size.z();
  const std::size_t perSlice = mask.grid.linear(0, 0, 1);
  const float least = static_cast<float>(0.5 * mask.grid.spacing_mm.z());
  std::vector<bool> full(static_cast<std::size_t>(slices));
  for (std::size_t k = 0; k < full.size(); ++k) full[k] = std::isfinite(field.values[k * perSlice]);
  for (int k = 0; k < slices; ++k) {
    if (full[static_cast<std::size_t>(k)]) continue;
    int nearest = -1;
    for (int away = 1; away < slices && nearest < 0; ++away)
      for (const int other : {k - away, k + away})
        if (nearest < 0 && other >= 0 && other < slices && full[static_cast<std::size_t>(other)]) nearest = other;
    for (std::size_t p = 0; p < perSlice; ++p)
      field.values[static_cast<std::size_t>(k) * perSlice + p] =
          -std::max(least, std::abs(field.values[static_cast<std::size_t>(nearest) * perSlice + p]));
  }
  return field;
}

/// [1 2 1] / 4 along each axis; the border keeps its values, so that the surface stays closed.
void smooth(image::ScalarVolume& field) {
  const Eigen::Vector3i n = field.grid.size;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3i step = Eigen::Vector3i::Unit(axis);
    image::ScalarVolume next = field;
    parallelChunks(static_cast<std::size_t>(n.z()), 4, [&](std::size_t begin, std::size_t end) {
      for (int k = static_cast<int>(begin); k < static_cast<int>(end); ++k)
        for (int j = 0; j < n.y(); ++j)
          for (int i = 0; i < n.x(); ++i) {
            const Eigen::Vector3i p(i, j, k);
            if (p[axis] == 0 || p[axis] == n[axis] - 1) continue;
            next.at(p) = 0.25F * field.at(p - step) + 0.5F * field.at(p) + 0.25F * field.at(p + step);
          }
    });
    field = std::move(next);
  }
}

/// field on an isotropic lattice of spacing h_mm over the same box (trilinear between voxel centres).
image::ScalarVolume isotropic(const image::ScalarVolume& field, double h_mm) {
  image::Grid grid = field.grid;
  const Eigen::Vector3d extent_mm = (grid.size - Eigen::Vector3i::Ones()).cast<double>().cwiseProduct(grid.spacing_mm);
  for (int a = 0; a < 3; ++a) {
    grid.size[a] = std::max(2, static_cast<int>(std::ceil(extent_mm[a] / h_mm)) + 1);
    grid.spacing_mm[a] = extent_mm[a] / (grid.size[a] - 1);
  }
  image::ScalarVolume result(grid);
  const Eigen::Vector3d scale = grid.spacing_mm.cwiseQuotient(field.grid.spacing_mm);
  parallelChunks(static_cast<std::size_t>(grid.size.z()), 4, [&](std::size_t begin, std::size_t end) {
    for (int k = static_cast<int>(begin); k < static_cast<int>(end); ++k)
      for (int j = 0; j < grid.size.y(); ++j)
        for (int i = 0; i < grid.size.x(); ++i) {
          Eigen::Vector3i low;
          Eigen::Vector3d t;
          for (int a = 0; a < 3; ++a) {
            const double x = scale[a] * Eigen::Vector3i(i, j, k)[a];
            low[a] = std::clamp(static_cast<int>(x), 0, field.grid.size[a] - 2);
            t[a] = std::clamp(x - low[a], 0.0, 1.0);
          }
          double sum = 0.0;
          for (int c = 0; c < 8; ++c) {
            const Eigen::Vector3i corner(c & 1, c >> 1 & 1, c >> 2 & 1);
            double w = 1.0;
            for (int a = 0; a < 3; ++a) w *= corner[a] != 0 ? t[a] : 1.0 - t[a];
            sum += w * static_cast<double>(field.at(low + corner));
          }
          result.at(i, j, k) = static_cast<float>(sum);
        }
  });
  return result;
}

/// Level above which the field holds the wanted volume; a voxel counts in part within half a voxel of the level.
double levelFor(const image::ScalarVolume& field, double volume_mm3) {
  const double h_mm = field.grid.spacing_mm.mean(), voxel_mm3 = field.grid.voxelVolume_mm3();
  double low = -50.0 * h_mm, high = 50.0 * h_mm;
  for (int round = 0; round < 40; ++round) {
    const double level = 0.5 * (low + high);
    const double held = voxel_mm3 * parallelSum(field.values.size(), 1u << 16, [&](std::size_t b, std::size_t e) {
                          double s = 0.0;
                          for (std::size_t i = b; i < e; ++i)
                            s += std::clamp(0.5 + (static_cast<double>(field.values[i]) - level) / h_mm, 0.0, 1.0);
                          return s;
                        });
    (held > volume_mm3 ? low : high) = level;
  }
  return 0.5 * (low + high);
}

}  // namespace

SurfaceField surfaceField(const image::Mask& mask, double resolution_mm) {
  const std::size_t voxels = image::count(mask);
  if (voxels == 0) throw BadInput("the mask is empty (no voxel inside): there is no surface to build");
  SurfaceField result;
  result.volume_mm3 = static_cast<double>(voxels) * mask.grid.voxelVolume_mm3();
  const image::Mask box = cropped(mask, 2);
  const double inPlane_mm = box.grid.spacing_mm.head<2>().maxCoeff();
  const double extent_mm = box.grid.size.cast<double>().cwiseProduct(box.grid.spacing_mm).maxCoeff();
  // A body of a few voxels needs a finer lattice than its own, or smoothing would leave nothing of it.
  const double own_mm = std::min(box.grid.spacing_mm.minCoeff(), extent_mm / 24.0);
  const double h_mm = resolution_mm > 0.0 ? resolution_mm : std::max(own_mm, extent_mm / 128.0);
  const bool thick = box.grid.spacing_mm.z() > 1.5 * inPlane_mm;
  result.values_mm = isotropic(thick ? shapeField(box) : image::distanceToBoundary_mm(box), h_mm);
  smooth(result.values_mm);
  smooth(result.values_mm);
  result.level_mm = levelFor(result.values_mm, result.volume_mm3);
  return result;
}

}  // namespace glisson::anatomy
