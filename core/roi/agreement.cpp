// SPDX-License-Identifier: GPL-3.0-or-later
#include "roi/agreement.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/order_statistics.h"
#include "image/distance.h"
#include "image/morphology.h"

namespace glisson::roi {
namespace {

image::Mask borderOf(const image::Mask& mask, int axes) {
  image::Mask border(mask.grid);
  for (int k = 0; k < mask.grid.size.z(); ++k)
    for (int j = 0; j < mask.grid.size.y(); ++j)
      for (int i = 0; i < mask.grid.size.x(); ++i) {
        if (mask.at(i, j, k) == 0) continue;
        for (int axis = 0; axis < axes; ++axis)
          for (const int side : {-1, 1}) {
            Eigen::Vector3i n(i, j, k);
            n[axis] += side;
            if (!mask.grid.contains(n) || mask.at(n) == 0) border.at(i, j, k) = 1;
          }
      }
  return border;
}

/// From every border voxel of one to the nearest border voxel of the other; both not empty.
void distances(const image::Mask& from, const image::Mask& to, std::vector<double>& out) {
  const std::vector<std::size_t> nearest = image::nearestInside(to);
  const auto nx = static_cast<std::size_t>(from.grid.size.x()), ny = static_cast<std::size_t>(from.grid.size.y());
  const auto squared = [&](std::size_t a, std::size_t b, std::size_t step, std::size_t n, double spacing_mm) {
    const double d_mm = (static_cast<double>(a / step % n) - static_cast<double>(b / step % n)) * spacing_mm;
    return d_mm * d_mm;
  };
  const Eigen::Vector3d& h_mm = from.grid.spacing_mm;
  const auto nz = static_cast<std::size_t>(from.grid.size.z());
  for (std::size_t v = 0; v < from.values.size(); ++v) {
    if (from.values[v] == 0) continue;
    const std::size_t n = nearest[v];
    out.push_back(std::sqrt(squared(v, n, 1, nx, h_mm.x()) + squared(v, n, nx, ny, h_mm.y()) +
                            squared(v, n, nx * ny, nz, h_mm.z())));
  }
}

image::Mask sliceOf(const image::Mask& mask, int k) {
  image::Grid grid = mask.grid;
  grid.size.z() = 1;
  image::Mask slice(grid);
  const std::size_t n = mask.grid.linear(0, 0, 1);
  std::copy_n(mask.values.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(k) * n), n,
              slice.values.begin());
  return slice;
}

void fillDistances(Agreement& result, std::vector<double> ab, std::vector<double> ba) {
  double sum = 0.0;
  for (const auto* list : {&ab, &ba})
    for (const double d : *list) {
      sum += d;
      result.hausdorff_mm = std::max(result.hausdorff_mm, d);
    }
  result.meanSurfaceDistance_mm = sum / static_cast<double>(ab.size() + ba.size());
  result.hausdorff95_mm = std::max(percentile(ab, 0.95), percentile(ba, 0.95));
}

}  // namespace

Agreement agreement(const image::Mask& a, const image::Mask& b, Border border) {
  if (!a.grid.sameGeometry(b.grid)) throw BadInput("the two regions lie on different grids; map one onto the other");
  const auto inA = static_cast<double>(image::count(a)), inB = static_cast<double>(image::count(b));
  if (inA == 0.0 || inB == 0.0)
    throw BadInput(std::string("the ") + (inA == 0.0 ? "first" : "second") + " region is empty: nothing to compare");
  double both = 0.0;
  for (std::size_t v = 0; v < a.values.size(); ++v) both += a.values[v] != 0 && b.values[v] != 0 ? 1.0 : 0.0;
  Agreement result;
  result.dice = 2.0 * both / (inA + inB);
  result.jaccard = both / (inA + inB - both);
  const double voxel_mL = 1e-3 * a.grid.voxelVolume_mm3();
  result.volumeA_mL = inA * voxel_mL;
  result.volumeB_mL = inB * voxel_mL;
  result.volumeDifference_mL = result.volumeB_mL - result.volumeA_mL;
  result.volumeDifference_percent = 200.0 * (inB - inA) / (inA + inB);
  std::vector<double> ab, ba;
  for (int k = 0; k < a.grid.size.z(); ++k) {
    const image::Mask sliceA = sliceOf(a, k), sliceB = sliceOf(b, k);
    const bool hasA = image::count(sliceA) > 0, hasB = image::count(sliceB) > 0;
    if (hasA && !hasB) result.slicesOnlyInA.push_back(k);
    if (hasB && !hasA) result.slicesOnlyInB.push_back(k);
    if (border == Border::Surface || !hasA || !hasB) continue;
    const image::Mask outlineA = borderOf(sliceA, 2), outlineB = borderOf(sliceB, 2);
    distances(outlineA, outlineB, ab);
    distances(outlineB, outlineA, ba);
  }
  if (border == Border::Surface) {
    const image::Mask surfaceA = borderOf(a, 3), surfaceB = borderOf(b, 3);
    distances(surfaceA, surfaceB, ab);
    distances(surfaceB, surfaceA, ba);
  }
  if (ab.empty()) throw BadInput("the two regions share no slice: there is no distance between their outlines");
  fillDistances(result, std::move(ab), std::move(ba));
  return result;
}

}  // namespace glisson::roi
