// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/kernel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "base/error.h"
#include "base/parallel.h"
#include "mechanics/detail/kernel_graph.h"

namespace glisson::mechanics {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;
constexpr double infinity = std::numeric_limits<double>::infinity();

double wendlandC2(double r) {
  if (r >= 1.0) return 0.0;
  const double t = (1.0 - r) * (1.0 - r);
  return t * t * (4.0 * r + 1.0);
}

/// The corners of the filled cell that holds a site, with their distances to it; the nearest node where none does.
std::vector<std::pair<int, double>> startNodes(const VoxelMesh& mesh, const Vector3d& site_m, int anyOwned) {
  std::vector<std::pair<int, double>> start;
  Vector3i c;
  for (int a = 0; a < 3; ++a) c[a] = std::clamp(static_cast<int>(site_m[a] / mesh.h_m()[a]), 0, mesh.cells()[a] - 1);
  for (int b = 0; b < 8; ++b) {
    const int node = mesh.nodeAt(c.x() + (b & 1), c.y() + (b >> 1 & 1), c.z() + (b >> 2 & 1));
    if (node >= 0) start.emplace_back(node, (mesh.position_m(node) - site_m).norm());
  }
  if (start.empty() && anyOwned >= 0) start.emplace_back(anyOwned, (mesh.position_m(anyOwned) - site_m).norm());
  return start;
}

std::vector<int> firstOwned(const Sites& sites) {
  std::vector<int> first(static_cast<std::size_t>(sites.count()), -1);
  for (std::size_t n = 0; n < sites.ownerOfNode.size(); ++n) {
    int& f = first[static_cast<std::size_t>(sites.ownerOfNode[n])];
    if (f < 0) f = static_cast<int>(n);
  }
  return first;
}

}  // namespace

FrameBasis::FrameBasis(const VoxelMesh& mesh, Sites sites, const KernelOptions& options, const Progress& progress)
    : sites_(std::move(sites)), options_(options), notes_(sites_.notes) {
  if (options_.order != 1 && options_.order != 2)
    throw BadInput("mesh-free frames of order " + std::to_string(options_.order) +
                   "; choose 1 (affine, 12 degrees of freedom; linear basis of \"mls\") or 2 (quadratic, 30)");
  if (options_.alpha == 0.0)
    options_.alpha =
        options_.kernel == Kernel::Mls ? (options_.order == 1 ? 1.8 : 2.6) : (options_.order == 1 ? 2.2 : 1.8);
  if (!(options_.alpha >= 1.0 && options_.alpha <= 6.0))
    throw BadInput("mesh-free support radius alpha " + std::to_string(options_.alpha) + "; choose a value in [1, 6]");

  const std::vector<Column> columns = options_.kernel == Kernel::Wendland  ? wendland(mesh, progress)
                                      : options_.kernel == Kernel::Voronoi ? voronoi(mesh, progress)
                                                                           : mls(mesh, progress);
  std::vector<double> sum(static_cast<std::size_t>(mesh.nodeCount()), 0.0);
  Eigen::VectorXi perFrame(frames());
  for (int f = 0; f < frames(); ++f) {
    const Column& column = columns[static_cast<std::size_t>(f)];
    perFrame[f] = static_cast<int>(column.size());
    for (const auto& [node, phi] : column) sum[static_cast<std::size_t>(node)] += phi;
  }
  byFrame_.resize(mesh.nodeCount(), frames());
  byFrame_.reserve(perFrame);
  for (int f = 0; f < frames(); ++f)
    for (const auto& [node, phi] : columns[static_cast<std::size_t>(f)])
      byFrame_.insert(node, f) = phi / sum[static_cast<std::size_t>(node)];
  byFrame_.makeCompressed();
  byNode_ = byFrame_;
}

FrameBasis::Column FrameBasis::ball(const VoxelMesh& mesh, int frame, double radius_m) const {
  Column column;
  const Vector3d x = sites_.position_m.col(frame);
  Vector3i low, high;
  for (int a = 0; a < 3; ++a) {
    low[a] = std::max(0, static_cast<int>(std::ceil((x[a] - radius_m) / mesh.h_m()[a])));
    high[a] = std::min(mesh.cells()[a], static_cast<int>(std::floor((x[a] + radius_m) / mesh.h_m()[a])));
  }
  for (int k = low.z(); k <= high.z(); ++k)
    for (int j = low.y(); j <= high.y(); ++j)
      for (int i = low.x(); i <= high.x(); ++i) {
        const int node = mesh.nodeAt(i, j, k);
        if (node < 0) continue;
        const double phi = wendlandC2((mesh.position_m(node) - x).norm() / radius_m);
        if (phi > 0.0) column.emplace_back(node, phi);
      }
  return column;
}

Eigen::VectorXd FrameBasis::radii(const VoxelMesh& mesh) const {
  // Every node lies well inside the ball of the frame that owns it, also in elongated Voronoi cells.
  Eigen::VectorXd radius = options_.alpha * sites_.spacing_m;
  for (int n = 0; n < mesh.nodeCount(); ++n) {
    const int f = sites_.ownerOfNode[static_cast<std::size_t>(n)];
    radius[f] = std::max(radius[f], 1.25 * (mesh.position_m(n) - sites_.position_m.col(f)).norm());
  }
  return radius;
}

std::vector<FrameBasis::Column> FrameBasis::wendland(const VoxelMesh& mesh, const Progress& progress) {
  return connectedBalls(mesh, radii(mesh), progress);
}

std::vector<FrameBasis::Column> FrameBasis::connectedBalls(const VoxelMesh& mesh, const Eigen::VectorXd& radius,
                                                           const Progress& progress) {
  const NodeGraph graph(mesh);
  const std::vector<int> owned = firstOwned(sites_);
  std::vector<Column> columns(static_cast<std::size_t>(frames()));
  parallelChunks(columns.size(), 1, [&](std::size_t begin, std::size_t) {
    progress.check();
    const int f = static_cast<int>(begin);
    const Column all = ball(mesh, f, radius[f]);
    const auto position = [&](int node) -> std::ptrdiff_t {
      const auto it = std::lower_bound(all.begin(), all.end(), std::pair{node, -1.0});
      return it != all.end() && it->first == node ? it - all.begin() : -1;
    };
    std::vector<char> reached(all.size(), 0);
    std::vector<int> stack;
    const auto reach = [&](int node) {
      const std::ptrdiff_t at = position(node);
      if (at < 0 || reached[static_cast<std::size_t>(at)]) return;
      reached[static_cast<std::size_t>(at)] = 1;
      stack.push_back(node);
    };
    for (const auto& [node, distance] : startNodes(mesh, sites_.position_m.col(f), owned[static_cast<std::size_t>(f)]))
      reach(node);
    while (!stack.empty()) {
      const int node = stack.back();
      stack.pop_back();
      graph.forNeighbours(node, [&](int next, double) { reach(next); });
    }
    Column& column = columns[begin];
    for (std::size_t m = 0; m < all.size(); ++m)
      if (reached[m]) column.push_back(all[m]);
  });

  // A piece of the body that no site reaches through material joins the frame that owns it.
  std::vector<char> covered(static_cast<std::size_t>(mesh.nodeCount()), 0);
  for (const Column& column : columns)
    for (const auto& [node, phi] : column) covered[static_cast<std::size_t>(node)] = 1;
  std::set<int> open;
  int lost = 0;
  for (std::size_t n = 0; n < covered.size(); ++n)
    if (!covered[n]) open.insert(sites_.ownerOfNode[n]), ++lost;
  for (const int f : open) columns[static_cast<std::size_t>(f)] = ball(mesh, f, radius[f]);
  if (lost > 0)
    notes_.push_back(std::to_string(lost) + " voxel nodes lie in folds that hold no mesh-free site of their own; " +
                     std::to_string(open.size()) + " frames act across the gap there. Use more frames");
  return columns;
}

namespace {

using Distances = std::vector<std::pair<int, double>>;  ///< {node, m}

/// The Voronoi cells of the sites by paths through the body.
struct Cells {
  std::vector<Distances> start;           ///< nodes next to each site
  std::vector<double> distance_m;         ///< of each node to its site
  std::vector<int> owner;                 ///< site of each node
  std::vector<std::set<int>> neighbours;  ///< cells that touch
  std::vector<std::vector<int>> members;  ///< nodes of each cell, ascending
  int lost = 0;                           ///< nodes that no path joins to a site: they follow the nearest frame
};

Cells cellsOf(const VoxelMesh& mesh, const NodeGraph& graph, const Sites& sites) {
  const auto nodeCount = static_cast<std::size_t>(mesh.nodeCount());
  const auto count = static_cast<std::size_t>(sites.count());
  const std::vector<int> owned = firstOwned(sites);
  Cells cells{std::vector<Distances>(count),        std::vector<double>(nodeCount, infinity),
              std::vector<int>(nodeCount, -1),      std::vector<std::set<int>>(count),
              std::vector<std::vector<int>>(count), 0};
  for (int f = 0; f < sites.count(); ++f) {
    const auto at = static_cast<std::size_t>(f);
    cells.start[at] = startNodes(mesh, sites.position_m.col(f), owned[at]);
    for (const auto& [node, d] : cells.start[at]) {
      if (d >= cells.distance_m[static_cast<std::size_t>(node)]) continue;
      cells.distance_m[static_cast<std::size_t>(node)] = d;
      cells.owner[static_cast<std::size_t>(node)] = f;
    }
  }
  Distances sources;
  for (std::size_t n = 0; n < nodeCount; ++n)
    if (cells.owner[n] >= 0) sources.emplace_back(static_cast<int>(n), cells.distance_m[n]);
  graph.shortest(
      sources, [](int) { return true; }, cells.distance_m, &cells.owner);
  for (std::size_t n = 0; n < nodeCount; ++n)
    if (cells.owner[n] < 0) {
      cells.owner[n] = sites.ownerOfNode[n], ++cells.lost;
      cells.distance_m[n] = (mesh.position_m(static_cast<int>(n)) - sites.position_m.col(cells.owner[n])).norm();
    }
  for (std::size_t n = 0; n < nodeCount; ++n) {
    const auto own = static_cast<std::size_t>(cells.owner[n]);
    cells.members[own].push_back(static_cast<int>(n));
    graph.forNeighbours(static_cast<int>(n), [&](int next, double) {
      const int other = cells.owner[static_cast<std::size_t>(next)];
      if (other != cells.owner[n]) cells.neighbours[own].insert(other);
    });
  }
  return cells;
}

/// The Voronoi kernel of one site: 1 at the site, 1/2 on the border of its cell, 0 at the neighbours' sites.
class VoronoiKernel {
 public:
  VoronoiKernel(const NodeGraph& graph, const Cells& cells, int site)
      : graph_(graph), cells_(cells), site_(site), near_(cells.neighbours[static_cast<std::size_t>(site)]) {
    domain_ = cells.members[static_cast<std::size_t>(site)];
    for (const int g : near_)
      domain_.insert(domain_.end(), cells.members[static_cast<std::size_t>(g)].begin(),
                     cells.members[static_cast<std::size_t>(g)].end());
    std::sort(domain_.begin(), domain_.end());
  }

  /// edge_m: longest edge of a cell of the mesh.
  std::vector<std::pair<int, double>> values(double edge_m) {
    measure(edge_m);
    std::vector<std::pair<int, double>> column;
    for (const int n : domain_)
      if (const double phi = valueAt(static_cast<std::size_t>(n)); phi > 0.0) column.emplace_back(n, phi);
    return column;
  }

 private:
  bool inside(int node) const {
    const int o = cells_.owner[static_cast<std::size_t>(node)];
    return o == site_ || near_.count(o) > 0;
  }
  /// Distances to the border of the cell, and to where the kernel is zero: the neighbouring sites and all other cells.
  void measure(double edge_m) {
    const auto within = [this](int node) { return inside(node); };
    const std::vector<int>& owner = cells_.owner;
    border_.assign(owner.size(), infinity);
    zero_.assign(owner.size(), infinity);
    Distances borderSources, zeroSources;
    for (const int n : domain_)
      graph_.forNeighbours(n, [&](int next, double length) {
        const auto a = static_cast<std::size_t>(n), b = static_cast<std::size_t>(next);
        if ((owner[a] == site_) != (owner[b] == site_)) {
          // The point of the edge that is as far from one site as from the other.
          const double t = 0.5 * (cells_.distance_m[b] + length - cells_.distance_m[a]);
          borderSources.emplace_back(n, std::clamp(t, 0.0, length));
        }
        if (!inside(next)) zeroSources.emplace_back(n, 0.5 * length);
      });
    graph_.shortest(borderSources, within, border_);
    // The kernel ends, in each neighbouring cell, on the surface that is as far from the border as the neighbour's
    // site.
    std::map<int, double> reach;
    for (const int g : near_)
      for (const auto& [node, d] : cells_.start[static_cast<std::size_t>(g)]) {
        const double through = border_[static_cast<std::size_t>(node)] + d;
        const auto [it, fresh] = reach.emplace(g, through);
        if (!fresh) it->second = std::min(it->second, through);
      }
    for (const int n : domain_) {
      const auto at = static_cast<std::size_t>(n);
      if (owner[at] == site_ || !std::isfinite(border_[at])) continue;
      const double ahead = reach[owner[at]] - border_[at];
      if (ahead <= edge_m) zeroSources.emplace_back(n, std::max(0.0, ahead));
    }
    graph_.shortest(zeroSources, within, zero_);
  }
  double valueAt(std::size_t at) const {
    if (cells_.owner[at] == site_) {
      const double whole = border_[at] + cells_.distance_m[at];
      return std::isfinite(border_[at]) && whole > 0.0 ? 0.5 * (1.0 + border_[at] / whole) : 1.0;
    }
    if (!std::isfinite(border_[at])) return 0.0;
    if (!std::isfinite(zero_[at])) return 0.5;
    const double whole = border_[at] + zero_[at];
    return whole > 0.0 ? 0.5 * zero_[at] / whole : 0.0;
  }

  const NodeGraph& graph_;
  const Cells& cells_;
  int site_;
  const std::set<int>& near_;
  std::vector<int> domain_;            ///< nodes of the cell and its neighbours, ascending
  std::vector<double> border_, zero_;  ///< m
};

}  // namespace

std::vector<FrameBasis::Column> FrameBasis::voronoi(const VoxelMesh& mesh, const Progress& progress) {
  const NodeGraph graph(mesh);
  const Cells cells = cellsOf(mesh, graph, sites_);
  if (cells.lost > 0)
    notes_.push_back(std::to_string(cells.lost) +
                     " voxel nodes in islands without a mesh-free site follow the nearest frame");
  std::vector<Column> columns(static_cast<std::size_t>(frames()));
  parallelChunks(columns.size(), 1, [&](std::size_t begin, std::size_t) {
    progress.check();
    columns[begin] = VoronoiKernel(graph, cells, static_cast<int>(begin)).values(mesh.h_m().maxCoeff());
  });
  return columns;
}

}  // namespace glisson::mechanics
