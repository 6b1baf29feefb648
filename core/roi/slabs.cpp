#include "roi/detail/slabs.h"

namespace glisson::roi::detail {
namespace {

void addCrossing(const Edge& a, const Edge& b, std::vector<double>& heights) {
  const Eigen::Vector2d r = a.high - a.low, s = b.high - b.low, d = b.low - a.low;
  const double cross = r.x() * s.y() - r.y() * s.x();
  if (cross == 0.0) return;
  const double t = (d.x() * s.y() - d.y() * s.x()) / cross;
  if (t > 0.0 && t < 1.0) heights.push_back(a.low.y() + t * r.y());
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

}  // namespace glisson::roi::detail
