// SPDX-License-Identifier: GPL-3.0-or-later
#include "roi/interpolate.h"

#include <algorithm>

#include "base/error.h"
#include "image/distance.h"
#include "image/morphology.h"
#include "roi/plane.h"
#include "roi/polygon.h"
#include "roi/trace.h"

namespace glisson::roi {
namespace {

constexpr double simplification_pixels = 0.2;
/// Vertices keep this part of the way between two centres from either, so that no centre comes to lie on an edge.
constexpr double leastPart = 0.02;

std::size_t pixelsOf(const image::Grid& grid) {
  return static_cast<std::size_t>(grid.size.x()) * static_cast<std::size_t>(grid.size.y());
}

/// One slice of a grid as a grid.
image::Grid oneSlice(const image::Grid& grid, int k) {
  image::Grid slice = grid;
  slice.origin_lps_mm = grid.indexToLps({0.0, 0.0, static_cast<double>(k)});
  slice.size.z() = 1;
  return slice;
}

/// Signed distances of the drawn slices only, and what lies between them.
class BetweenSlices {
 public:
  /// drawn: slices of mask with voxels, ascending.
  BetweenSlices(const image::Mask& mask, std::vector<int> drawn) : grid_(mask.grid), drawn_(std::move(drawn)) {
    image::Grid packed = grid_;
    packed.size.z() = static_cast<int>(drawn_.size());
    image::Mask some(packed);
    const std::size_t n = pixelsOf(grid_);
    for (std::size_t d = 0; d < drawn_.size(); ++d)
      std::copy_n(mask.values.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(drawn_[d]) * n), n,
                  some.values.begin() + static_cast<std::ptrdiff_t>(d * n));
    distance_mm_ = image::distanceToOutline_mm(some);
  }

  /// The interpolated distance of slice k, which lies strictly between the first and the last drawn one.
  image::ScalarVolume at(int k) const {
    const auto above = static_cast<std::size_t>(std::upper_bound(drawn_.begin(), drawn_.end(), k) - drawn_.begin());
    const double t =
        static_cast<double>(k - drawn_[above - 1]) / static_cast<double>(drawn_[above] - drawn_[above - 1]);
    image::ScalarVolume field(oneSlice(grid_, k));
    const std::size_t n = pixelsOf(grid_);
    for (std::size_t i = 0; i < n; ++i)
      field.values[i] = static_cast<float>((1.0 - t) * static_cast<double>(distance_mm_.values[(above - 1) * n + i]) +
                                           t * static_cast<double>(distance_mm_.values[above * n + i]));
    return field;
  }

 private:
  image::Grid grid_;
  std::vector<int> drawn_;
  image::ScalarVolume distance_mm_;
};

image::Mask insideOf(const image::ScalarVolume& field) {
  image::Mask inside(field.grid);
  std::transform(field.values.begin(), field.values.end(), inside.values.begin(),
                 [](float d) { return static_cast<std::uint8_t>(d > 0.0F ? 1 : 0); });
  return inside;
}

/// Where between the two centres around a half-way point the field is 0: index coordinates.
Eigen::Vector3d levelPoint(const image::ScalarVolume& field, const HalfPoint& point) {
  const Eigen::Vector3d middle(0.5 * point[0], 0.5 * point[1], 0.0);
  const int axis = point[0] % 2 != 0 ? 0 : 1;
  Eigen::Vector3d low = middle, high = middle;
  low[axis] -= 0.5;
  high[axis] += 0.5;
  const Eigen::Vector3i a = low.cast<int>(), b = high.cast<int>();
  if (!field.grid.contains(a) || !field.grid.contains(b)) return middle;
  const double fa = static_cast<double>(field.at(a)), fb = static_cast<double>(field.at(b));
  return low + std::clamp(fa / (fa - fb), leastPart, 1.0 - leastPart) * (high - low);
}

std::vector<int> slicesWithVoxels(const image::Mask& mask) {
  std::vector<int> result;
  const std::size_t n = pixelsOf(mask.grid);
  for (int k = 0; k < mask.grid.size.z(); ++k) {
    const auto first = mask.values.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(k) * n);
    if (std::any_of(first, first + static_cast<std::ptrdiff_t>(n), [](auto v) { return v != 0; })) result.push_back(k);
  }
  return result;
}

std::vector<int> gaps(const std::vector<int>& sorted) {
  std::vector<int> result;
  for (std::size_t d = 0; d + 1 < sorted.size(); ++d)
    for (int k = sorted[d] + 1; k < sorted[d + 1]; ++k) result.push_back(k);
  return result;
}

}  // namespace

std::vector<int> emptySlicesBetween(const ContourStack& contours, const image::Grid& grid) {
  grid.check();
  const auto slices = polygonsPerSlice(contours, grid);
  std::vector<int> drawn;
  for (std::size_t k = 0; k < slices.size(); ++k)
    if (std::any_of(slices[k].begin(), slices[k].end(), [&](std::size_t p) { return !contours.polygons[p].exclude; }))
      drawn.push_back(static_cast<int>(k));
  return gaps(drawn);
}

image::Mask interpolateSlices(const image::Mask& mask) {
  if (image::count(mask) == 0)
    throw BadInput("the mask is empty (no voxel inside): there is nothing to interpolate between");
  const std::vector<int> drawn = slicesWithVoxels(mask), empty = gaps(drawn);
  image::Mask result = mask;
  if (empty.empty()) return result;
  const BetweenSlices between(mask, drawn);
  const std::size_t n = pixelsOf(mask.grid);
  for (const int k : empty)
    std::ranges::copy(insideOf(between.at(k)).values,
                      result.values.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(k) * n));
  return result;
}

ContourStack interpolateBetween(const ContourStack& contours, const image::Grid& grid) {
  ContourStack result = contours;
  const std::vector<int> empty = emptySlicesBetween(contours, grid);
  if (empty.empty()) return result;
  const image::Mask mask = rasterise(contours, grid);
  const std::vector<int> drawn = slicesWithVoxels(mask);
  if (drawn.empty()) return result;
  const BetweenSlices between(mask, drawn);
  const double tolerance_mm = simplification_pixels * grid.spacing_mm.head<2>().minCoeff();
  for (const int k : empty) {
    if (k < drawn.front() || k > drawn.back()) continue;
    const image::ScalarVolume field = between.at(k);
    for (const std::vector<HalfPoint>& ring : ringsOf(insideOf(field), 0)) {
      Polygon polygon;
      polygon.state = PolygonState::Interpolated;
      polygon.points_lps_mm.resize(3, static_cast<Eigen::Index>(ring.size()));
      for (std::size_t v = 0; v < ring.size(); ++v)
        polygon.points_lps_mm.col(static_cast<Eigen::Index>(v)) = field.grid.indexToLps(levelPoint(field, ring[v]));
      polygon = simplified(polygon, tolerance_mm);
      if (!refusal(polygon, field.grid)) result.polygons.push_back(std::move(polygon));
    }
  }
  return result;
}

}  // namespace glisson::roi
