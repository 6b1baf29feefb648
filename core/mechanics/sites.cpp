// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/sites.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"

namespace glisson::mechanics {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Eigen::Vector3i;

/// Sites sorted into equal boxes; the search goes outwards shell by shell until no nearer site is possible.
class Buckets {
 public:
  explicit Buckets(const Matrix3Xd& sites) : sites_(sites) {
    low_ = sites.rowwise().minCoeff();
    const Vector3d extent = (sites.rowwise().maxCoeff() - low_).cwiseMax(1e-12);
    // About two sites per box, whatever the body's aspect.
    const double volume = extent.cwiseMax(extent.maxCoeff() * 0.05).prod();
    edge_ = std::max(std::cbrt(2.0 * volume / static_cast<double>(sites.cols())), extent.maxCoeff() / 64.0);
    for (int a = 0; a < 3; ++a) n_[a] = static_cast<int>(extent[a] / edge_) + 1;
    start_.assign(static_cast<std::size_t>(n_.prod()) + 1, 0);
    std::vector<int> box(static_cast<std::size_t>(sites.cols()));
    for (Eigen::Index s = 0; s < sites.cols(); ++s) {
      box[static_cast<std::size_t>(s)] = index(boxOf(sites.col(s)));
      ++start_[static_cast<std::size_t>(box[static_cast<std::size_t>(s)]) + 1];
    }
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    member_.resize(box.size());
    std::vector<int> next(start_.begin(), start_.end() - 1);
    for (std::size_t s = 0; s < box.size(); ++s)
      member_[static_cast<std::size_t>(next[static_cast<std::size_t>(box[s])]++)] = static_cast<int>(s);
  }

  int nearest(const Vector3d& p) const {
    const Vector3i c = boxOf(p);
    // Shells are counted from the box nearest to p; a point outside all boxes is no nearer to them than its box.
    double best = std::numeric_limits<double>::infinity();
    int found = 0;
    const int last = n_.maxCoeff();
    for (int r = 0; r <= last; ++r) {
      const double safe = (r - 1) * edge_;
      if (r > 1 && safe * safe > best) break;
      for (int k = std::max(0, c.z() - r); k <= std::min(n_.z() - 1, c.z() + r); ++k)
        for (int j = std::max(0, c.y() - r); j <= std::min(n_.y() - 1, c.y() + r); ++j) {
          const bool wall = std::abs(k - c.z()) == r || std::abs(j - c.y()) == r;
          const int step = wall || r == 0 ? 1 : 2 * r;
          for (int i = c.x() - r; i <= c.x() + r; i += step) {
            if (i < 0 || i >= n_.x()) continue;
            const auto b = static_cast<std::size_t>(index({i, j, k}));
            for (int m = start_[b]; m < start_[b + 1]; ++m) {
              const int s = member_[static_cast<std::size_t>(m)];
              const double d = (sites_.col(s) - p).squaredNorm();
              if (d < best || (d == best && s < found)) best = d, found = s;
            }
          }
        }
    }
    return found;
  }

 private:
  Vector3i boxOf(const Vector3d& p) const {
    Vector3i b;
    for (int a = 0; a < 3; ++a)
      b[a] = static_cast<int>(std::clamp(std::floor((p[a] - low_[a]) / edge_), 0.0, static_cast<double>(n_[a] - 1)));
    return b;
  }
  int index(const Vector3i& b) const { return (b.z() * n_.y() + b.y()) * n_.x() + b.x(); }

  const Matrix3Xd& sites_;
  Vector3d low_ = Vector3d::Zero();
  double edge_ = 1.0;
  Vector3i n_ = Vector3i::Ones();
  std::vector<int> start_, member_;
};

struct Cells {
  Matrix3Xd centre_m;
  std::vector<double> weight;
  double volume_m3 = 0.0;
};

Matrix3Xd firstGuess(const Cells& cells, int count, Random& random) {
  std::vector<double> cumulative(cells.weight.size());
  std::partial_sum(cells.weight.begin(), cells.weight.end(), cumulative.begin());
  std::vector<char> taken(cumulative.size(), 0);
  Matrix3Xd sites(3, count);
  for (int s = 0; s < count; ++s) {
    const double u = random.uniform() * cumulative.back();
    auto c = static_cast<std::size_t>(std::upper_bound(cumulative.begin(), cumulative.end(), u) - cumulative.begin());
    c = std::min(c, cumulative.size() - 1);
    while (taken[c]) c = (c + 1) % taken.size();
    taken[c] = 1;
    sites.col(s) = cells.centre_m.col(static_cast<Eigen::Index>(c));
  }
  return sites;
}

/// One Lloyd step: each site moves to the weighted centroid of the cells nearest to it; one without cells stays.
void lloydStep(const Cells& cells, Matrix3Xd& sites) {
  const std::vector<int> owner = nearestSite(sites, cells.centre_m);
  Matrix3Xd sum = Matrix3Xd::Zero(3, sites.cols());
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(sites.cols());
  for (std::size_t c = 0; c < owner.size(); ++c) {
    sum.col(owner[c]) += cells.weight[c] * cells.centre_m.col(static_cast<Eigen::Index>(c));
    mass[owner[c]] += cells.weight[c];
  }
  for (Eigen::Index s = 0; s < sites.cols(); ++s)
    if (mass[s] > 0.0) sites.col(s) = sum.col(s) / mass[s];
}

/// In a body that is not convex a centroid may fall outside: such a site goes to the nearest cell of its own.
void bringInside(const VoxelMesh& mesh, const Cells& cells, Matrix3Xd& sites) {
  const std::vector<int> owner = nearestSite(sites, cells.centre_m);
  std::vector<int> best(static_cast<std::size_t>(sites.cols()), -1);
  std::vector<double> distance(best.size(), std::numeric_limits<double>::infinity());
  for (std::size_t c = 0; c < owner.size(); ++c) {
    const auto s = static_cast<std::size_t>(owner[c]);
    const double d = (cells.centre_m.col(static_cast<Eigen::Index>(c)) - sites.col(owner[c])).squaredNorm();
    if (d < distance[s]) distance[s] = d, best[s] = static_cast<int>(c);
  }
  for (std::size_t s = 0; s < best.size(); ++s) {
    if (best[s] < 0) continue;
    const auto column = static_cast<Eigen::Index>(s);
    const Vector3d off = (sites.col(column) - cells.centre_m.col(best[s])).cwiseAbs();
    if ((off.array() > 0.5000001 * mesh.h_m().array()).any()) sites.col(column) = cells.centre_m.col(best[s]);
  }
}

Matrix3Xd nodePositions(const VoxelMesh& mesh) {
  Matrix3Xd p(3, mesh.nodeCount());
  for (int n = 0; n < mesh.nodeCount(); ++n) p.col(n) = mesh.position_m(n);
  return p;
}

Cells uniformCells(const VoxelMesh& mesh) {
  Cells cells;
  cells.centre_m.resize(3, mesh.cellCount());
  cells.weight.assign(static_cast<std::size_t>(mesh.cellCount()), 1.0);
  cells.volume_m3 = mesh.h_m().prod();
  for (int c = 0; c < mesh.cellCount(); ++c)
    cells.centre_m.col(c) = (mesh.cellOf(c).cast<double>() + Vector3d::Constant(0.5)).cwiseProduct(mesh.h_m());
  return cells;
}

/// Drops sites until each owns `minimum` nodes (or one is left), a few Lloyd steps after each drop; sets who owns what.
void thinOut(const VoxelMesh& mesh, const Cells& cells, int minimum, int lloydSteps, Matrix3Xd& sites, Sites& out,
             const Progress& progress) {
  const Matrix3Xd nodes = nodePositions(mesh);
  while (true) {
    progress.check();
    bringInside(mesh, cells, sites);
    out.ownerOfNode = nearestSite(sites, nodes);
    out.nodesOf.assign(static_cast<std::size_t>(sites.cols()), 0);
    for (const int s : out.ownerOfNode) ++out.nodesOf[static_cast<std::size_t>(s)];
    // The poorest sites go first, a tenth of the violators at a time, so that their neighbours can grow.
    std::vector<int> order(out.nodesOf.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
      return out.nodesOf[static_cast<std::size_t>(a)] < out.nodesOf[static_cast<std::size_t>(b)];
    });
    const auto violators = std::count_if(out.nodesOf.begin(), out.nodesOf.end(), [&](int n) { return n < minimum; });
    if (violators == 0 || sites.cols() == 1) break;
    const auto drop = std::min<Eigen::Index>(sites.cols() - 1, 1 + violators / 10);
    std::vector<char> dropped(out.nodesOf.size(), 0);
    for (Eigen::Index d = 0; d < drop; ++d) dropped[static_cast<std::size_t>(order[static_cast<std::size_t>(d)])] = 1;
    Matrix3Xd kept(3, sites.cols() - drop);
    Eigen::Index k = 0;
    for (Eigen::Index s = 0; s < sites.cols(); ++s)
      if (!dropped[static_cast<std::size_t>(s)]) kept.col(k++) = sites.col(s);
    sites = std::move(kept);
    for (int it = 0; it < lloydSteps; ++it) lloydStep(cells, sites);
  }
}

void measure(const Cells& cells, Matrix3Xd sites, Sites& out) {
  const std::vector<int> owner = nearestSite(sites, cells.centre_m);
  Eigen::VectorXd volume = Eigen::VectorXd::Zero(sites.cols());
  for (const int s : owner) volume[s] += cells.volume_m3;
  out.position_m = std::move(sites);
  out.spacing_m = volume.cwiseMax(cells.volume_m3).array().pow(1.0 / 3.0);
}

}  // namespace

std::vector<int> nearestSite(const Matrix3Xd& sites, const Matrix3Xd& points) {
  if (sites.cols() < 1) throw BadArgument("nearestSite: no sites");
  const Buckets buckets(sites);
  std::vector<int> owner(static_cast<std::size_t>(points.cols()));
  parallelChunks(owner.size(), 2048, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) owner[c] = buckets.nearest(points.col(static_cast<Eigen::Index>(c)));
  });
  return owner;
}

Sites placeSites(const VoxelMesh& mesh, const SiteOptions& options, const Progress& progress) {
  if (options.count < 1)
    throw BadInput("mesh-free sites: " + std::to_string(options.count) + " frames asked for; give at least 1");
  const auto cellCount = static_cast<std::size_t>(mesh.cellCount());
  if (!options.density.empty() && options.density.size() != cellCount)
    throw BadInput("mesh-free sites: the density has " + std::to_string(options.density.size()) +
                   " values for a body of " + std::to_string(cellCount) + " filled cells");
  Cells cells = uniformCells(mesh);
  for (int c = 0; c < mesh.cellCount() && !options.density.empty(); ++c) {
    const double d = options.density[static_cast<std::size_t>(c)];
    if (!(d > 0.0) || !std::isfinite(d))
      throw BadInput("mesh-free sites: density " + std::to_string(d) + " at filled cell " + std::to_string(c) +
                     "; every value must be positive and finite");
    cells.weight[static_cast<std::size_t>(c)] = d;
  }

  const int minimum = std::max(1, options.minimumNodes);
  const int most = mostSites(mesh.nodeCount(), mesh.cellCount(), minimum);
  Random random(options.seed);
  Matrix3Xd sites = firstGuess(cells, std::min(options.count, most), random);
  for (int it = 0; it < options.iterations; ++it) {
    progress.report(static_cast<double>(it) / options.iterations, "placing mesh-free frames");
    lloydStep(cells, sites);
  }

  Sites out;
  thinOut(mesh, cells, minimum, 5, sites, out, progress);
  if (sites.cols() < options.count)
    out.notes.push_back(std::to_string(sites.cols()) + " frames instead of " + std::to_string(options.count) +
                        ": each needs at least " + std::to_string(minimum) + " of the body's " +
                        std::to_string(mesh.nodeCount()) + " voxel nodes; use smaller voxels for more frames");

  measure(cells, std::move(sites), out);
  progress.report(1.0, "placing mesh-free frames");
  return out;
}

int mostSites(double nodes, double cells, int minimumNodes) {
  return static_cast<int>(std::max(1.0, std::min({nodes / std::max(1, minimumNodes), cells, 1e9})));
}

Sites sitesAt(const VoxelMesh& mesh, const Matrix3Xd& position_m, int minimumNodes) {
  if (!position_m.allFinite()) throw BadInput("a mesh-free site has a coordinate that is not finite");
  Matrix3Xd sites(3, position_m.cols());
  Eigen::Index kept = 0, outside = 0, duplicates = 0;
  const double near = 1e-3 * mesh.h_m().minCoeff();
  for (Eigen::Index s = 0; s < position_m.cols(); ++s) {
    const Vector3d p = position_m.col(s);
    // A site on the surface belongs to the cell next to it.
    bool inside = false;
    for (int corner = 0; corner < 8 && !inside; ++corner) {
      const Vector3d shift(corner & 1 ? near : -near, corner & 2 ? near : -near, corner & 4 ? near : -near);
      const Vector3d c = (p + shift).cwiseQuotient(mesh.h_m()).array().floor();
      if ((c.array() < 0).any() || (c.array() >= mesh.cells().cast<double>().array()).any()) continue;
      inside = mesh.isFilled(static_cast<int>(c.x()), static_cast<int>(c.y()), static_cast<int>(c.z()));
    }
    if (!inside) {
      ++outside;
      continue;
    }
    if (kept > 0 && (sites.leftCols(kept).colwise() - p).colwise().norm().minCoeff() < near) {
      ++duplicates;
      continue;
    }
    sites.col(kept++) = p;
  }
  if (kept == 0)
    throw BadInput("none of the " + std::to_string(position_m.cols()) + " mesh-free sites given lies in the body");
  sites.conservativeResize(3, kept);
  Sites out;
  const Cells cells = uniformCells(mesh);
  thinOut(mesh, cells, std::max(1, minimumNodes), 0, sites, out, {});
  const auto note = [&](Eigen::Index n, const std::string& why) {
    if (n > 0) out.notes.push_back(std::to_string(n) + " mesh-free sites left out: " + why);
  };
  note(outside, "they lie outside the body");
  note(duplicates, "each lies on another one");
  note(kept - sites.cols(), "their cells hold fewer than " + std::to_string(minimumNodes) + " voxel nodes");
  measure(cells, std::move(sites), out);
  return out;
}

}  // namespace glisson::mechanics
