// SPDX-License-Identifier: GPL-3.0-or-later
#include "roi/set_operations.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "roi/arrangement.h"
#include "roi/detail/planar_edges.h"

namespace glisson::roi {
namespace {

using detail::Node;
using detail::PlanarEdges;
using detail::Wide;

constexpr double sliver_mm = 1e-8;      ///< mean width of a ring that is no more than rounding
constexpr double straight_units = 2.0;  ///< a crossing this near to the line of its neighbours is none
constexpr double sameArea = 1e-6;       ///< relative: outlines that mean what they should

/// Directed edges with what belongs on their left, by the node they start from.
struct Walk {
  std::vector<std::size_t> to;
  std::vector<std::vector<std::size_t>> leaving;  ///< of each node: edges not yet walked
};

/// The edge that leaves v first, clockwise from the way back to u: so that what belongs stays a narrow wedge between
/// the two, and parts that meet in v only are walked one after the other.
std::size_t takeNext(const PlanarEdges& planar, Walk& walk, std::size_t u, std::size_t v) {
  struct Way {
    Wide x, y;
  };
  const auto way = [&](std::size_t n) {
    return Way{planar.nodes[n].x - planar.nodes[v].x, planar.nodes[n].y - planar.nodes[v].y};
  };
  const Way back = way(u);
  const auto half = [&](const Way& d) {
    const Wide side = back.x * d.y - back.y * d.x;
    return side < 0 ? 0 : side == 0 ? 1 : 2;
  };
  std::vector<std::size_t>& leaving = walk.leaving[v];
  auto best = leaving.begin();
  for (auto at = leaving.begin() + 1; at < leaving.end(); ++at) {
    const Way d = way(walk.to[*at]), least = way(walk.to[*best]);
    const int h = half(d), least_h = half(least);
    if (h < least_h || (h == least_h && d.x * least.y - d.y * least.x < 0)) best = at;
  }
  const std::size_t taken = *best;
  leaving.erase(best);
  return taken;
}

/// Closed walks that pass no node twice.
std::vector<std::vector<std::size_t>> loopsOf(const PlanarEdges& planar, Walk& walk) {
  std::vector<std::vector<std::size_t>> loops;
  for (std::size_t start = 0; start < walk.leaving.size(); ++start) {
    while (!walk.leaving[start].empty()) {
      std::vector<std::size_t> path{start};
      std::map<std::size_t, std::size_t> place{{start, 0}};
      std::size_t edge = walk.leaving[start].back();
      walk.leaving[start].pop_back();
      while (true) {
        const std::size_t v = walk.to[edge], u = path.back();
        if (const auto seen = place.find(v); seen != place.end()) {
          const auto first = path.begin() + static_cast<std::ptrdiff_t>(seen->second);
          loops.emplace_back(first, path.end());
          for (auto at = first; at != path.end(); ++at) place.erase(*at);
          path.erase(first, path.end());
          if (path.empty()) break;
        }
        place.emplace(v, path.size());
        path.push_back(v);
        edge = takeNext(planar, walk, u, v);
      }
    }
  }
  return loops;
}

/// Without crossings that turned out to lie on a straight line.
Eigen::Matrix2Xd ringOf(const PlanarEdges& planar, std::vector<std::size_t> loop) {
  for (std::size_t v = 0; v < loop.size() && loop.size() > 3;) {
    const std::size_t before = loop[(v + loop.size() - 1) % loop.size()], after = loop[(v + 1) % loop.size()];
    const Node &a = planar.nodes[before], &b = planar.nodes[after];
    const double length = std::hypot(static_cast<double>(b.x - a.x), static_cast<double>(b.y - a.y));
    const double off = std::abs(static_cast<double>(turnOf(a, b, planar.nodes[loop[v]])));
    if (!planar.given_mm[loop[v]] && off <= straight_units * length)
      loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(v));
    else
      ++v;
  }
  Eigen::Matrix2Xd ring(2, static_cast<Eigen::Index>(loop.size()));
  for (std::size_t v = 0; v < loop.size(); ++v) ring.col(static_cast<Eigen::Index>(v)) = planar.at_mm(loop[v]);
  return ring;
}

double signedArea(const Eigen::Matrix2Xd& ring) {
  double twice = 0.0;
  for (Eigen::Index v = 1; v + 1 < ring.cols(); ++v) {
    const Eigen::Vector2d a = ring.col(v) - ring.col(0), b = ring.col(v + 1) - ring.col(0);
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

bool isSliver(const Eigen::Matrix2Xd& ring) {
  double perimeter = 0.0;
  for (Eigen::Index v = 0; v < ring.cols(); ++v) perimeter += (ring.col((v + 1) % ring.cols()) - ring.col(v)).norm();
  return std::abs(signedArea(ring)) <= 0.5 * sliver_mm * perimeter;
}

/// Membership of the part of all rings that belongs to one region.
class Part {
 public:
  explicit Part(const FlatRegion& region) : arrangement_(arrange(region.rings_mm, region.flips)) {}
  bool holds(const std::vector<bool>& in, std::size_t first) const {
    const auto begin = in.begin() + static_cast<std::ptrdiff_t>(first);
    return roi::holds(arrangement_,
                      std::vector<bool>(begin, begin + static_cast<std::ptrdiff_t>(arrangement_.level.size())));
  }

 private:
  Arrangement arrangement_;
};

}  // namespace

double signedArea_mm2(const std::vector<Eigen::Matrix2Xd>& rings) {
  double sum = 0.0;
  for (const Eigen::Matrix2Xd& ring : rings) sum += signedArea(ring);
  return sum;
}

std::vector<Eigen::Matrix2Xd> boundaryOf(const std::vector<Eigen::Matrix2Xd>& rings, const Membership& belongs) {
  const PlanarEdges planar = detail::planarEdgesOf(rings);
  const std::vector<std::vector<bool>> right = detail::rightSides(planar, rings.size());
  Walk walk;
  walk.leaving.resize(planar.nodes.size());
  for (std::size_t e = 0; e < planar.edges.size(); ++e) {
    std::vector<bool> left = right[e];
    for (const std::size_t r : planar.edges[e].rings) left[r] = !left[r];
    const bool onLeft = belongs(left);
    if (onLeft == belongs(right[e])) continue;
    const auto [from, to] = onLeft ? std::pair(planar.edges[e].from, planar.edges[e].to)
                                   : std::pair(planar.edges[e].to, planar.edges[e].from);
    walk.leaving[from].push_back(walk.to.size());
    walk.to.push_back(to);
  }
  std::vector<Eigen::Matrix2Xd> result;
  for (std::vector<std::size_t>& loop : loopsOf(planar, walk)) {
    if (loop.size() < 3) continue;
    Eigen::Matrix2Xd ring = ringOf(planar, std::move(loop));
    if (!isSliver(ring)) result.push_back(std::move(ring));
  }
  return result;
}

FlatRegion combined(const FlatRegion& first, const FlatRegion& second, SetOperation operation) {
  std::vector<Eigen::Matrix2Xd> all = first.rings_mm;
  all.insert(all.end(), second.rings_mm.begin(), second.rings_mm.end());
  const Part a(first), b(second);
  FlatRegion result;
  result.rings_mm = boundaryOf(all, [&](const std::vector<bool>& in) {
    const bool inA = a.holds(in, 0), inB = b.holds(in, first.rings_mm.size());
    switch (operation) {
      case SetOperation::Union: return inA || inB;
      case SetOperation::Difference: return inA && !inB;
      case SetOperation::Intersection: return inA && inB;
    }
    return false;
  });
  result.flips.assign(result.rings_mm.size(), false);
  // As outlines of a slice they have to mean the same: a thin ring and its hole would be taken for repeats.
  const Part meant(result);
  const double area = signedArea_mm2(result.rings_mm);
  const double taken =
      signedArea_mm2(boundaryOf(result.rings_mm, [&](const std::vector<bool>& in) { return meant.holds(in, 0); }));
  if (std::abs(taken - area) > sameArea * std::abs(area)) result.flips.assign(result.rings_mm.size(), true);
  return result;
}

bool meet(const Eigen::Matrix2Xd& a, const Eigen::Matrix2Xd& b) {
  if ((a.rowwise().maxCoeff().array() < b.rowwise().minCoeff().array()).any() ||
      (b.rowwise().maxCoeff().array() < a.rowwise().minCoeff().array()).any())
    return false;
  // A part of the border that both run over has neither on one of its sides, or both.
  bool shared = false;
  const PlanarEdges planar = detail::planarEdgesOf({a, b});
  for (const auto& edge : planar.edges) shared = shared || edge.rings.size() == 2;
  return shared || !boundaryOf({a, b}, [](const std::vector<bool>& in) { return in[0] && in[1]; }).empty();
}

}  // namespace glisson::roi
