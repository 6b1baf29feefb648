// SPDX-License-Identifier: GPL-3.0-or-later

// A body that follows a bar in the hand, frame by frame.
#include "mechanics/contact/contact_tracker.h"

#include <gtest/gtest.h>

#include "contact_scenes.h"
#include "mechanics/measures.h"

namespace glisson::mechanics {
namespace {

ContactProblem block() {
  ContactProblem p = onClampedBlock(box({16, 10, 12}, Eigen::Vector3d::Constant(5e-3), 6000, 0.45), 3);
  p.bar = RigidBar{{{0.02, 0.09, 0.03}, {0.06, 0.09, 0.03}}, 0.005, {0, -1, 0}};
  return p;
}

const std::vector<Eigen::Vector3d> watched = {{0.04, 0.05, 0.03}, {0.04, 0.035, 0.03}, {0.013, 0.042, 0.017}};

/// Frames until the bar has come to rest there.
TrackedState settledAt(ContactTracker& tracker, const Eigen::Vector3d& target_m) {
  TrackedState s;
  for (int frame = 0; frame < 200; ++frame) {
    s = tracker.moveTowards(target_m);
    if (s.atRest && (s.moved_m - target_m).norm() < 1e-9) return s;
  }
  ADD_FAILURE() << "not at rest after 200 frames, " << s.remaining_m << " m away";
  return s;
}

TrackerOptions exactly() {
  TrackerOptions o;
  o.newton = 60;
  o.inner = 200;
  o.tolerance = 1e-6;
  return o;
}

TEST(ContactTracker, ComesToRestWhereAWholeSolveEnds) {
  ContactProblem p = block();
  p.travel_m = 9e-3;
  const ContactSolution whole = solveContact(p);
  ASSERT_TRUE(whole.solution.report.converged());
  ContactTracker tracker(p, watched);
  EXPECT_EQ(tracker.cell_m(), 5e-3);
  const TrackedState s = settledAt(tracker, {0, -9e-3, 0});
  EXPECT_NEAR(s.force_N.norm(), whole.force_N.norm(), 1e-3 * whole.force_N.norm());
  Eigen::Matrix3Xd u_m;
  tracker.displacements(u_m);
  for (std::size_t i = 0; i < watched.size(); ++i) {
    const auto u = displacementAt(VoxelMesh(p.problem.body), whole.solution.u_m, watched[i]);
    EXPECT_LT((u_m.col(static_cast<Eigen::Index>(i)) - *u).norm(), 5e-6) << i;
  }
}

TEST(ContactTracker, AFrameIsBoundedAndTellsHowFarItIsFromRest) {
  ContactTracker tracker(block(), watched), exact(block(), watched, exactly());
  Eigen::Matrix3Xd u_m, there_m;
  double worst_m = 0, told_m = 0;
  for (int frame = 1; frame <= 10; ++frame) {
    const Eigen::Vector3d target(0, -1e-3 * frame, 0);
    const TrackedState s = tracker.moveTowards(target);
    EXPECT_LE(s.newton, 2);
    EXPECT_LE(s.inner, 2 * 2 * 4);                     // a direction that does not descend is sought once more
    EXPECT_LT((s.moved_m - target).norm(), 1.001e-3);  // it may have waited for the body once
    exact.moveTowards(s.moved_m);
    tracker.displacements(u_m);
    exact.displacements(there_m);
    if (frame <= 3) continue;  // a flat face meets all of the bar at once: it snaps against it
    worst_m = std::max(worst_m, (u_m - there_m).colwise().norm().maxCoeff());
    told_m = std::max(told_m, s.remaining_m);
  }
  EXPECT_LT(worst_m, 0.15e-3);
  EXPECT_GT(told_m, 0.3 * worst_m);
  EXPECT_LT(told_m, 10 * worst_m + 1e-6);
}

TEST(ContactTracker, GoesNoFurtherInAFrameThanItMay) {
  ContactTracker tracker(block(), watched);
  const TrackedState s = tracker.moveTowards({0, -20e-3, 0});
  EXPECT_NEAR(s.moved_m.norm(), 2e-3, 1e-12);
}

TEST(ContactTracker, ABarThatIsTakenAwayLeavesTheBodyAtRest) {
  ContactTracker tracker(block(), watched);
  settledAt(tracker, {0, -6e-3, 0});
  const TrackedState s = settledAt(tracker, {0, 5e-3, 0});
  EXPECT_EQ(s.force_N.norm(), 0);
  Eigen::Matrix3Xd u_m;
  tracker.displacements(u_m);
  EXPECT_LT(u_m.cwiseAbs().maxCoeff(), 2e-6);
}

TEST(ContactTracker, TheWayOfTheBarDoesNotMatterWhereItIsElastic) {
  ContactTracker one(block(), watched), other(block(), watched);
  const Eigen::Vector3d end(3e-3, -6e-3, 2e-3);
  const TrackedState a = settledAt(one, end);
  settledAt(other, {3e-3, 0, 2e-3});
  const TrackedState b = settledAt(other, end);
  EXPECT_LT((a.force_N - b.force_N).norm(), 2e-3 * a.force_N.norm());
  EXPECT_GT(a.force_N.norm(), 0.1);
}

}  // namespace
}  // namespace glisson::mechanics
