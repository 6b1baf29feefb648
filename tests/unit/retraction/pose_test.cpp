// SPDX-License-Identifier: GPL-3.0-or-later
#include "retraction/pose.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "../anatomy/lattices.h"
#include "base/error.h"
#include "base/parallel.h"
#include "image/io.h"
#include "phantom/detail/torso.h"
#include "phantom/liver_shape.h"
#include "retraction/hoist_view.h"
#include "support/messages.h"
#include "support/support.h"

namespace glisson::retraction {
namespace {

using anatomy::test::lattices;
using anatomy::test::maskOf;
using Eigen::Vector3d;
using test::messageOf;
using testing::HasSubstr;

double ellipsoid(const Vector3d& p, const Vector3d& centre, const Vector3d& radii) {
  return (p - centre).cwiseQuotient(radii).norm();
}

/// A right lobe 180 mm high whose back is an elliptic cylinder with rounded ends, and a left lobe above and before it.
bool simpleLiver(const Vector3d& p) {
  const Vector3d lobe(-60, 0, 0);
  const double z = std::max(0.0, std::abs(p.z()) - 50.0) / 40.0;
  const Vector3d q((p.x() - lobe.x()) / 62.0, p.y() / 52.0, z);
  return q.norm() <= 1.0 || ellipsoid(p, {30, -15, 45}, {90, 30, 35}) <= 1.0;
}

struct Scene {
  SmoothBody body;
  mechanics::TriangleSurface surface;
  explicit Scene(const image::Mask& mask) : body(mask), surface(body.surface()) {}
};

image::Grid upright(double spacing_mm = 2.0) {
  return lattices({0, 0, 0}, 130.0, Vector3d::Constant(spacing_mm))[0].grid;
}

/// Smallest distance of the surface's vertices to the axis of the bar (a capsule, ends included in its length).
double clearance_mm(const mechanics::TriangleSurface& surface, const Pose& pose, const Retractor& bar) {
  const Vector3d half = (0.5 * bar.length_mm - 0.5 * bar.diameter_mm) * pose.axis;
  double least = std::numeric_limits<double>::infinity();
  for (const Vector3d& v : surface.vertices)
    least = std::min(least, anatomy::test::distanceToSegment(v, pose.centre_mm - half, pose.centre_mm + half));
  return least;
}

TEST(HoistFrame, IsRightAngledAndPointsToTheHeadAndTheLeft) {
  for (const Vector3d& d : {Vector3d(0, -1, 0), Vector3d(0, -0.77, 0.64), Vector3d(0.3, -1, 0.1), Vector3d(0, 0, 1)}) {
    const HoistFrame f(d);
    EXPECT_NEAR(f.hoist.dot(f.up), 0.0, 1e-12);
    EXPECT_NEAR(f.hoist.dot(f.aside), 0.0, 1e-12);
    EXPECT_NEAR(f.up.dot(f.aside), 0.0, 1e-12);
    EXPECT_NEAR((f.aside - Vector3d(1, 0, 0)).norm(), 0.0, 0.4);
  }
  EXPECT_NEAR((HoistFrame({0, -1, 0}).up - Vector3d(0, 0, 1)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((HoistFrame({0, 0, 1}).up - Vector3d(0, -1, 0)).norm(), 0.0, 1e-12);
}

TEST(HoistView, SeesThicknessCoverAndSlopeOfAWedge) {
  // A block 100 x (60 to 110) x 100 mm whose back rises by a half towards the left, hollow from z = 20 on.
  const image::Mask wedge = maskOf(upright(), [](const Vector3d& p) {
    return std::abs(p.x()) <= 50 && std::abs(p.z()) <= 50 && p.y() >= -60 && p.y() <= 25 + 0.5 * p.x() &&
           !(p.z() > 20 && p.y() > -45 && p.y() < -30);
  });
  const Scene s(wedge);
  for (const Vector3d& direction : {Vector3d(0, -1, 0), Vector3d(0, -1, 1e-3)}) {
    const HoistView view(s.surface, HoistFrame(direction));
    const BarView low = view.bar({0, -10}, 0.0, 80.0, 10.0);
    EXPECT_NEAR(low.covered_mm, 80.0, 1e-9);
    EXPECT_NEAR(low.thickness_mm, 85.0, 2.0);
    EXPECT_NEAR(low.slope, -0.5, 0.01);  // further back is less deep along the hoist
    EXPECT_NEAR(low.tilt, 0.0, 0.02);
    EXPECT_NEAR(view.bar({0, 35}, 0.0, 80.0, 10.0).thickness_mm, 55.0, 2.0);  // as far as the hollow
    EXPECT_NEAR(view.bar({30, -10}, 0.0, 80.0, 10.0).covered_mm, 60.0, 2.0);
    EXPECT_NEAR(view.bar({0, -10}, std::numbers::pi / 2, 80.0, 10.0).slope, 0.0, 0.02);
    EXPECT_EQ(view.bar({200, 0}, 0.0, 80.0, 10.0).covered_mm, 0.0);
  }
}

TEST(Pose, OfASimpleLiverIsWhereItsBackIsLevel) {
  const Scene s(maskOf(upright(), simpleLiver));
  const Retractor bar;
  const std::vector<Pose> poses = poseCandidates(s.body, s.surface, bar);
  const Pose& first = poses.front();
  EXPECT_TRUE(first.wanted);
  EXPECT_NEAR(first.height_mm, 70.0, 1.0);
  // Level above the middle of the lobe; the bar's axis is its radius behind the back of the lobe.
  EXPECT_NEAR(first.centre_mm.x(), -60.0, 4.0);
  EXPECT_NEAR(first.centre_mm.y(), 52.0 + 5.0, 1.0);
  EXPECT_NEAR(first.slope, 0.0, 0.05);
  EXPECT_NEAR(first.covered_mm, 80.0, 1.0);
  // Mean chord of the ellipse over the middle 80 of its 124 mm.
  const double u = 40.0 / 62.0, chord = 104.0 * 0.5 * (std::sqrt(1 - u * u) + std::asin(u) / u);
  EXPECT_NEAR(first.thickness_mm, chord, 2.0);
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    EXPECT_GE(poses[i].wanted, poses[i + 1].wanted);
    if (poses[i + 1].wanted) {
      EXPECT_LT(poses[i].height_mm, poses[i + 1].height_mm);
    }
  }
}

TEST(Pose, DoesNotDependOnHowTheMaskIsStored) {
  const Retractor bar;
  const Vector3d expected = [&] {
    const Scene s(maskOf(upright(), simpleLiver));
    return poseCandidates(s.body, s.surface, bar).front().centre_mm;
  }();
  for (const Vector3d& spacing : {Vector3d(1.7, 1.7, 1.7), Vector3d(1.6, 1.6, 5.0)})
    for (const auto& [name, grid] : lattices({0, 0, 0}, 150.0, spacing)) {
      if (name == "mirrored" || name == "oblique") continue;  // both at once is tried
      const Scene s(maskOf(grid, simpleLiver));
      const Vector3d centre = poseCandidates(s.body, s.surface, bar).front().centre_mm;
      EXPECT_LT((centre - expected).norm(), 2.5) << name << spacing.z() << ": " << centre.transpose();
    }
}

TEST(Pose, TouchesWithoutPiercingAndLiesAcrossTheHoist) {
  const Scene s(maskOf(upright(), simpleLiver));
  for (const Vector3d& direction : {Vector3d(0, -1, 0), Vector3d(0, -0.77, 0.64), Vector3d(-0.2, -0.9, 0.1)}) {
    Retractor bar;
    bar.direction = direction;
    for (const Pose& pose : poseCandidates(s.body, s.surface, bar)) {
      EXPECT_NEAR(pose.axis.norm(), 1.0, 1e-12);
      EXPECT_NEAR(pose.axis.dot(direction.normalized()), 0.0, 1e-12);
      EXPECT_NEAR(pose.hoist.dot(direction.normalized()), 1.0, 1e-12);
      EXPECT_NEAR(clearance_mm(s.surface, pose, bar), 5.0, 1e-6);
    }
  }
}

TEST(Pose, IsTurnedWhereOnlyATurnedBarIsLevelUnlessTheSceneGivesItsAxis) {
  // The back of this lobe is a ridge that falls away on both sides of a line 25 degrees off right to left.
  const double turn = 25.0 * std::numbers::pi / 180.0;
  const Scene s(maskOf(upright(), [&](const Vector3d& p) {
    const double across = -std::sin(turn) * (p.x() + 30.0) + std::cos(turn) * p.z();
    return p.x() >= -95 && p.x() <= 60 && std::abs(p.z()) <= 90 && p.y() >= -60 && p.y() <= 50 - 0.55 * across;
  }));
  Retractor bar;
  const Pose free = poseCandidates(s.body, s.surface, bar).front();
  EXPECT_TRUE(free.wanted);
  EXPECT_NEAR(std::atan2(free.axis.z(), free.axis.x()), turn, 6.0 * std::numbers::pi / 180.0);
  bar.axis = Vector3d(1, 0.4, 0);  // across the hoist: x
  for (const Pose& pose : poseCandidates(s.body, s.surface, bar)) {
    EXPECT_NEAR((pose.axis - Vector3d(1, 0, 0)).norm(), 0.0, 1e-12);
    EXPECT_FALSE(pose.wanted);
  }
}

TEST(Pose, SaysWithFiguresWhereThereIsNoPlace) {
  const Scene sheet(maskOf(upright(), [](const Vector3d& p) {
    return p.x() >= -100 && p.x() <= 60 && std::abs(p.z()) <= 80 && std::abs(p.y()) <= 8;
  }));
  const std::string text = messageOf([&] { poseCandidates(sheet.body, sheet.surface, Retractor{}); });
  EXPECT_THAT(text, HasSubstr("no place for the retractor"));
  EXPECT_THAT(text, HasSubstr("covers 80 mm, with 16 mm of liver"));
  EXPECT_THAT(text, HasSubstr("\"at\""));
}

image::Mask phantomLiver(std::uint64_t seed, phantom::LiverShape shape) {
  const phantom::Torso torso(seed, shape);
  image::Grid g;
  g.spacing_mm = Vector3d(4, 4, 4);
  g.origin_lps_mm = Vector3d(-168, -114, torso.liverBottom_mm() - 4.0);
  g.size = Eigen::Vector3i(78, 58, static_cast<int>((torso.liverTop_mm() - torso.liverBottom_mm()) / 4.0) + 3);
  image::Mask m(g);
  parallelChunks(static_cast<std::size_t>(g.size.z()), 1, [&](std::size_t begin, std::size_t end) {
    for (int k = static_cast<int>(begin); k < static_cast<int>(end); ++k)
      for (int j = 0; j < g.size.y(); ++j)
        for (int i = 0; i < g.size.x(); ++i) {
          const Vector3d p = g.indexToLps(Vector3d(i, j, k));
          m.at(i, j, k) = torso.body_mm(p) < 0.0 && torso.liver_mm(p) < 0.0 ? 1 : 0;
        }
  });
  return m;
}

TEST(Pose, LiversOfEveryShapeGetAPlaceOnTheRightLobe) {
  for (const auto& [shape, name] : phantom::liverShapes) {
    SCOPED_TRACE(std::string(name));
    const Scene s(phantomLiver(77, shape));
    const Retractor bar;
    const PoseRule rule = poseRule(s.body, bar);
    const Pose first = poseCandidates(s.body, s.surface, bar).front();
    EXPECT_TRUE(first.wanted);
    EXPECT_GE(first.covered_mm, 60.0);
    EXPECT_GE(first.thickness_mm, rule.thickness_mm);
    EXPECT_LE(std::abs(first.slope), 0.1);
    EXPECT_LT(first.centre_mm.x(), -40.0);
    EXPECT_GE(first.height_mm, rule.lowest_mm);
    EXPECT_NEAR(clearance_mm(s.surface, first, bar), 5.0, 1e-6);
  }
}

TEST(Pose, RealLiversGetAPlace) {
  GLISSON_NEEDS_DATA("liver_mr_ct_volumes");
  for (const char* file : {"example_seg.nii.gz", "example_seg_fast_force_split.nii.gz", "example_seg_mr.nii.gz"}) {
    SCOPED_TRACE(file);
    const Scene s(image::readMask(test::sharedData() / "liver_mr_ct_volumes" / file, 5));
    const Retractor bar;
    const Pose first = poseCandidates(s.body, s.surface, bar).front();
    EXPECT_TRUE(first.wanted);
    EXPECT_LE(std::abs(first.slope), 0.1);
    EXPECT_GE(first.covered_mm, 60.0);
  }
}

const Vector3d ballCentre(-20, 10, 30);
Scene ball() {
  return Scene(maskOf(upright(), [](const Vector3d& p) { return (p - ballCentre).norm() <= 60.0; }));
}

TEST(PoseAt, TheBarTouchesABallWhereItMust) {
  const Scene s = ball();
  Retractor bar;
  bar.axis = Vector3d(1, 0, 0);
  for (const double up : {0.0, 20.0, -35.0}) {
    // On the ball's back; the point may lie off it by up to the bar's diameter and 5 mm.
    const double back = std::sqrt(60.0 * 60 - up * up);
    for (const double off : {-12.0, 0.0, 12.0}) {
      const Pose pose = poseAt(s.surface, bar, ballCentre + Vector3d(15, back + off, up));
      EXPECT_NEAR(pose.centre_mm.x(), ballCentre.x() + 15.0, 1e-9);
      EXPECT_NEAR(pose.centre_mm.z(), ballCentre.z() + up, 1e-9);
      EXPECT_NEAR(pose.centre_mm.y(), ballCentre.y() + std::sqrt(65.0 * 65 - up * up), 0.8);
      EXPECT_NEAR(clearance_mm(s.surface, pose, bar), 5.0, 1e-6);
      EXPECT_NEAR(pose.height_mm, 60.0 + up, 1.0);
    }
  }
}

TEST(PoseAt, RefusesAPointAwayFromTheBack) {
  const Scene s = ball();
  const Retractor bar;
  for (const Vector3d& away : {Vector3d(0, 80, 0), Vector3d(0, -60, 0), Vector3d(0, 0, 0), Vector3d(120, 0, 0)})
    EXPECT_THAT(messageOf([&] { poseAt(s.surface, bar, ballCentre + away); }), HasSubstr("no contact"));
}

TEST(PoseAt, TakesTheAxisOfTheSceneAcrossTheHoistElseTheLevelOne) {
  const Scene s = ball();
  Retractor bar;
  bar.axis = Vector3d(1, 1, 1);
  const Vector3d back = ballCentre + Vector3d(0, 60, 0);
  EXPECT_NEAR((poseAt(s.surface, bar, back).axis - Vector3d(1, 0, 1).normalized()).norm(), 0.0, 1e-12);
  bar.axis.reset();
  EXPECT_NEAR((poseAt(s.surface, bar, back).axis - Vector3d(1, 0, 0)).norm(), 0.0, 1e-12);
  // Off to the side and upwards by as much, the surface falls away to both: level is half-way between, 30° at most.
  const Vector3d beside = ballCentre + Vector3d(25, std::sqrt(60.0 * 60 - 2 * 25 * 25), 25);
  const Vector3d axis = poseAt(s.surface, bar, beside).axis;
  EXPECT_NEAR(std::atan2(axis.z(), axis.x()), -std::numbers::pi / 6.0, 1e-9);
  const Vector3d little = ballCentre + Vector3d(8, std::sqrt(60.0 * 60 - 8 * 8 - 30 * 30), 30);
  const Vector3d turned = poseAt(s.surface, bar, little).axis;
  EXPECT_NEAR(std::atan2(turned.z(), turned.x()), -std::atan(8.0 / 30.0), 0.12);
}

}  // namespace
}  // namespace glisson::retraction
