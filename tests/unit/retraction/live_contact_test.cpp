// SPDX-License-Identifier: GPL-3.0-or-later

// A bar that a force or a travel leads, frame by frame: its rule on springs that are known, then the liver itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "retraction/force_seeker.h"
#include "retraction/live.h"

namespace glisson::retraction {
namespace {

/// A body whose force at rest is known; it lags behind the bar for some frames.
struct Springs {
  std::function<double(double)> force_N;
  ForceSeeker::Seen seen{};
  double lag_mm = 0.0;

  void frame(double goal_mm) {
    const double move = std::clamp(goal_mm - seen.along_mm, -2.0, 2.0);
    seen.along_mm += move;
    lag_mm = 0.25 * lag_mm + 0.1 * move;
    seen.force_N = force_N(seen.along_mm + lag_mm);
    seen.still = std::abs(lag_mm) < 0.03;
    seen.settled = std::abs(lag_mm) < 1e-5;
  }
  /// Frames until the force is reached at rest, or the bar slips; 0 where neither comes.
  int meet(ForceSeeker& seeker, double asked_N) {
    for (int n = 1; n <= 400; ++n) {
      frame(seeker.next(asked_N, seen));
      if (seen.settled && (seeker.slips() || seeker.reached(seen.force_N))) return n;
    }
    return 0;
  }
};

double tolerance(double asked_N) {
  return std::max(ForceSeeker::met * asked_N, ForceSeeker::least_N) * (1 + 1e-9);
}

TEST(ForceSeeker, MeetsSmallAndLargeForcesOnSoftAndStiffSprings) {
  for (const double k : {0.05, 0.3, 2.0, 20.0})
    for (const double asked : {0.005, 0.05, 0.2, 2.0, 15.0}) {
      if (asked > 100.0 * k) continue;
      // Stiffening, as a bar that sinks in.
      Springs liver{[k](double x) { return x > 0 ? k * x * (1 + 0.02 * x) : 0.0; }};
      ForceSeeker seeker;
      const int frames = liver.meet(seeker, asked);
      EXPECT_GT(frames, 0) << k << " N/mm, " << asked << " N: " << liver.seen.force_N;
      EXPECT_FALSE(seeker.slips());
      EXPECT_NEAR(liver.seen.force_N, asked, tolerance(asked)) << k << " N/mm";
      // And another one from there, smaller or larger.
      EXPECT_GT(liver.meet(seeker, 0.3 * asked), 0);
      EXPECT_NEAR(liver.seen.force_N, 0.3 * asked, tolerance(0.3 * asked)) << k << " N/mm";
      EXPECT_GT(liver.meet(seeker, 0.9 * asked), 0);
      EXPECT_NEAR(liver.seen.force_N, 0.9 * asked, tolerance(0.9 * asked)) << k << " N/mm";
    }
}

TEST(ForceSeeker, CrossesAGapBeforeTheFirstTouch) {
  Springs liver{[](double x) { return 0.4 * std::max(0.0, x - 25.0); }};
  ForceSeeker seeker;
  EXPECT_GT(liver.meet(seeker, 0.2), 0);
  EXPECT_FALSE(seeker.slips());
  EXPECT_NEAR(liver.seen.along_mm, 25.5, 0.01);
}

TEST(ForceSeeker, TellsASlipAndGoesBackToAForceThatIsBorne) {
  Springs liver{[](double x) { return x > 0 ? 3.0 * std::sin(std::numbers::pi * std::min(x, 58.0) / 60.0) : 0.0; }};
  ForceSeeker seeker;
  EXPECT_GT(liver.meet(seeker, 4.0), 0);
  EXPECT_TRUE(seeker.slips());
  EXPECT_GT(liver.seen.along_mm, 30.0);
  EXPECT_LT(liver.seen.along_mm, 60.0);
  EXPECT_GT(liver.meet(seeker, 2.0), 0);
  EXPECT_FALSE(seeker.slips());
  EXPECT_NEAR(liver.seen.force_N, 2.0, tolerance(2.0));
  EXPECT_LT(liver.seen.along_mm, 30.0) << "on the side on which the force rises";
}

/// A block on springs with a rigid bar under its front.
retraction::Setup blockSetup() {
  retraction::Setup s;
  s.kinematics = Kinematics::Hyperelastic;
  SupportSpec springs;
  springs.kind = SupportSpec::Kind::Spring;
  springs.region = SurfaceRegion{"all"};
  springs.stiffness_kPa_per_mm = 0.1;
  s.supports.push_back(springs);
  Retractor bar;
  bar.length_mm = 40.0;
  bar.contact = ContactKind::Rigid;
  bar.at_mm = Eigen::Vector3d(32.0, 64.0, 32.0);
  s.loads.emplace_back(bar);
  return s;
}

LiveLivers liversOf(const Setup& setup) {
  image::Grid g;
  g.size = {8, 8, 8};
  g.spacing_mm = {8.0, 8.0, 8.0};
  g.origin_lps_mm = {4.0, 4.0, 4.0};
  const Model stiff = makeModel(image::ScalarVolume(g, 12.0F), 0.45, defaults::liverDensity, false);
  const Model soft = makeModel(image::ScalarVolume(g, 6.0F), 0.45, defaults::liverDensity, false);
  return makeLive(stiff, &soft, setup, {{20.0, 20.0, 20.0}}, LiveKind::Contact);
}

TEST(LiveContact, ComesToRestUnderASmallForceAndUnderALargeOne) {
  for (const double force_N : {0.02, 0.2, 2.0, 4.0}) {
    retraction::Setup setup = blockSetup();
    std::get<Retractor>(setup.loads[0]).force_N = force_N;
    const LiveLivers livers = liversOf(setup);
    const LiveAnswers at = followScene(livers, 300);
    for (const LiveAnswer* one : {&at.mre, &at.atlas}) {
      EXPECT_TRUE(one->atRest) << force_N;
      EXPECT_EQ(one->outcome, LiveOutcome::Borne) << force_N;
      EXPECT_NEAR(-one->force_N.y(), force_N, tolerance(force_N));
    }
    EXPECT_GT(at.atlas.tool_mm.norm(), at.mre.tool_mm.norm());
  }
}

TEST(LiveContact, GoesByTheScenesTravelWhereItGivesOne) {
  retraction::Setup setup = blockSetup();
  std::get<Retractor>(setup.loads[0]).travel_mm = 7.0;
  const LiveLivers livers = liversOf(setup);
  const LiveAnswers at = followScene(livers, 300);
  for (const LiveAnswer* one : {&at.mre, &at.atlas}) {
    EXPECT_TRUE(one->atRest);
    EXPECT_LT((one->tool_mm - Eigen::Vector3d(0.0, -7.0, 0.0)).norm(), 2e-3);
  }
  EXPECT_GT(at.mre.force_N.norm(), 1.2 * at.atlas.force_N.norm());
}

TEST(LiveContact, SaysThatTheBarSlips) {
  retraction::Setup setup = blockSetup();
  // Over the softer block's edge, with more than that bears.
  std::get<Retractor>(setup.loads[0]).force_N = 4.0;
  std::get<Retractor>(setup.loads[0]).at_mm = Eigen::Vector3d(32.0, 64.0, 62.0);
  const LiveLivers livers = liversOf(setup);
  const LiveAnswers at = followScene(livers, 300);
  EXPECT_EQ(at.atlas.outcome, LiveOutcome::Slips);
  EXPECT_TRUE(at.atlas.atRest);
}

TEST(LiveContact, SaysThatTheBarCutsAndGoesBackWithASmallerForce) {
  retraction::Setup setup = blockSetup();
  std::get<Retractor>(setup.loads[0]).force_N = 8.0;  // in the middle of the softer block, more than its cells bear
  const LiveLivers livers = liversOf(setup);
  const LiveAnswers at = followScene(livers, 300);
  EXPECT_EQ(at.atlas.outcome, LiveOutcome::Cuts);
  EXPECT_TRUE(at.atlas.atRest);
  EXPECT_EQ(at.mre.outcome, LiveOutcome::Borne);
  LiveTarget less;
  less.force_N = 0.25 * livers.atlas->sceneForce_N();
  LiveAnswer after;
  for (int n = 0; n < 300 && !(after.atRest && n > 0); ++n) after = livers.atlas->follow(less);
  EXPECT_EQ(after.outcome, LiveOutcome::Borne);
  EXPECT_NEAR(-after.force_N.y(), 2.0, tolerance(2.0));
}

}  // namespace
}  // namespace glisson::retraction
