// SPDX-License-Identifier: GPL-3.0-or-later
#include "retraction/live_condensed.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "base/error.h"

namespace glisson::retraction {
namespace {

/// A block of 60 × 48 × 48 mm on springs, pulled at its underside; its stiffness grows along L.
Model block(const Eigen::Matrix3d& direction) {
  image::Grid g;
  g.size = {10, 8, 8};
  g.spacing_mm = {6.0, 6.0, 6.0};
  g.direction = direction;
  image::ScalarVolume E(g, 0.0f);
  for (int k = 0; k < 8; ++k)
    for (int j = 0; j < 8; ++j)
      for (int i = 0; i < 10; ++i) E.at(i, j, k) = 3.0f + 0.4f * static_cast<float>(i);
  return makeModel(std::move(E), 0.45, defaults::liverDensity, false);
}

Setup setupOf(const Eigen::Vector3d& direction, double force_N, bool weight) {
  Setup s;
  SupportSpec springs;
  springs.kind = SupportSpec::Kind::Spring;
  springs.region = SurfaceRegion{"all"};
  springs.stiffness_kPa_per_mm = 0.1;
  s.supports.push_back(springs);
  Retractor bar;
  bar.length_mm = 30.0;
  bar.direction = direction;
  bar.force_N = force_N;
  s.loads.emplace_back(bar);
  if (weight) s.loads.emplace_back(BodyForce{Eigen::Vector3d(0.0, 900.0, 0.0)});
  s.solver.tolerance = 1e-10;
  return s;
}

class Live : public testing::TestWithParam<bool> {
 protected:
  Eigen::Matrix3d direction() const {
    return GetParam() ? Eigen::AngleAxisd(0.2, Eigen::Vector3d(1.0, 1.0, 0.3).normalized()).toRotationMatrix()
                      : Eigen::Matrix3d::Identity();
  }
};

TEST_P(Live, IsTheFullSolveUnderTheScenesOwnForce) {
  const Model model = block(direction());
  const retraction::Setup setup = setupOf({0.0, -1.0, 0.0}, 2.0, true);
  const std::vector<Eigen::Vector3d> points = {direction() * Eigen::Vector3d(20.0, 20.0, 20.0),
                                               direction() * Eigen::Vector3d(33.0, 5.0, 11.0)};
  const Result full = simulate(model, setup, points);
  const CondensedRetraction live(model, setup, points, true);
  EXPECT_NEAR((live.sceneForce_N() - Eigen::Vector3d(0.0, -2.0, 0.0)).norm(), 0.0, 1e-9);
  Eigen::Matrix3Xd u_mm;
  live.evaluate(live.sceneForce_N(), u_mm);
  ASSERT_EQ(u_mm.cols(), 2 + static_cast<Eigen::Index>(live.nodes_mm().size()));
  for (int i = 0; i < 2; ++i)
    EXPECT_LT((u_mm.col(i) - full.probe_u_mm[static_cast<std::size_t>(i)]).norm(), 1e-6) << "point " << i;
  // The whole field too: nodal displacements are kept in the grid's own axes.
  for (Eigen::Index n = 0; n < full.nodal_u_m.cols(); ++n)
    ASSERT_LT((u_mm.col(2 + n) - 1e3 * (direction() * full.nodal_u_m.col(n))).norm(), 1e-6) << "node " << n;
}

TEST_P(Live, FollowsTheTool) {
  const Model model = block(direction());
  const retraction::Setup setup = setupOf({0.0, -1.0, 0.0}, 2.0, true);
  const CondensedRetraction live(model, setup, {}, false);
  const Eigen::Vector3d wanted(1.5, -4.0, 2.0);
  EXPECT_LT((live.toolDisplacement_mm(live.forceFor(wanted)) - wanted).norm(), 1e-9);
  // Pulling further takes more force, and along the pull.
  const Eigen::Vector3d more = live.forceFor({0.0, -8.0, 0.0}) - live.forceFor({0.0, -4.0, 0.0});
  EXPECT_LT(more.y(), 0.0);
}

TEST_P(Live, PullsInAnyDirectionAsAFullSolveDoes) {
  const Model model = block(direction());
  const Eigen::Vector3d point = direction() * Eigen::Vector3d(40.0, 30.0, 8.0);
  // The contact is laid by the scene's own direction; a force along another one is a sum of the three columns.
  const CondensedRetraction live(model, setupOf({0.0, -1.0, 0.0}, 2.0, false), {point}, false);
  Eigen::Matrix3Xd all, a, b, c;
  live.evaluate({0.7, -1.1, 0.4}, all);
  live.evaluate({0.7, 0.0, 0.0}, a);
  live.evaluate({0.0, -1.1, 0.0}, b);
  live.evaluate({0.0, 0.0, 0.4}, c);
  EXPECT_LT((all - a - b - c).norm(), 1e-12);
  EXPECT_GT(a.norm(), 0.0);
}

INSTANTIATE_TEST_SUITE_P(Grids, Live, testing::Bool());

TEST(LiveRefuses, AScenesWithoutATool) {
  retraction::Setup setup = setupOf({0.0, -1.0, 0.0}, 2.0, true);
  setup.loads.erase(setup.loads.begin());
  EXPECT_THROW(CondensedRetraction(block(Eigen::Matrix3d::Identity()), setup, {}, false), BadInput);
}

}  // namespace
}  // namespace glisson::retraction
