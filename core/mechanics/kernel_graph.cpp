// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/detail/kernel_graph.h"

#include <queue>

namespace glisson::mechanics {

NodeGraph::NodeGraph(const VoxelMesh& mesh) : mesh_(&mesh), around_(static_cast<std::size_t>(mesh.nodeCount()), 0) {
  // Bit b of a node: the filled cell whose corner 7 − b it is, that is the cell towards side b (bit a set = upper
  // side).
  for (int c = 0; c < mesh.cellCount(); ++c) {
    const std::array<int, 8> nodes = mesh.nodesOf(c);
    for (int a = 0; a < 8; ++a)
      around_[static_cast<std::size_t>(nodes[static_cast<std::size_t>(a)])] |= static_cast<std::uint8_t>(1 << (7 - a));
  }
  for (int k = -1; k <= 1; ++k)
    for (int j = -1; j <= 1; ++j)
      for (int i = -1; i <= 1; ++i) {
        if (i == 0 && j == 0 && k == 0) continue;
        const std::array<int, 3> d = {i, j, k};
        int cells = 0;
        for (int b = 0; b < 8; ++b) {
          bool holds = true;
          for (int a = 0; a < 3; ++a) {
            const int side = (b >> a & 1) ? 1 : -1;
            if (d[static_cast<std::size_t>(a)] != 0 && d[static_cast<std::size_t>(a)] != side) holds = false;
          }
          if (holds) cells |= 1 << b;
        }
        offsets_.push_back(
            {d, static_cast<std::uint8_t>(cells), Eigen::Vector3d(i, j, k).cwiseProduct(mesh.h_m()).norm()});
      }
}

void NodeGraph::shortest(const std::vector<std::pair<int, double>>& sources, const std::function<bool(int)>& inside,
                         std::vector<double>& distance_m, std::vector<int>* label) const {
  using Item = std::pair<double, int>;
  std::priority_queue<Item, std::vector<Item>, std::greater<>> queue;
  for (const auto& [node, first] : sources) {
    if (first > distance_m[static_cast<std::size_t>(node)]) continue;
    distance_m[static_cast<std::size_t>(node)] = first;
    queue.emplace(first, node);
  }
  while (!queue.empty()) {
    const double d = queue.top().first;
    const int node = queue.top().second;
    queue.pop();
    if (d > distance_m[static_cast<std::size_t>(node)]) continue;
    forNeighbours(node, [&](int next, double length) {
      const double candidate = d + length;
      if (candidate >= distance_m[static_cast<std::size_t>(next)] || !inside(next)) return;
      distance_m[static_cast<std::size_t>(next)] = candidate;
      if (label) (*label)[static_cast<std::size_t>(next)] = (*label)[static_cast<std::size_t>(node)];
      queue.emplace(candidate, next);
    });
  }
}

}  // namespace glisson::mechanics
