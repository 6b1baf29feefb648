// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/kernel.h"

#include <gtest/gtest.h>

#include <functional>

#include "base/error.h"
#include "base/parallel.h"
#include "mechanics/detail/kernel_graph.h"
#include "scenes.h"

namespace glisson::mechanics {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

Sites sitesOf(const VoxelMesh& mesh, int count) {
  SiteOptions o;
  o.count = count;
  return placeSites(mesh, o);
}

/// A box with a slot that nearly cuts it in two: two lobes joined at one end.
VoxelBody folded() {
  VoxelBody body = test::box({30, 11, 10}, {0.09, 0.033, 0.03}, 5e3, 0.4);
  test::paint(body,
              [](const Vector3d& x, double E) { return x.x() > 0.015 && x.y() > 0.015 && x.y() < 0.018 ? 0.0 : E; });
  return body;
}

class EveryKernel : public testing::TestWithParam<KernelOptions> {};

TEST_P(EveryKernel, IsAPartitionOfUnity) {
  const VoxelMesh mesh(folded());
  const FrameBasis basis(mesh, sitesOf(mesh, 40), GetParam());
  const VectorXd sum = basis.weights() * VectorXd::Ones(basis.frames());
  EXPECT_LE((sum.array() - 1.0).abs().maxCoeff(), 1e-12);
  if (GetParam().kernel == Kernel::Mls) return;  // moving least squares functions have negative lobes
  for (Eigen::Index k = 0; k < basis.weights().nonZeros(); ++k) EXPECT_GE(basis.weights().valuePtr()[k], 0.0);
}

TEST_P(EveryKernel, ReproducesPolynomialsOfItsOrder) {
  const VoxelMesh mesh(folded());
  const FrameBasis basis(mesh, sitesOf(mesh, 30), GetParam());
  // Taylor coefficients of g at every site, in scaled coordinates, must give g back at every node.
  const bool quadratic = basis.options().order == 2;
  Eigen::Matrix3d A;
  A << 300, 50, -20, 50, -150, 80, -20, 80, 220;
  if (!quadratic) A.setZero();
  const Vector3d b(2.0, -1.0, 0.5);
  const auto g = [&](const Vector3d& x) { return 0.3 + b.dot(x) + 0.5 * x.dot(A * x); };
  VectorXd value = VectorXd::Zero(mesh.nodeCount());
  std::array<double, 10> P{};
  for (int f = 0; f < basis.frames(); ++f) {
    const Vector3d x = basis.sites().position_m.col(f);
    const double h = basis.sites().spacing_m[f];
    const Vector3d slope = h * (b + A * x);
    // The coefficients of moving least squares are values.
    std::array<double, 10> c = {g(x), slope.x(), slope.y(), slope.z()};
    if (quadratic)
      for (int a = 0; a < 3; ++a) {
        c[static_cast<std::size_t>(4 + a)] = 0.5 * h * h * A(a, a);
        c[static_cast<std::size_t>(7 + a)] = h * h * A(a, (a + 1) % 3);
      }
    for (Eigen::SparseMatrix<double>::InnerIterator it(basis.weights(), f); it; ++it) {
      basis.polynomials(f, mesh.position_m(static_cast<int>(it.row())), P.data());
      for (std::size_t m = 0; m < static_cast<std::size_t>(basis.functions()); ++m)
        value[it.row()] += it.value() * P[m] * c[m];
    }
  }
  // At the lips of the slot a moving least squares fit hangs on few sites: its moment matrix magnifies rounding.
  const double rounding = basis.functions() == 1 ? 1e-9 : 1e-12;
  for (int n = 0; n < mesh.nodeCount(); ++n) EXPECT_NEAR(value[n], g(mesh.position_m(n)), rounding) << "node " << n;
}

TEST_P(EveryKernel, DoesNotJumpOverTheGapBetweenLobes) {
  const VoxelMesh mesh(folded());
  const Sites sites = sitesOf(mesh, 40);
  const FrameBasis basis(mesh, sites, GetParam());
  // A frame at the free end of one lobe, far from the joint, has no say in the other lobe.
  int seen = 0;
  for (int f = 0; f < basis.frames(); ++f) {
    const Vector3d x = sites.position_m.col(f);
    if (x.x() < 0.075) continue;
    ++seen;
    for (Eigen::SparseMatrix<double>::InnerIterator it(basis.weights(), f); it; ++it) {
      const Vector3d p = mesh.position_m(static_cast<int>(it.row()));
      EXPECT_EQ(p.y() > 0.0165, x.y() > 0.0165) << "frame " << f;
    }
  }
  EXPECT_GT(seen, 3);
}

TEST_P(EveryKernel, SameBitsWithAnyThreads) {
  const VoxelMesh mesh(folded());
  setThreadCount(1);
  const FrameBasis one(mesh, sitesOf(mesh, 30), GetParam());
  setThreadCount(4);
  const FrameBasis four(mesh, sitesOf(mesh, 30), GetParam());
  setThreadCount(0);
  EXPECT_EQ(Eigen::MatrixXd(one.weights()), Eigen::MatrixXd(four.weights()));
}

INSTANTIATE_TEST_SUITE_P(Kernels, EveryKernel,
                         testing::Values(KernelOptions{Kernel::Wendland, 1, 0.0},
                                         KernelOptions{Kernel::Wendland, 2, 0.0},
                                         KernelOptions{Kernel::Voronoi, 1, 0.0}, KernelOptions{Kernel::Voronoi, 2, 0.0},
                                         KernelOptions{Kernel::Mls, 1, 0.0}, KernelOptions{Kernel::Mls, 2, 0.0}));

VectorXd valuesAtSites(const FrameBasis& basis, const std::function<double(const Vector3d&)>& g) {
  VectorXd v(basis.frames());
  for (int f = 0; f < basis.frames(); ++f) v[f] = g(basis.sites().position_m.col(f));
  return v;
}

double largestMiss(const VoxelMesh& mesh, const FrameBasis& basis, const std::function<double(const Vector3d&)>& g) {
  const VectorXd u = basis.weights() * valuesAtSites(basis, g);
  double worst = 0.0;
  for (int n = 0; n < mesh.nodeCount(); ++n) worst = std::max(worst, std::abs(u[n] - g(mesh.position_m(n))));
  return worst;
}

TEST(MovingLeastSquares, FewSitesKeepWhatTheyCanTellApart) {
  const VoxelMesh mesh(test::box({12, 10, 8}, {0.06, 0.05, 0.04}, 1e3, 0.3));
  const auto linear = [](const Vector3d& x) { return 0.2 + 3 * x.x() - 2 * x.y() + x.z(); };
  // Six sites: no quadratic field can be told from them, every linear one can.
  const FrameBasis six(mesh, sitesOf(mesh, 6), {Kernel::Mls, 2, 0.0});
  EXPECT_FALSE(six.notes().empty());
  EXPECT_LE(largestMiss(mesh, six, linear), 1e-12);
  EXPECT_LE(largestMiss(mesh, six, [](const Vector3d&) { return 1.0; }), 1e-13);
  // One site: the constant.
  const FrameBasis one(mesh, sitesOf(mesh, 1), {Kernel::Mls, 1, 0.0});
  EXPECT_LE(largestMiss(mesh, one, [](const Vector3d&) { return 1.0; }), 1e-13);
  EXPECT_FALSE(one.notes().empty());
}

TEST(MovingLeastSquares, SitesInAPlaneGiveTheFieldsOfThatPlane) {
  const VoxelMesh mesh(test::box({12, 12, 4}, {0.06, 0.06, 0.02}, 1e3, 0.3));
  // An oblique plane: no axis of the grid lies in it or across it.
  const Vector3d a = Vector3d(1, 0.2, 0.3), b = Vector3d(-0.1, 1, 0.1), across = a.cross(b).normalized();
  Eigen::Matrix3Xd at(3, 25);
  for (int i = 0; i < 25; ++i) at.col(i) = Vector3d(0.006, 0.008, 0.001) + 0.01 * (i % 5) * a + 0.01 * (i / 5) * b;
  for (const int order : {1, 2}) {
    const FrameBasis basis(mesh, sitesAt(mesh, at, 1), {Kernel::Mls, order, 0.0});
    ASSERT_EQ(basis.frames(), 25);
    EXPECT_FALSE(basis.notes().empty());
    const VectorXd sum = basis.weights() * VectorXd::Ones(25);
    EXPECT_LE((sum.array() - 1.0).abs().maxCoeff(), 1e-12);
    const Vector3d within = (a - across * across.dot(a)).normalized();
    EXPECT_LE(largestMiss(mesh, basis, [&](const Vector3d& x) { return 1 + 2 * within.dot(x); }), 1e-10) << order;
    // What varies across the plane is taken as it is on the plane: bounded, not extrapolated.
    const VectorXd u = basis.weights() * valuesAtSites(basis, [&](const Vector3d& x) { return across.dot(x); });
    const double plane = across.dot(Vector3d(at.col(0)));
    EXPECT_LE((u.array() - plane).abs().maxCoeff(), 1e-10) << order;
  }
}

TEST(VoronoiKernel, IsOneAtTheSiteHalfAtTheBorderZeroAtTheNeighbour) {
  // Two sites in a straight bar: the ratio of distances is linear between them.
  const VoxelMesh mesh(test::box({40, 1, 1}, {0.4, 0.01, 0.01}, 1e3, 0.3));
  Sites sites;
  sites.position_m.resize(3, 2);
  sites.position_m << 0.10, 0.30, 0.0, 0.0, 0.0, 0.0;
  sites.spacing_m = VectorXd::Constant(2, 0.03);
  Eigen::Matrix3Xd nodes(3, mesh.nodeCount());
  for (int n = 0; n < mesh.nodeCount(); ++n) nodes.col(n) = mesh.position_m(n);
  sites.ownerOfNode = nearestSite(sites.position_m, nodes);
  const FrameBasis basis(mesh, sites, {Kernel::Voronoi, 1, 0.0});
  for (int i = 0; i <= 40; ++i) {
    const double x = 0.01 * i;
    const double expected = std::clamp((0.30 - x) / 0.20, 0.0, 1.0);
    EXPECT_NEAR(basis.weights().coeff(mesh.nodeAt(i, 0, 0), 0), expected, 1e-12) << "x " << x;
  }
}

TEST(NodeGraph, PathsGoRoundTheGap) {
  const VoxelMesh mesh(folded());
  const NodeGraph graph(mesh);
  std::vector<double> d(static_cast<std::size_t>(mesh.nodeCount()), std::numeric_limits<double>::infinity());
  graph.shortest(
      {{mesh.nodeAt(30, 5, 0), 0.0}}, [](int) { return true; }, d);
  // Along one lip of the slot to its end at x = 15 mm and back along the other: 2 × 75 mm and the 3 mm between them.
  EXPECT_NEAR(d[static_cast<std::size_t>(mesh.nodeAt(30, 6, 0))], 0.153, 1e-12);
}

TEST(FrameBasis, RefusesBadOptions) {
  const VoxelMesh mesh(test::box({6, 6, 6}, {0.03, 0.03, 0.03}, 1e3, 0.3));
  EXPECT_THROW(FrameBasis(mesh, sitesOf(mesh, 4), {Kernel::Wendland, 3, 0.0}), BadInput);
  EXPECT_THROW(FrameBasis(mesh, sitesOf(mesh, 4), {Kernel::Wendland, 1, 0.5}), BadInput);
  EXPECT_THROW(FrameBasis(mesh, sitesOf(mesh, 4), {Kernel::Wendland, 1, 7.0}), BadInput);
}

}  // namespace
}  // namespace glisson::mechanics
