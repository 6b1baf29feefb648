// SPDX-License-Identifier: GPL-3.0-or-later
#include "roi/detail/slabs.h"

#include <cstdlib>
#include <utility>

namespace glisson::roi::detail {
namespace {

void addCrossing(const Edge& a, const Edge& b, std::vector<double>& heights) {
  const Eigen::Vector2d r = a.high - a.low, s = b.high - b.low, d = b.low - a.low;
  const double cross = r.x() * s.y() - r.y() * s.x();
  if (cross == 0.0) return;
  const double t = (d.x() * s.y() - d.y() * s.x()) / cross;
  if (t > 0.0 && t < 1.0) heights.push_back(a.low.y() + t * r.y());
}

/// 1 where the ring's edge from that vertex on rises, -1 where it comes down.
struct DirectedEdge {
  Edge edge;
  int rises = 1;
};

std::vector<DirectedEdge> directedEdgesOf(const Eigen::Matrix2Xd& ring) {
  std::vector<DirectedEdge> edges;
  for (Eigen::Index v = 0; v < ring.cols(); ++v) {
    DirectedEdge e{{ring.col(v), ring.col((v + 1) % ring.cols()), 0}, 1};
    if (e.edge.low.y() == e.edge.high.y()) continue;
    if (e.edge.low.y() > e.edge.high.y()) {
      std::swap(e.edge.low, e.edge.high);
      e.rises = -1;
    }
    edges.push_back(e);
  }
  std::stable_sort(edges.begin(), edges.end(),
                   [](const DirectedEdge& a, const DirectedEdge& b) { return a.edge.low.y() < b.edge.low.y(); });
  return edges;
}

}  // namespace

std::vector<Edge> edgesOf(const std::vector<Eigen::Matrix2Xd>& rings) {
  std::vector<Edge> edges;
  for (std::size_t r = 0; r < rings.size(); ++r)
    for (Eigen::Index v = 0; v < rings[r].cols(); ++v) {
      Edge edge{rings[r].col(v), rings[r].col((v + 1) % rings[r].cols()), r};
      if (edge.low.y() == edge.high.y()) continue;
      if (edge.low.y() > edge.high.y()) std::swap(edge.low, edge.high);
      edges.push_back(edge);
    }
  std::stable_sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.low.y() < b.low.y(); });
  return edges;
}

std::vector<double> slabHeights(const std::vector<Edge>& sorted) {
  std::vector<double> heights;
  for (std::size_t a = 0; a < sorted.size(); ++a) {
    heights.push_back(sorted[a].low.y());
    heights.push_back(sorted[a].high.y());
    for (std::size_t b = a + 1; b < sorted.size() && sorted[b].low.y() < sorted[a].high.y(); ++b)
      addCrossing(sorted[a], sorted[b], heights);
  }
  std::sort(heights.begin(), heights.end());
  heights.erase(std::unique(heights.begin(), heights.end()), heights.end());
  return heights;
}

Windings windingsOf(const Eigen::Matrix2Xd& ring) {
  const std::vector<DirectedEdge> sorted = directedEdgesOf(ring);
  const std::vector<double> heights = slabHeights(edgesOf({ring}));
  double left = 0.0, right = 0.0;
  Windings w;
  std::vector<const DirectedEdge*> active;
  std::vector<std::pair<double, int>> row;
  std::size_t next = 0;
  for (std::size_t h = 0; h + 1 < heights.size(); ++h) {
    const double bottom = heights[h], top = heights[h + 1];
    std::erase_if(active, [&](const DirectedEdge* e) { return e->edge.high.y() <= bottom; });
    while (next < sorted.size() && sorted[next].edge.low.y() <= bottom) active.push_back(&sorted[next++]);
    row.clear();
    for (const DirectedEdge* e : active)
      if (e->edge.high.y() > bottom) row.emplace_back(e->edge.xAt(0.5 * (bottom + top)), e->rises);
    std::stable_sort(row.begin(), row.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    int winding = 0;
    for (std::size_t e = 0; e + 1 < row.size(); ++e) {
      winding += row[e].second;
      const double area = (row[e + 1].first - row[e].first) * (top - bottom);
      left += winding > 0 ? area : 0.0;
      right += winding < 0 ? area : 0.0;
      w.odd += winding % 2 != 0 ? area : 0.0;
      w.more += std::abs(winding) > 1 ? area : 0.0;
    }
  }
  w.against = std::min(left, right);
  return w;
}

}  // namespace glisson::roi::detail
