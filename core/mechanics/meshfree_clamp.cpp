// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/meshfree_clamp.h"

#include <cmath>
#include <limits>

#include "base/error.h"
#include "mechanics/supports.h"

namespace glisson::mechanics {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// One line of the exact squared distance transform (lower envelope of parabolas) [felzenszwalb2012distance].
class Line {
 public:
  explicit Line(int longest)
      : f_(static_cast<std::size_t>(longest)), source_(f_.size()), vertex_(f_.size()), border_(f_.size() + 1) {}

  /// n samples `stride` apart starting at `first`; h: spacing.
  void run(std::vector<double>& f, std::vector<int>& source, std::size_t first, std::size_t stride, int n, double h) {
    const auto count = static_cast<std::size_t>(n);
    for (std::size_t i = 0; i < count; ++i) f_[i] = f[first + i * stride], source_[i] = source[first + i * stride];
    std::size_t k = 0;
    bool any = false;
    for (std::size_t q = 0; q < count; ++q) {
      if (!std::isfinite(f_[q])) continue;
      const double xq = h * static_cast<double>(q);
      double s = -infinity;
      while (any) {
        const double xv = h * static_cast<double>(vertex_[k]);
        s = ((f_[q] + xq * xq) - (f_[vertex_[k]] + xv * xv)) / (2.0 * (xq - xv));
        if (s > border_[k]) break;
        if (k == 0) {
          any = false;
          s = -infinity;
        } else {
          --k;
        }
      }
      k = any ? k + 1 : 0;
      any = true;
      vertex_[k] = q;
      border_[k] = s;
      border_[k + 1] = infinity;
    }
    if (!any) return;
    std::size_t v = 0;
    for (std::size_t q = 0; q < count; ++q) {
      const double x = h * static_cast<double>(q);
      while (border_[v + 1] < x) ++v;
      const double dx = x - h * static_cast<double>(vertex_[v]);
      f[first + q * stride] = dx * dx + f_[vertex_[v]];
      source[first + q * stride] = source_[vertex_[v]];
    }
  }

 private:
  std::vector<double> f_;
  std::vector<int> source_;
  std::vector<std::size_t> vertex_;
  std::vector<double> border_;
};

/// Squared distance (m²) of every lattice node to the nearest source, and which source that is.
struct Distances {
  std::vector<double> squared_m2;
  std::vector<int> source;
};

Distances distanceTo(const VoxelMesh& mesh, const std::vector<int>& sources) {
  const Eigen::Vector3i n = mesh.cells() + Eigen::Vector3i::Ones();
  const auto nx = static_cast<std::size_t>(n.x()), ny = static_cast<std::size_t>(n.y()),
             nz = static_cast<std::size_t>(n.z());
  Distances out{std::vector<double>(nx * ny * nz, infinity), std::vector<int>(nx * ny * nz, -1)};
  for (const int node : sources) {
    const Eigen::Vector3i p = mesh.latticeOf(node);
    const std::size_t at =
        (static_cast<std::size_t>(p.z()) * ny + static_cast<std::size_t>(p.y())) * nx + static_cast<std::size_t>(p.x());
    out.squared_m2[at] = 0.0;
    out.source[at] = node;
  }
  Line line(n.maxCoeff());
  for (std::size_t k = 0; k < nz; ++k)
    for (std::size_t j = 0; j < ny; ++j)
      line.run(out.squared_m2, out.source, (k * ny + j) * nx, 1, n.x(), mesh.h_m().x());
  for (std::size_t k = 0; k < nz; ++k)
    for (std::size_t i = 0; i < nx; ++i)
      line.run(out.squared_m2, out.source, k * ny * nx + i, nx, n.y(), mesh.h_m().y());
  for (std::size_t j = 0; j < ny; ++j)
    for (std::size_t i = 0; i < nx; ++i)
      line.run(out.squared_m2, out.source, j * nx + i, nx * ny, n.z(), mesh.h_m().z());
  return out;
}

}  // namespace

Clamp distanceClamp(const VoxelMesh& mesh, const Supports& supports, double h_m) {
  if (!(h_m > 0.0))
    throw BadArgument("distanceClamp: transition width " + std::to_string(h_m) + " m; must be positive");
  const DirichletData dirichlet = readDirichlet(supports.fixations, mesh.nodeCount());
  const auto& fixed = dirichlet.constrained;
  Clamp clamp;
  clamp.lifted = (dirichlet.value_m.array() != 0.0).any();
  clamp.sameOnAllAxes = (fixed.row(0) == fixed.row(1)).all() && (fixed.row(1) == fixed.row(2)).all();
  clamp.d = NodalField::Ones(3, mesh.nodeCount());
  clamp.lift_m = NodalField::Zero(3, mesh.nodeCount());
  clamp.nearest.setConstant(3, mesh.nodeCount(), -1);
  const Eigen::Vector3i n = mesh.cells() + Eigen::Vector3i::Ones();
  Distances distances;
  for (int c = 0; c < 3; ++c) {
    std::vector<int> sources;
    for (int m = 0; m < mesh.nodeCount(); ++m)
      if (fixed(c, m)) sources.push_back(m);
    if (sources.empty()) continue;
    if (c == 0 || !clamp.sameOnAllAxes) distances = distanceTo(mesh, sources);
    for (int m = 0; m < mesh.nodeCount(); ++m) {
      const Eigen::Vector3i p = mesh.latticeOf(m);
      const std::size_t at =
          (static_cast<std::size_t>(p.z()) * static_cast<std::size_t>(n.y()) + static_cast<std::size_t>(p.y())) *
              static_cast<std::size_t>(n.x()) +
          static_cast<std::size_t>(p.x());
      const double rest = std::max(0.0, 1.0 - std::sqrt(distances.squared_m2[at]) / h_m);
      const double near = rest * rest * rest;
      clamp.d(c, m) = 1.0 - near;
      clamp.nearest(c, m) = distances.source[at];
      clamp.lift_m(c, m) = near * dirichlet.value_m(c, distances.source[at]);
    }
  }
  return clamp;
}

}  // namespace glisson::mechanics
