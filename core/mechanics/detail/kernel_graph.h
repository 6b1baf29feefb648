// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "mechanics/problem.h"

namespace glisson::mechanics {

/// The nodes of a voxel mesh as a graph: two nodes are joined where a filled cell holds both (at most 26 each). Paths
/// stay inside the body, so that two lobes that nearly touch are far from each other.
class NodeGraph {
 public:
  explicit NodeGraph(const VoxelMesh& mesh);

  /// Calls visit(neighbour, edge length in m) in a fixed order.
  template <class Visit>
  void forNeighbours(int node, Visit&& visit) const {
    const Eigen::Vector3i p = mesh_->latticeOf(node);
    for (const Offset& o : offsets_)
      if (around_[static_cast<std::size_t>(node)] & o.cells)
        visit(mesh_->nodeAt(p.x() + o.d[0], p.y() + o.d[1], p.z() + o.d[2]), o.length_m);
  }

  /// Shortest distances, m, from sources {node, first distance} through nodes that `inside` allows (Dijkstra; longer
  /// than the straight line by at most 10 % on cubes). distance: nodeCount values, infinity where nothing was known;
  /// lowered in place. label: if not null, nodeCount values, follows the nearest source (label of a source is set by
  /// the caller).
  void shortest(const std::vector<std::pair<int, double>>& sources, const std::function<bool(int)>& inside,
                std::vector<double>& distance_m, std::vector<int>* label = nullptr) const;

 private:
  struct Offset {
    std::array<int, 3> d;
    std::uint8_t cells;  ///< which of the eight cells around a node hold this neighbour too
    double length_m;
  };
  const VoxelMesh* mesh_;
  std::vector<std::uint8_t> around_;
  std::vector<Offset> offsets_;
};

}  // namespace glisson::mechanics
