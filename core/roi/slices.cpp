// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/order_statistics.h"
#include "roi/arrangement.h"
#include "roi/detail/slabs.h"
#include "roi/plane.h"

namespace glisson::roi {
namespace {

constexpr double levelWithin = 1e-6;  ///< slices: as good as the same height

Eigen::Matrix2Xd ringOn(const Polygon& polygon, const image::Grid& grid) {
  const Eigen::Matrix3Xd offset_mm = polygon.points_lps_mm.colwise() - grid.origin_lps_mm;
  return grid.direction.leftCols<2>().transpose() * offset_mm;
}

/// A polygon that counts, as the slices see it.
struct Seen {
  std::size_t polygon = 0;
  double k = 0.0;  ///< slice, not rounded
  Eigen::Matrix2Xd ring_mm;
  Eigen::Vector2d low, high;

  bool mayOverlap(const Seen& other) const {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }
};

/// Whether two polygons share more than a touch, whatever their heights.
bool overlap(const Seen& a, const Seen& b) {
  if (!a.mayOverlap(b)) return false;
  double shared = 0.0, areaA = 0.0, areaB = 0.0;
  detail::forTrapezoids({a.ring_mm, b.ring_mm}, [&](const std::vector<bool>& in, double area) {
    areaA += in[0] ? area : 0.0;
    areaB += in[1] ? area : 0.0;
    shared += in[0] && in[1] ? area : 0.0;
  });
  return shared > 0.01 * std::min(areaA, areaB);
}

/// The usual distance between a polygon and the next one above or below it, in slices; 1 where there is none.
double usualStep(const std::vector<Seen>& all) {
  std::vector<double> steps;
  std::vector<std::size_t> byHeight(all.size());
  for (std::size_t n = 0; n < all.size(); ++n) byHeight[n] = n;
  std::sort(byHeight.begin(), byHeight.end(), [&all](std::size_t a, std::size_t b) { return all[a].k < all[b].k; });
  for (std::size_t at = 0; at < byHeight.size(); ++at) {
    const Seen& lower = all[byHeight[at]];
    for (std::size_t next = at + 1; next < byHeight.size(); ++next) {
      const Seen& upper = all[byHeight[next]];
      if (upper.k - lower.k <= levelWithin || !lower.mayOverlap(upper)) continue;
      steps.push_back(upper.k - lower.k);
      break;
    }
  }
  if (steps.empty()) return 1.0;
  return middleValue(steps);
}

/// Chooses among the polygons nearest to slice k.
std::vector<std::size_t> choose(const std::vector<Seen>& all, std::vector<std::size_t> near, double k, double step,
                                double slice_mm, SliceOutlines& result) {
  std::stable_sort(near.begin(), near.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(all[a].k - k) < std::abs(all[b].k - k) - levelWithin;
  });
  const double level = all[near.front()].k, sameLevel = std::min(levelWithin_slices, 0.5 * step);
  std::vector<std::size_t> taken;
  for (const std::size_t n : near) {
    const double off = std::abs(all[n].k - level);
    if (off <= sameLevel + levelWithin) {
      taken.push_back(n);
      continue;
    }
    if (off >= 0.5 * step) continue;  // a plane of its own, in a stack finer than the grid
    const bool free = std::none_of(taken.begin(), taken.end(), [&](std::size_t t) { return overlap(all[n], all[t]); });
    if (free) taken.push_back(n);
    (free ? result.offPlane : result.leftOut).push_back(all[n].polygon);
    result.farthestOffPlane_mm = std::max(result.farthestOffPlane_mm, off * slice_mm);
  }
  std::vector<std::size_t> polygons;
  for (const std::size_t n : taken) polygons.push_back(all[n].polygon);
  std::sort(polygons.begin(), polygons.end());
  return polygons;
}

}  // namespace

SliceOutlines outlinesOf(const ContourStack& contours, const image::Grid& grid) {
  SliceOutlines result;
  std::vector<Seen> all;
  std::vector<std::vector<std::size_t>> near(static_cast<std::size_t>(grid.size.z()));
  bool several = false;
  for (std::size_t p = 0; p < contours.polygons.size(); ++p) {
    const Polygon& polygon = contours.polygons[p];
    if (polygon.state == PolygonState::Draft) continue;
    Seen seen{p, sliceOf(polygon, grid), ringOn(polygon, grid), {}, {}};
    seen.low = seen.ring_mm.rowwise().minCoeff();
    seen.high = seen.ring_mm.rowwise().maxCoeff();
    const double k = std::ceil(seen.k - 0.5 - levelWithin);  // half-way: the lower slice
    if (k < 0.0 || k >= grid.size.z()) {
      result.beyond.push_back(p);
    } else {
      std::vector<std::size_t>& here = near[static_cast<std::size_t>(k)];
      several = several || (!here.empty() && std::abs(all[here.front()].k - seen.k) > levelWithin);
      here.push_back(all.size());
    }
    all.push_back(std::move(seen));
  }
  const double step = several ? usualStep(all) : 1.0;
  for (std::size_t k = 0; k < near.size(); ++k)
    result.members.push_back(near[k].empty()
                                 ? std::vector<std::size_t>{}
                                 : choose(all, near[k], static_cast<double>(k), step, grid.spacing_mm.z(), result));
  return result;
}

std::vector<std::vector<std::size_t>> polygonsPerSlice(const ContourStack& contours, const image::Grid& grid) {
  return outlinesOf(contours, grid).members;
}

}  // namespace glisson::roi
