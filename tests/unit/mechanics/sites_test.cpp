// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/sites.h"

#include <gtest/gtest.h>

#include <limits>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "scenes.h"

namespace glisson::mechanics {
namespace {

using Eigen::Vector3d;

SiteOptions options(int count, int minimumNodes = 1) {
  SiteOptions o;
  o.count = count;
  o.minimumNodes = minimumNodes;
  return o;
}

TEST(Sites, NearestSiteAgreesWithSearchingAll) {
  Random random(11);
  for (const double flat : {1.0, 0.01}) {
    Eigen::Matrix3Xd sites(3, 150), points(3, 4000);
    for (Eigen::Index i = 0; i < sites.cols(); ++i)
      sites.col(i) = Vector3d(random.uniform(), random.uniform(), flat * random.uniform());
    for (Eigen::Index i = 0; i < points.cols(); ++i)
      points.col(i) = Vector3d(random.uniform(-0.5, 1.5), random.uniform(-0.5, 1.5), random.uniform(-0.5, 1.5));
    const std::vector<int> found = nearestSite(sites, points);
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      Eigen::Index best = 0;
      (sites.colwise() - points.col(i)).colwise().squaredNorm().minCoeff(&best);
      ASSERT_EQ(found[static_cast<std::size_t>(i)], static_cast<int>(best)) << "point " << i;
    }
  }
}

TEST(Sites, EvenlySpreadOverABox) {
  const VoxelMesh mesh(test::box({20, 20, 20}, {0.1, 0.1, 0.1}, 1e3, 0.3));
  const Sites sites = placeSites(mesh, options(64));
  ASSERT_EQ(sites.count(), 64);
  // The Voronoi volumes add up to the body's, and Lloyd's method makes them nearly equal.
  EXPECT_NEAR(sites.spacing_m.array().cube().sum(), 1e-3, 1e-12);
  EXPECT_GT(sites.spacing_m.minCoeff(), 0.85 * 0.025);
  EXPECT_LT(sites.spacing_m.maxCoeff(), 1.15 * 0.025);
  int nodes = 0;
  for (const int n : sites.nodesOf) nodes += n;
  EXPECT_EQ(nodes, mesh.nodeCount());
}

TEST(Sites, SitesOfACurvedBodyLieInside) {
  // A thin shell: most centroids fall into the hollow.
  VoxelBody body = test::box({24, 24, 24}, {0.12, 0.12, 0.12}, 1e3, 0.3);
  test::paint(body, [](const Vector3d& x, double E) {
    const double r = (x - Vector3d::Constant(0.06)).norm();
    return r > 0.045 && r < 0.06 ? E : 0.0;
  });
  const VoxelMesh mesh(body);
  const Sites sites = placeSites(mesh, options(12));
  EXPECT_EQ(sites.count(), 12);
  for (int s = 0; s < sites.count(); ++s) {
    const Eigen::Vector3i c = sites.position_m.col(s).cwiseQuotient(mesh.h_m()).cast<int>();
    EXPECT_GT(body.E_Pa[body.cell(c.x(), c.y(), c.z())], 0.0) << "site " << s;
  }
}

TEST(Sites, DensityDrawsSites) {
  const VoxelMesh mesh(test::box({30, 10, 10}, {0.09, 0.03, 0.03}, 1e3, 0.3));
  SiteOptions o = options(60);
  for (int c = 0; c < mesh.cellCount(); ++c) o.density.push_back(mesh.cellOf(c).x() < 15 ? 8.0 : 1.0);
  const Sites sites = placeSites(mesh, o);
  const auto left = (sites.position_m.row(0).array() < 0.045).count();
  EXPECT_GT(left, 40);
  EXPECT_LT(left, 60);
}

TEST(Sites, TooFewVoxelsMeanFewerSitesAndANote) {
  const VoxelMesh mesh(test::box({8, 8, 8}, {0.08, 0.08, 0.08}, 1e3, 0.3));
  const Sites sites = placeSites(mesh, options(200, 27));
  EXPECT_LT(sites.count(), 28);
  EXPECT_GE(sites.count(), 10);
  for (const int n : sites.nodesOf) EXPECT_GE(n, 27);
  ASSERT_EQ(sites.notes.size(), 1U);
  EXPECT_NE(sites.notes[0].find("instead of 200"), std::string::npos);
}

TEST(Sites, SameSeedSameBitsWithAnyThreads) {
  const VoxelMesh mesh(test::box({20, 15, 10}, {0.1, 0.075, 0.05}, 1e3, 0.3));
  setThreadCount(1);
  const Sites one = placeSites(mesh, options(40));
  setThreadCount(4);
  const Sites four = placeSites(mesh, options(40));
  setThreadCount(0);
  EXPECT_EQ(one.position_m, four.position_m);
  EXPECT_EQ(one.ownerOfNode, four.ownerOfNode);
  SiteOptions other = options(40);
  other.seed = 2;
  EXPECT_NE(one.position_m, placeSites(mesh, other).position_m);
}

TEST(Sites, RefusesBadWishes) {
  const VoxelMesh mesh(test::box({4, 4, 4}, {0.1, 0.1, 0.1}, 1e3, 0.3));
  EXPECT_THROW(placeSites(mesh, options(0)), BadInput);
  SiteOptions o = options(3);
  o.density = {1.0};
  EXPECT_THROW(placeSites(mesh, o), BadInput);
  o.density.assign(64, 1.0);
  o.density[5] = 0.0;
  EXPECT_THROW(placeSites(mesh, o), BadInput);
  o.density[5] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(placeSites(mesh, o), BadInput);
}

}  // namespace
}  // namespace glisson::mechanics
