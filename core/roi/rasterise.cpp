// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/error.h"
#include "roi/arrangement.h"
#include "roi/plane.h"

// Index coordinates are rounded to 2^-20 pixel and the crossing of an edge with a row of centres is found in integers,
// so that a tie is a tie whatever the orientation of the image, and the common edge of two polygons gives one answer.
namespace glisson::roi {
namespace {

__extension__ using Wide = __int128;

constexpr double fixedPoint = 1048576.0;  // 2^20 units per pixel
constexpr std::int64_t one = 1048576;

struct FixedPolygon {
  std::vector<std::int64_t> x, y;  // column and row index, fixed point
};

FixedPolygon toFixed(const Polygon& polygon, const image::Grid& grid) {
  FixedPolygon fixed;
  for (Eigen::Index v = 0; v < polygon.points_lps_mm.cols(); ++v) {
    const Eigen::Vector3d index = grid.lpsToIndex(polygon.points_lps_mm.col(v));
    fixed.x.push_back(std::llround(index.x() * fixedPoint));
    fixed.y.push_back(std::llround(index.y() * fixedPoint));
  }
  return fixed;
}

Wide ceilDivide(Wide a, Wide b) {  // b > 0
  const Wide q = a / b;
  return (a % b != 0 && a > 0) ? q + 1 : q;
}

/// Flips the parity of every voxel of the slice whose centre lies inside the polygon: for each edge, all centres of a
/// row at or beyond the crossing.
void flipInside(const FixedPolygon& polygon, int columns, int rows, std::vector<std::uint8_t>& parity) {
  const std::size_t n = polygon.x.size();
  for (std::size_t v = 0; v < n; ++v) {
    std::size_t low = v, high = (v + 1) % n;
    if (polygon.y[low] == polygon.y[high]) continue;
    if (polygon.y[low] > polygon.y[high]) std::swap(low, high);
    const Wide x = polygon.x[low], y = polygon.y[low];
    const Wide dx = polygon.x[high] - x, dy = polygon.y[high] - y;
    // Rows j with y_low <= j < y_high: a vertex on a row counts for the edge that goes on towards larger rows.
    const auto first = static_cast<int>(std::clamp<Wide>(ceilDivide(y, one), 0, rows));
    const auto last = static_cast<int>(std::clamp<Wide>(ceilDivide(polygon.y[high], one), 0, rows));
    for (int j = first; j < last; ++j) {
      const Wide crossing = x * dy + (Wide{j} * one - y) * dx;  // times dy, fixed point
      const auto start = static_cast<int>(std::clamp<Wide>(ceilDivide(crossing, dy * one), 0, columns));
      std::uint8_t* row = parity.data() + static_cast<std::size_t>(j) * static_cast<std::size_t>(columns);
      for (int i = start; i < columns; ++i) row[i] ^= 1U;
    }
  }
}

bool meets(const Polygon& polygon, const image::Grid& grid) {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e300), high = -low;
  for (Eigen::Index v = 0; v < polygon.points_lps_mm.cols(); ++v) {
    const Eigen::Vector2d index = grid.lpsToIndex(polygon.points_lps_mm.col(v)).head<2>();
    low = low.cwiseMin(index);
    high = high.cwiseMax(index);
  }
  return (high.array() >= -0.5).all() && low.x() <= grid.size.x() - 0.5 && low.y() <= grid.size.y() - 0.5;
}

}  // namespace

void fillSlice(image::Mask& mask, int k, const ContourStack& contours, const std::vector<std::size_t>& polygons) {
  const int columns = mask.grid.size.x(), rows = mask.grid.size.y();
  const std::size_t pixels = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  std::vector<std::uint8_t> inside(pixels, 0), own(pixels);
  const auto filled = [&](std::size_t p) -> const std::vector<std::uint8_t>& {
    std::fill(own.begin(), own.end(), std::uint8_t{0});
    flipInside(toFixed(contours.polygons[p], mask.grid), columns, rows, own);
    return own;
  };
  std::vector<std::pair<int, std::size_t>> order;  // level, polygon
  std::vector<Eigen::Matrix2Xd> rings;
  std::vector<bool> flips;
  for (const std::size_t p : polygons) {
    if (contours.polygons[p].exclude) continue;
    order.emplace_back(0, p);
    rings.emplace_back(mask.grid.direction.leftCols<2>().transpose() *
                       (contours.polygons[p].points_lps_mm.colwise() - mask.grid.origin_lps_mm));
    flips.push_back(contours.polygons[p].combine == Combine::Parity);
  }
  if (!order.empty()) {
    const Arrangement arrangement = arrange(rings, flips);
    for (std::size_t n = 0; n < order.size(); ++n) order[n].first = arrangement.level[n];
  }
  std::stable_sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [level, p] : order) {
    if (level < 0) continue;
    const std::vector<std::uint8_t>& here = filled(p);
    for (std::size_t i = 0; i < pixels; ++i)
      if (here[i] != 0) inside[i] = level % 2 == 0 ? 1 : 0;
  }
  for (const auto& [level, p] : order)
    if (level == Arrangement::parity) flipInside(toFixed(contours.polygons[p], mask.grid), columns, rows, inside);
  for (const std::size_t p : polygons) {
    if (!contours.polygons[p].exclude) continue;
    const std::vector<std::uint8_t>& out = filled(p);
    for (std::size_t i = 0; i < pixels; ++i)
      if (out[i] != 0) inside[i] = 0;
  }
  std::copy(inside.begin(), inside.end(),
            mask.values.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(k) * pixels));
}

image::Mask rasterise(const ContourStack& contours, const image::Grid& grid) {
  grid.check();
  const auto slices = polygonsPerSlice(contours, grid);
  const bool any = std::any_of(slices.begin(), slices.end(), [&](const std::vector<std::size_t>& members) {
    return std::any_of(members.begin(), members.end(),
                       [&](std::size_t p) { return meets(contours.polygons[p], grid); });
  });
  if (!any) {
    const auto drafts = std::count_if(contours.polygons.begin(), contours.polygons.end(),
                                      [](const Polygon& p) { return p.state == PolygonState::Draft; });
    throw BadInput("none of the " + std::to_string(contours.polygons.size()) + " polygons (" + std::to_string(drafts) +
                   " of them drafts, which do not count) lies on a slice of the image; check that the contours belong "
                   "to this image");
  }
  image::Mask mask(grid);
  for (std::size_t k = 0; k < slices.size(); ++k)
    if (!slices[k].empty()) fillSlice(mask, static_cast<int>(k), contours, slices[k]);
  return mask;
}

}  // namespace glisson::roi
