// SPDX-License-Identifier: GPL-3.0-or-later
#include "roi/detail/planar_edges.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <unordered_map>

#include "base/error.h"

namespace glisson::roi::detail {
namespace {

constexpr double finest_mm = 1.0 / (1 << 30);
constexpr double reach_units = 1099511627776.0;  // 2^40: products of two differences and a third one fit in 128 bits
constexpr double farthest_mm = 1e6;
constexpr int mostPasses = 100;

struct NodeHash {
  std::size_t operator()(const Node& n) const {
    return static_cast<std::size_t>(static_cast<std::uint64_t>(n.x) * 0x9E3779B97F4A7C15ULL ^
                                    static_cast<std::uint64_t>(n.y) * 0xC2B2AE3D27D4EB4FULL);
  }
};

using Ends = std::pair<std::size_t, std::size_t>;

/// Edges by their ends, with the rings that run over them an odd number of times.
class Cutter {
 public:
  explicit Cutter(PlanarEdges& planar) : planar_(planar) {}

  std::size_t node(const Node& n) {
    const auto [found, fresh] = index_.try_emplace(n, planar_.nodes.size());
    if (fresh) {
      planar_.nodes.push_back(n);
      planar_.given_mm.emplace_back();
    }
    return found->second;
  }

  void add(std::size_t a, std::size_t b, std::size_t ring) {
    if (a == b) return;
    std::vector<std::size_t>& rings = edges_[before(b, a) ? Ends{b, a} : Ends{a, b}];
    const auto at = std::lower_bound(rings.begin(), rings.end(), ring);
    if (at != rings.end() && *at == ring)
      rings.erase(at);
    else
      rings.insert(at, ring);
  }

  /// Cuts every edge where it meets another one; crossings move to the lattice. False where nothing was left to cut.
  bool cutOnce() {
    std::erase_if(edges_, [](const auto& e) { return e.second.empty(); });
    std::vector<Ends> order;
    for (const auto& [ends, rings] : edges_) order.push_back(ends);
    std::sort(order.begin(), order.end(), [this](const Ends& a, const Ends& b) {
      return planar_.nodes[a.first].x < planar_.nodes[b.first].x ||
             (planar_.nodes[a.first].x == planar_.nodes[b.first].x && a < b);
    });
    std::map<Ends, std::vector<std::size_t>> cuts;
    std::vector<Ends> active;
    for (const Ends& e : order) {
      std::erase_if(active, [&](const Ends& a) { return planar_.nodes[a.second].x < planar_.nodes[e.first].x; });
      for (const Ends& a : active) findCuts(a, e, cuts);
      active.push_back(e);
    }
    for (auto& [ends, at] : cuts) cut(ends, at);
    return !cuts.empty();
  }

  void finish() {
    for (auto& [ends, rings] : edges_)
      if (!rings.empty()) planar_.edges.push_back({ends.first, ends.second, rings});
  }

 private:
  bool before(std::size_t a, std::size_t b) const {
    const Node &p = planar_.nodes[a], &q = planar_.nodes[b];
    return p.x < q.x || (p.x == q.x && p.y < q.y);
  }

  bool within(std::size_t n, const Ends& e) const {
    const Node &p = planar_.nodes[n], &a = planar_.nodes[e.first], &b = planar_.nodes[e.second];
    return n != e.first && n != e.second && p.x >= a.x && p.x <= b.x && p.y >= std::min(a.y, b.y) &&
           p.y <= std::max(a.y, b.y) && turnOf(a, b, p) == 0;
  }

  void findCuts(const Ends& e, const Ends& f, std::map<Ends, std::vector<std::size_t>>& cuts) {
    const Node a = planar_.nodes[e.first], b = planar_.nodes[e.second];
    const Node c = planar_.nodes[f.first], d = planar_.nodes[f.second];
    if (std::max(a.y, b.y) < std::min(c.y, d.y) || std::max(c.y, d.y) < std::min(a.y, b.y)) return;
    for (const std::size_t n : {f.first, f.second})
      if (within(n, e)) cuts[e].push_back(n);
    for (const std::size_t n : {e.first, e.second})
      if (within(n, f)) cuts[f].push_back(n);
    const Wide abc = turnOf(a, b, c), abd = turnOf(a, b, d), cda = turnOf(c, d, a), cdb = turnOf(c, d, b);
    const auto sides = [](Wide p, Wide q) { return (p > 0 && q < 0) || (p < 0 && q > 0); };
    if (!sides(abc, abd) || !sides(cda, cdb)) return;
    // Where on a-b: cda / (cda - cdb) of the way, rounded to the lattice.
    const Wide whole = cda - cdb;
    const auto along = [&](std::int64_t from, std::int64_t to) {
      const Wide product = cda * (to - from), size = whole < 0 ? -whole : whole;
      const Wide signedProduct = whole < 0 ? -product : product;
      const Wide rounded =
          signedProduct >= 0 ? (signedProduct + size / 2) / size : -((-signedProduct + size / 2) / size);
      return from + static_cast<std::int64_t>(rounded);
    };
    const std::size_t p = node({along(a.x, b.x), along(a.y, b.y)});
    if (p != e.first && p != e.second) cuts[e].push_back(p);
    if (p != f.first && p != f.second) cuts[f].push_back(p);
  }

  void cut(const Ends& ends, std::vector<std::size_t>& at) {
    const std::vector<std::size_t> rings = edges_[ends];
    edges_.erase(ends);
    const Node a = planar_.nodes[ends.first], b = planar_.nodes[ends.second];
    const auto along = [&](std::size_t n) {
      const Node& p = planar_.nodes[n];
      return static_cast<Wide>(p.x - a.x) * (b.x - a.x) + static_cast<Wide>(p.y - a.y) * (b.y - a.y);
    };
    std::sort(at.begin(), at.end(), [&](std::size_t p, std::size_t q) {
      const Wide pa = along(p), qa = along(q);
      return pa < qa || (pa == qa && p < q);
    });
    at.erase(std::unique(at.begin(), at.end()), at.end());
    std::size_t last = ends.first;
    at.push_back(ends.second);
    for (const std::size_t next : at) {
      for (const std::size_t r : rings) add(last, next, r);
      last = next;
    }
  }

  PlanarEdges& planar_;
  std::unordered_map<Node, std::size_t, NodeHash> index_;
  std::map<Ends, std::vector<std::size_t>> edges_;
};

double unitFor(const std::vector<Eigen::Matrix2Xd>& rings) {
  double reach = 0.0;
  for (const Eigen::Matrix2Xd& ring : rings) {
    if (ring.cols() == 0) continue;
    if (!ring.allFinite() || ring.cwiseAbs().maxCoeff() > farthest_mm)
      throw BadInput("an outline has a coordinate that is not finite or beyond 1000 m: draw or import it anew");
    reach = std::max(reach, ring.cwiseAbs().maxCoeff());
  }
  double unit = finest_mm;
  while (reach / unit >= reach_units) unit *= 2.0;
  return unit;
}

}  // namespace

Eigen::Vector2d PlanarEdges::at_mm(std::size_t node) const {
  if (given_mm[node]) return *given_mm[node];
  return unit_mm * Eigen::Vector2d(static_cast<double>(nodes[node].x), static_cast<double>(nodes[node].y));
}

PlanarEdges planarEdgesOf(const std::vector<Eigen::Matrix2Xd>& rings) {
  PlanarEdges planar;
  planar.unit_mm = unitFor(rings);
  Cutter cutter(planar);
  for (std::size_t r = 0; r < rings.size(); ++r) {
    std::vector<std::size_t> ids;
    for (const auto p : rings[r].colwise()) {
      const std::size_t id = cutter.node({std::llround(p.x() / planar.unit_mm), std::llround(p.y() / planar.unit_mm)});
      if (!planar.given_mm[id]) planar.given_mm[id] = p;
      ids.push_back(id);
    }
    for (std::size_t v = 0; v < ids.size(); ++v) cutter.add(ids[v], ids[(v + 1) % ids.size()], r);
  }
  // A crossing that was moved to the lattice may move its edges over another node: as often as it takes.
  int passes = 0;
  while (cutter.cutOnce())
    if (++passes == mostPasses)
      throw BadInput("the outlines cross each other in too many places to be combined: simplify them first");
  cutter.finish();
  return planar;
}

std::vector<std::vector<bool>> rightSides(const PlanarEdges& planar, std::size_t rings) {
  struct Query {
    std::int64_t x2, y2;  ///< twice the middle of the edge
    std::size_t edge;
  };
  const auto& nodes = planar.nodes;
  std::vector<Query> queries;
  for (std::size_t e = 0; e < planar.edges.size(); ++e) {
    const Node &a = nodes[planar.edges[e].from], &b = nodes[planar.edges[e].to];
    queries.push_back({a.x + b.x, a.y + b.y, e});
  }
  std::sort(queries.begin(), queries.end(), [](const Query& p, const Query& q) { return p.x2 < q.x2; });
  std::vector<std::size_t> order(planar.edges.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t p, std::size_t q) {
    return nodes[planar.edges[p].from].x < nodes[planar.edges[q].from].x;
  });
  std::vector<std::vector<bool>> result(planar.edges.size(), std::vector<bool>(rings, false));
  std::vector<std::size_t> active;
  std::size_t next = 0;
  for (const Query& query : queries) {
    while (next < order.size() && 2 * nodes[planar.edges[order[next]].from].x <= query.x2)
      active.push_back(order[next++]);
    std::erase_if(active, [&](std::size_t e) { return 2 * nodes[planar.edges[e].to].x < query.x2; });
    const PlanarEdge& asked = planar.edges[query.edge];
    const bool upright = nodes[asked.from].x == nodes[asked.to].x;
    std::vector<bool>& in = result[query.edge];
    for (const std::size_t e : active) {
      const Node a = nodes[planar.edges[e].from], b = nodes[planar.edges[e].to];
      // Straight down from the middle; of upright edges from a hair to its left.
      const bool spans =
          upright ? 2 * a.x < query.x2 && query.x2 <= 2 * b.x : 2 * a.x <= query.x2 && query.x2 < 2 * b.x;
      if (e == query.edge || !spans) continue;
      if (turnOf({2 * a.x, 2 * a.y}, {2 * b.x, 2 * b.y}, {query.x2, query.y2}) <= 0) continue;
      for (const std::size_t r : planar.edges[e].rings) in[r] = !in[r];
    }
    if (upright)
      for (const std::size_t r : asked.rings) in[r] = !in[r];
  }
  return result;
}

}  // namespace glisson::roi::detail
