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

std::vector<FrameBasis::Column> FrameBasis::voronoi(const VoxelMesh& mesh, const Progress& progress) {
  const NodeGraph graph(mesh);
  const auto nodeCount = static_cast<std::size_t>(mesh.nodeCount());
  const std::vector<int> owned = firstOwned(sites_);
  std::vector<double> distance(nodeCount, infinity);
  std::vector<int> owner(nodeCount, -1);
  std::vector<std::vector<std::pair<int, double>>> start(static_cast<std::size_t>(frames()));
  std::vector<std::pair<int, double>> sources;
  for (int f = 0; f < frames(); ++f) {
    start[static_cast<std::size_t>(f)] = startNodes(mesh, sites_.position_m.col(f), owned[static_cast<std::size_t>(f)]);
    for (const auto& [node, d] : start[static_cast<std::size_t>(f)]) {
      if (d >= distance[static_cast<std::size_t>(node)]) continue;
      distance[static_cast<std::size_t>(node)] = d;
      owner[static_cast<std::size_t>(node)] = f;
    }
  }
  for (std::size_t n = 0; n < nodeCount; ++n)
    if (owner[n] >= 0) sources.emplace_back(static_cast<int>(n), distance[n]);
  graph.shortest(
      sources, [](int) { return true; }, distance, &owner);
  int lost = 0;
  for (std::size_t n = 0; n < nodeCount; ++n)
    if (owner[n] < 0) {
      owner[n] = sites_.ownerOfNode[n], ++lost;
      distance[n] = (mesh.position_m(static_cast<int>(n)) - sites_.position_m.col(owner[n])).norm();
    }
  if (lost > 0)
    notes_.push_back(std::to_string(lost) +
                     " voxel nodes in islands without a mesh-free site follow the nearest frame");

  std::vector<std::set<int>> neighbours(static_cast<std::size_t>(frames()));
  std::vector<std::vector<int>> members(static_cast<std::size_t>(frames()));
  for (std::size_t n = 0; n < nodeCount; ++n) {
    members[static_cast<std::size_t>(owner[n])].push_back(static_cast<int>(n));
    graph.forNeighbours(static_cast<int>(n), [&](int next, double) {
      const int other = owner[static_cast<std::size_t>(next)];
      if (other != owner[n]) neighbours[static_cast<std::size_t>(owner[n])].insert(other);
    });
  }

  const double edge = mesh.h_m().maxCoeff();
  std::vector<Column> columns(static_cast<std::size_t>(frames()));
  parallelChunks(columns.size(), 1, [&](std::size_t begin, std::size_t) {
    progress.check();
    const int f = static_cast<int>(begin);
    const std::set<int>& near = neighbours[begin];
    const auto inside = [&](int node) {
      const int o = owner[static_cast<std::size_t>(node)];
      return o == f || near.count(o) > 0;
    };
    std::vector<int> domain = members[begin];
    for (const int g : near)
      domain.insert(domain.end(), members[static_cast<std::size_t>(g)].begin(),
                    members[static_cast<std::size_t>(g)].end());
    std::sort(domain.begin(), domain.end());
    // Distances to the border of the cell, and to where the kernel is zero: the neighbouring sites and all other cells.
    std::vector<double> border(nodeCount, infinity), zero(nodeCount, infinity);
    std::vector<std::pair<int, double>> borderSources, zeroSources;
    for (const int n : domain)
      graph.forNeighbours(n, [&](int next, double length) {
        const auto a = static_cast<std::size_t>(n), b = static_cast<std::size_t>(next);
        if ((owner[a] == f) != (owner[b] == f)) {
          // The point of the edge that is as far from one site as from the other.
          const double t = 0.5 * (distance[b] + length - distance[a]);
          borderSources.emplace_back(n, std::clamp(t, 0.0, length));
        }
        if (!inside(next)) zeroSources.emplace_back(n, 0.5 * length);
      });
    graph.shortest(borderSources, inside, border);
    // The kernel ends, in each neighbouring cell, on the surface that is as far from the border as the neighbour's
    // site.
    std::map<int, double> reach;
    for (const int g : near)
      for (const auto& [node, d] : start[static_cast<std::size_t>(g)]) {
        const double through = border[static_cast<std::size_t>(node)] + d;
        const auto [it, fresh] = reach.emplace(g, through);
        if (!fresh) it->second = std::min(it->second, through);
      }
    for (const int n : domain) {
      const auto at = static_cast<std::size_t>(n);
      if (owner[at] == f || !std::isfinite(border[at])) continue;
      const double ahead = reach[owner[at]] - border[at];
      if (ahead <= edge) zeroSources.emplace_back(n, std::max(0.0, ahead));
    }
    graph.shortest(zeroSources, inside, zero);
    for (const int n : domain) {
      const auto at = static_cast<std::size_t>(n);
      double phi = 1.0;
      if (owner[at] == f) {
        if (std::isfinite(border[at]) && border[at] + distance[at] > 0.0)
          phi = 0.5 * (1.0 + border[at] / (border[at] + distance[at]));
      } else if (!std::isfinite(border[at])) {
        phi = 0.0;
      } else if (std::isfinite(zero[at])) {
        phi = border[at] + zero[at] > 0.0 ? 0.5 * zero[at] / (border[at] + zero[at]) : 0.0;
      } else {
        phi = 0.5;
      }
      if (phi > 0.0) columns[begin].emplace_back(n, phi);
    }
  });
  return columns;
}

}  // namespace glisson::mechanics
