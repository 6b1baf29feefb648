#include <algorithm>
#include <cmath>

#include "roi/plane.h"

// Slab decomposition: between two neighbouring heights of vertices and crossings no edges cross, so the region is a row
// of trapezoids, and their areas are exact.
namespace glisson::roi {
namespace {

struct Edge {
  Eigen::Vector2d low, high;  // low.y < high.y
  std::size_t polygon;
  double xAt(double y) const { return low.x() + (y - low.y()) * (high.x() - low.x()) / (high.y() - low.y()); }
};

struct Flat {
  std::vector<Edge> edges;
  std::vector<bool> exclude;  // per polygon
};

void addCrossing(const Edge& a, const Edge& b, std::vector<double>& heights) {
  if (a.low.y() >= b.high.y() || b.low.y() >= a.high.y()) return;
  const Eigen::Vector2d r = a.high - a.low, s = b.high - b.low, d = b.low - a.low;
  const double cross = r.x() * s.y() - r.y() * s.x();
  if (cross == 0.0) return;
  const double t = (d.x() * s.y() - d.y() * s.x()) / cross;
  if (t > 0.0 && t < 1.0) heights.push_back(a.low.y() + t * r.y());
}

double flatArea(const Flat& flat) {
  std::vector<double> heights;
  for (std::size_t a = 0; a < flat.edges.size(); ++a) {
    heights.push_back(flat.edges[a].low.y());
    heights.push_back(flat.edges[a].high.y());
    for (std::size_t b = a + 1; b < flat.edges.size(); ++b) addCrossing(flat.edges[a], flat.edges[b], heights);
  }
  std::sort(heights.begin(), heights.end());
  heights.erase(std::unique(heights.begin(), heights.end()), heights.end());
  std::vector<Edge> sorted = flat.edges;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Edge& a, const Edge& b) { return a.low.y() < b.low.y(); });

  double area = 0.0;
  std::vector<Edge> active;
  std::size_t next = 0;
  std::vector<std::pair<double, const Edge*>> row;
  std::vector<bool> in(flat.exclude.size());
  for (std::size_t h = 0; h + 1 < heights.size(); ++h) {
    const double bottom = heights[h], top = heights[h + 1], middle = 0.5 * (bottom + top);
    std::erase_if(active, [&](const Edge& e) { return e.high.y() <= bottom; });
    while (next < sorted.size() && sorted[next].low.y() <= bottom) active.push_back(sorted[next++]);
    row.clear();
    for (const Edge& e : active)
      if (e.high.y() > bottom) row.emplace_back(e.xAt(middle), &e);
    std::stable_sort(row.begin(), row.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::fill(in.begin(), in.end(), false);
    int excluded = 0;
    bool odd = false;
    for (std::size_t e = 0; e < row.size(); ++e) {
      if (e > 0 && odd && excluded == 0) area += (row[e].first - row[e - 1].first) * (top - bottom);
      const std::size_t p = row[e].second->polygon;
      in[p] = !in[p];
      if (flat.exclude[p]) {
        excluded += in[p] ? 1 : -1;
      } else {
        odd = !odd;
      }
    }
  }
  return area;
}

}  // namespace

double area_mm2(const ContourStack& contours) {
  std::vector<bool> done(contours.polygons.size(), false);
  double total = 0.0;
  for (std::size_t first = 0; first < contours.polygons.size(); ++first) {
    if (done[first] || contours.polygons[first].state == PolygonState::Draft) continue;
    const Plane plane = planeOf(contours.polygons[first]);
    if (!plane.wide) continue;
    Flat flat;
    for (std::size_t p = first; p < contours.polygons.size(); ++p) {
      const Polygon& polygon = contours.polygons[p];
      if (done[p] || polygon.state == PolygonState::Draft) continue;
      const Plane other = planeOf(polygon);
      const bool samePlane = std::abs((other.centre_lps_mm - plane.centre_lps_mm).dot(plane.axes.col(2))) < 0.01 &&
                             (!other.wide || std::abs(other.axes.col(2).dot(plane.axes.col(2))) > 0.9998);
      if (!samePlane) continue;
      done[p] = true;
      const Eigen::Matrix2Xd uv =
          plane.axes.leftCols<2>().transpose() * (polygon.points_lps_mm.colwise() - plane.centre_lps_mm);
      for (Eigen::Index v = 0; v < uv.cols(); ++v) {
        Edge edge{uv.col(v), uv.col((v + 1) % uv.cols()), flat.exclude.size()};
        if (edge.low.y() == edge.high.y()) continue;
        if (edge.low.y() > edge.high.y()) std::swap(edge.low, edge.high);
        flat.edges.push_back(edge);
      }
      flat.exclude.push_back(polygon.exclude);
    }
    total += flatArea(flat);
  }
  return total;
}

}  // namespace glisson::roi
