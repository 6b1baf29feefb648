// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <vector>

// Slab decomposition: between two neighbouring heights of vertices and crossings no edges cross, so the plane is a row
// of trapezoids, and their areas are exact.
namespace glisson::roi::detail {

struct Edge {
  Eigen::Vector2d low, high;  ///< low.y < high.y
  std::size_t ring = 0;
  double xAt(double y) const { return low.x() + (y - low.y()) * (high.x() - low.x()) / (high.y() - low.y()); }
};

/// Edges of closed rings (2 × n, mm), level ones left out, by rising low end.
std::vector<Edge> edgesOf(const std::vector<Eigen::Matrix2Xd>& rings);

/// Heights of all ends and of all crossings, ascending, each once. Expects the order of edgesOf.
std::vector<double> slabHeights(const std::vector<Edge>& sorted);

/// Areas that a ring runs round, mm²: an odd number of times, twice or more, and the smaller one of those that it runs
/// round to the left and to the right.
struct Windings {
  double odd = 0.0, more = 0.0, against = 0.0;
};
Windings windingsOf(const Eigen::Matrix2Xd& ring);

/// Calls visit(in, area_mm2) for every trapezoid that lies between two edges of a slab; in[r] tells whether it lies
/// inside ring r (even-odd).
template <typename Visit>
void forTrapezoids(const std::vector<Eigen::Matrix2Xd>& rings, Visit visit) {
  const std::vector<Edge> sorted = edgesOf(rings);
  const std::vector<double> heights = slabHeights(sorted);
  std::vector<const Edge*> active;
  std::vector<std::pair<double, const Edge*>> row;
  std::vector<bool> in(rings.size());
  std::size_t next = 0;
  for (std::size_t h = 0; h + 1 < heights.size(); ++h) {
    const double bottom = heights[h], top = heights[h + 1], middle = 0.5 * (bottom + top);
    std::erase_if(active, [&](const Edge* e) { return e->high.y() <= bottom; });
    while (next < sorted.size() && sorted[next].low.y() <= bottom) active.push_back(&sorted[next++]);
    row.clear();
    for (const Edge* e : active)
      if (e->high.y() > bottom) row.emplace_back(e->xAt(middle), e);
    std::stable_sort(row.begin(), row.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::fill(in.begin(), in.end(), false);
    for (std::size_t e = 0; e < row.size(); ++e) {
      if (e > 0) visit(in, (row[e].first - row[e - 1].first) * (top - bottom));
      const std::size_t r = row[e].second->ring;
      in[r] = !in[r];
    }
  }
}

}  // namespace glisson::roi::detail
