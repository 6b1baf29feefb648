// SPDX-License-Identifier: GPL-3.0-or-later
#include "anatomy/vessel_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "anatomy/detail/isosurface.h"
#include "base/disjoint_sets.h"

namespace glisson::anatomy {
namespace {

constexpr double leastEndPerRadius = 1.5;
constexpr std::size_t rootPoints = 5;

using Adjacency = std::vector<std::vector<int>>;

const std::vector<int>& at(const Adjacency& next, int v) {
  return next[static_cast<std::size_t>(v)];
}

/// Widest edges first, those that would close a loop left out.
Adjacency widestForest(const Centreline& line, int& loopsCut) {
  std::vector<std::size_t> order(line.edges.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto radius = [&](int v) { return line.radius_mm[static_cast<std::size_t>(v)]; };
  const auto width = [&](std::size_t e) { return std::min(radius(line.edges[e][0]), radius(line.edges[e][1])); };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return width(a) > width(b); });
  DisjointSets joined(line.points_lps_mm.size());
  Adjacency next(line.points_lps_mm.size());
  for (const std::size_t e : order) {
    const auto [a, b] = line.edges[e];
    if (!joined.join(a, b)) {
      ++loopsCut;
      continue;
    }
    next[static_cast<std::size_t>(a)].push_back(b);
    next[static_cast<std::size_t>(b)].push_back(a);
  }
  for (auto& n : next) std::sort(n.begin(), n.end());
  return next;
}

/// From v over `onward` to the next fork or end, both included.
std::vector<int> pathFrom(const Adjacency& next, int v, int onward) {
  std::vector<int> path{v, onward};
  while (at(next, path.back()).size() == 2) {
    const auto& pair = at(next, path.back());
    path.push_back(pair[0] == path[path.size() - 2] ? pair[1] : pair[0]);
  }
  return path;
}

double lengthOf(const Centreline& line, const std::vector<int>& path) {
  double sum = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i)
    sum += (line.points_lps_mm[static_cast<std::size_t>(path[i])] -
            line.points_lps_mm[static_cast<std::size_t>(path[i - 1])])
               .norm();
  return sum;
}

/// The shortest end branch first, until all leave their vessel.
int prune(const Centreline& line, Adjacency& next) {
  for (int pruned = 0;; ++pruned) {
    std::vector<int> shortest;
    double least = std::numeric_limits<double>::infinity();
    for (int v = 0; v < static_cast<int>(next.size()); ++v) {
      if (at(next, v).size() != 1) continue;
      const std::vector<int> path = pathFrom(next, v, at(next, v)[0]);
      const double length = lengthOf(line, path);
      if (at(next, path.back()).size() < 3 || length >= least ||
          length >= leastEndPerRadius * line.radius_mm[static_cast<std::size_t>(path.back())])
        continue;
      least = length;
      shortest = path;
    }
    if (shortest.empty()) return pruned;
    std::erase(next[static_cast<std::size_t>(shortest.back())], shortest[shortest.size() - 2]);
    for (std::size_t i = 0; i + 1 < shortest.size(); ++i) next[static_cast<std::size_t>(shortest[i])].clear();
  }
}

double endRadius(const Centreline& line, const Adjacency& next, int v) {
  std::vector<double> r;
  for (const int p : pathFrom(next, v, at(next, v)[0])) {
    r.push_back(line.radius_mm[static_cast<std::size_t>(p)]);
    if (r.size() == rootPoints) break;
  }
  std::sort(r.begin(), r.end());
  return r[r.size() / 2];
}

class Builder {
 public:
  Builder(const Centreline& line, const Adjacency& next, VesselTree& tree) : line_(line), next_(next), tree_(tree) {}

  void from(int root) {
    ++tree_.roots;
    add(-1, {root, at(next_, root)[0]}, 1);
  }

 private:
  /// Adds the branch that begins with `path`, and all that follow it. Depth of the recursion: number of forks passed.
  void add(int parent, std::vector<int> path, int order) {
    const std::vector<int> rest = pathFrom(next_, path[path.size() - 2], path.back());
    path.insert(path.end(), rest.begin() + 2, rest.end());
    const int end = path.back();
    std::vector<int> onward;
    for (const int n : at(next_, end))
      if (n != path[path.size() - 2]) onward.push_back(n);
    // A fork as long as it is wide is one fork.
    if (parent >= 0 && !onward.empty() && lengthOf(line_, path) < line_.radius_mm[static_cast<std::size_t>(end)]) {
      for (const int n : onward) {
        std::vector<int> longer = path;
        longer.push_back(n);
        add(parent, std::move(longer), order);
      }
      return;
    }
    VesselBranch b;
    b.parent = parent;
    b.order = order;
    double weighted = 0.0;
    for (std::size_t i = 0; i < path.size(); ++i) {
      b.points_lps_mm.push_back(line_.points_lps_mm[static_cast<std::size_t>(path[i])]);
      b.radius_mm.push_back(line_.radius_mm[static_cast<std::size_t>(path[i])]);
      if (i == 0) continue;
      const double step = (b.points_lps_mm[i] - b.points_lps_mm[i - 1]).norm();
      b.length_mm += step;
      weighted += 0.5 * step * (b.radius_mm[i] + b.radius_mm[i - 1]);
    }
    b.meanRadius_mm = b.length_mm > 0.0 ? weighted / b.length_mm : b.radius_mm.front();
    const int self = static_cast<int>(tree_.branches.size());
    tree_.branches.push_back(std::move(b));
    for (const int n : onward) add(self, {end, n}, order + 1);
  }

  const Centreline& line_;
  const Adjacency& next_;
  VesselTree& tree_;
};

/// Depth below the surface of a cone with round ends.
double depthInCone(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b, double ra, double rb) {
  const Eigen::Vector3d d = b - a;
  const double length2 = d.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp((p - a).dot(d) / length2, 0.0, 1.0) : 0.0;
  return ra + t * (rb - ra) - (p - a - t * d).norm();
}

}  // namespace

double VesselTree::length_mm() const {
  double sum = 0.0;
  for (const VesselBranch& b : branches) sum += b.length_mm;
  return sum;
}

VesselTree treeOf(const Centreline& line) {
  VesselTree tree;
  Adjacency next = widestForest(line, tree.loopsCut);
  tree.pruned = prune(line, next);
  std::vector<char> seen(next.size(), 0);
  for (int v = 0; v < static_cast<int>(next.size()); ++v) {
    if (seen[static_cast<std::size_t>(v)] || at(next, v).empty()) continue;
    std::vector<int> part{v};
    seen[static_cast<std::size_t>(v)] = 1;
    for (std::size_t i = 0; i < part.size(); ++i)
      for (const int n : at(next, part[i]))
        if (!seen[static_cast<std::size_t>(n)]) {
          seen[static_cast<std::size_t>(n)] = 1;
          part.push_back(n);
        }
    std::sort(part.begin(), part.end());
    int root = -1;
    double widest = -1.0;
    for (const int p : part)
      if (at(next, p).size() == 1 && endRadius(line, next, p) > widest) {
        root = p;
        widest = endRadius(line, next, p);
      }
    Builder(line, next, tree).from(root);
  }
  return tree;
}

TriangleMesh tubesOf(const VesselTree& tree, double resolution_mm) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  double thinnest = std::numeric_limits<double>::infinity();
  for (const VesselBranch& b : tree.branches)
    for (std::size_t i = 0; i < b.points_lps_mm.size(); ++i) {
      low = low.cwiseMin((b.points_lps_mm[i].array() - b.radius_mm[i]).matrix());
      high = high.cwiseMax((b.points_lps_mm[i].array() + b.radius_mm[i]).matrix());
      thinnest = std::min(thinnest, b.radius_mm[i]);
    }
  TriangleMesh none;
  none.vertices_lps_mm.resize(3, 0);
  none.triangles.resize(3, 0);
  if (tree.branches.empty()) return none;
  const double h = resolution_mm > 0.0 ? resolution_mm : std::max(0.5 * thinnest, (high - low).maxCoeff() / 200.0);
  image::Grid grid;
  grid.spacing_mm.setConstant(h);
  grid.origin_lps_mm = low.array() - 2.0 * h;
  grid.size = ((high - low) / h).array().ceil().cast<int>() + 5;
  image::ScalarVolume depth(grid, static_cast<float>(-2.0 * h));
  for (const VesselBranch& b : tree.branches)
    for (std::size_t s = 1; s < b.points_lps_mm.size(); ++s) {
      const Eigen::Vector3d &p = b.points_lps_mm[s - 1], &q = b.points_lps_mm[s];
      const double reach = std::max(b.radius_mm[s - 1], b.radius_mm[s]) + 2.0 * h;
      const Eigen::Vector3i first =
          grid.lpsToIndex((p.cwiseMin(q).array() - reach).matrix()).array().ceil().cast<int>().max(0);
      const Eigen::Vector3i last = grid.lpsToIndex((p.cwiseMax(q).array() + reach).matrix())
                                       .array()
                                       .floor()
                                       .cast<int>()
                                       .min(grid.size.array() - 1);
      for (int k = first.z(); k <= last.z(); ++k)
        for (int j = first.y(); j <= last.y(); ++j)
          for (int i = first.x(); i <= last.x(); ++i) {
            float& held = depth.at(i, j, k);
            held = std::max(held, static_cast<float>(depthInCone(grid.indexToLps(Eigen::Vector3d(i, j, k)), p, q,
                                                                 b.radius_mm[s - 1], b.radius_mm[s])));
          }
    }
  return isosurface(depth, 0.0, 0);
}

}  // namespace glisson::anatomy
