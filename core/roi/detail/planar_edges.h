// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

// Closed rings cut at all their crossings, on a lattice of integers, so that every question about sides has an exact
// answer.
namespace glisson::roi::detail {

__extension__ using Wide = __int128;

struct Node {
  std::int64_t x = 0, y = 0;
  bool operator==(const Node&) const = default;
};

/// Twice the signed area of the triangle a, b, c: positive where c lies to the left of a-b.
inline Wide turnOf(const Node& a, const Node& b, const Node& c) {
  return static_cast<Wide>(b.x - a.x) * (c.y - a.y) - static_cast<Wide>(b.y - a.y) * (c.x - a.x);
}

/// From the node that comes first (by x, then y) to the other. rings: those that run over it an odd number of times.
struct PlanarEdge {
  std::size_t from = 0, to = 0;
  std::vector<std::size_t> rings;
};

/// A set of edges that meet at their ends only, each once.
struct PlanarEdges {
  std::vector<Node> nodes;
  std::vector<std::optional<Eigen::Vector2d>> given_mm;  ///< of nodes that are vertices of the input: where it was
  std::vector<PlanarEdge> edges;
  double unit_mm = 0.0;  ///< of the lattice

  Eigen::Vector2d at_mm(std::size_t node) const;
};

/// Throws BadInput where a coordinate is not finite or beyond 1e6 mm.
PlanarEdges planarEdgesOf(const std::vector<Eigen::Matrix2Xd>& rings_mm);

/// For every edge the rings that its right side lies in (below; of upright edges: to the right).
std::vector<std::vector<bool>> rightSides(const PlanarEdges& planar, std::size_t rings);

}  // namespace glisson::roi::detail
