// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "tools/scene_camera.h"

namespace glisson::tools {
namespace {

const Eigen::Vector2d view(800.0, 600.0);

SceneCamera oblique() {
  SceneCamera c;
  c.focus_lps = {10.0, -20.0, 30.0};
  c.fromEye = Eigen::Vector3d(0.4, 0.8, -0.3).normalized();
  c.up = (Eigen::Vector3d::UnitZ() - c.fromEye.z() * c.fromEye).normalized();
  c.halfHeight_mm = 120.0;
  return c;
}

TEST(SceneCamera, PixelsAndPlacesAreInverse) {
  const SceneCamera c = oblique();
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(55, -3, 71), c.focus_lps})
    EXPECT_LT((c.toLps(c.toPixel(p, view), view, p) - p).norm(), 1e-9);
  EXPECT_LT((c.toPixel(c.focus_lps, view) - 0.5 * view).norm(), 1e-12);
  // Up is up, and a millimetre across the view is as long as one along it.
  EXPECT_LT(c.toPixel(c.focus_lps + 10.0 * c.up, view).y(), 300.0);
  EXPECT_GT(c.toPixel(c.focus_lps + 10.0 * c.right(), view).x(), 400.0);
  EXPECT_NEAR(c.toPixel(c.focus_lps + 10.0 * c.right(), view).x() - 400.0, 10.0 * 600.0 / 240.0, 1e-9);
}

TEST(SceneCamera, TurningKeepsTheFocusAndTheAxesUnitAndAcross) {
  SceneCamera c = oblique();
  for (int n = 0; n < 500; ++n) c.turn({7.0, -3.0}, view);
  EXPECT_NEAR(c.fromEye.norm(), 1.0, 1e-12);
  EXPECT_NEAR(c.up.norm(), 1.0, 1e-9);
  EXPECT_NEAR(c.up.dot(c.fromEye), 0.0, 1e-12);
  EXPECT_LT((c.toPixel(c.focus_lps, view) - 0.5 * view).norm(), 1e-9);
}

TEST(SceneCamera, WhatIsInFrontFollowsTheMouseThatTurns) {
  SceneCamera c = oblique();
  const Eigen::Vector3d front = c.focus_lps - 50.0 * c.fromEye;
  const Eigen::Vector2d before = c.toPixel(front, view);
  c.turn({20.0, 0.0}, view);
  EXPECT_GT(c.toPixel(front, view).x(), before.x() + 1.0);
  c = oblique();
  c.turn({0.0, 20.0}, view);
  EXPECT_GT(c.toPixel(front, view).y(), before.y() + 1.0);
}

TEST(SceneCamera, PanningAndZoomingHoldWhatIsUnderTheMouse) {
  SceneCamera c = oblique();
  const Eigen::Vector3d p = c.toLps({100.0, 450.0}, view, c.focus_lps);
  c.zoom(2.5, {100.0, 450.0}, view);
  EXPECT_LT((c.toPixel(p, view) - Eigen::Vector2d(100.0, 450.0)).norm(), 1e-9);
  EXPECT_NEAR(c.halfHeight_mm, 48.0, 1e-9);
  c.pan({13.0, -8.0}, view);
  EXPECT_LT((c.toPixel(p, view) - Eigen::Vector2d(113.0, 442.0)).norm(), 1e-9);
}

TEST(SceneCamera, AFittedBoxIsSeenWholeAndFillsTheView) {
  SceneCamera c = oblique();
  const Eigen::AlignedBox3d box(Eigen::Vector3d(-200, 10, 5), Eigen::Vector3d(40, 60, 300));
  c.fit(box, view);
  Eigen::Vector2d low = view, high = Eigen::Vector2d::Zero();
  for (int n = 0; n < 8; ++n) {
    const Eigen::Vector2d px = c.toPixel(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(n)), view);
    low = low.cwiseMin(px);
    high = high.cwiseMax(px);
  }
  EXPECT_GE(low.minCoeff(), 0.0);
  EXPECT_LE(high.x(), 800.0);
  EXPECT_LE(high.y(), 600.0);
  EXPECT_GT(std::max((high - low).x() / 800.0, (high - low).y() / 600.0), 0.85);
}

TEST(FirstHit, IsTheNearerOfTwoWallsAndNothingBeside) {
  anatomy::TriangleMesh walls;
  walls.vertices_lps_mm.resize(3, 6);
  walls.vertices_lps_mm << 0, 10, 0, 0, 10, 0, 5, 5, 5, 9, 9, 9, 0, 0, 10, 0, 0, 10;
  walls.triangles.resize(3, 2);
  walls.triangles << 0, 3, 1, 4, 2, 5;
  const auto hit = firstHit(walls, {2.0, -50.0, 2.0}, Eigen::Vector3d::UnitY());
  ASSERT_TRUE(hit.has_value());
  EXPECT_LT((*hit - Eigen::Vector3d(2.0, 5.0, 2.0)).norm(), 1e-9);
  const auto behind = firstHit(walls, {2.0, 50.0, 2.0}, -Eigen::Vector3d::UnitY());
  ASSERT_TRUE(behind.has_value());
  EXPECT_LT((*behind - Eigen::Vector3d(2.0, 9.0, 2.0)).norm(), 1e-9);
  EXPECT_FALSE(firstHit(walls, {8.0, -50.0, 8.0}, Eigen::Vector3d::UnitY()).has_value());
  EXPECT_FALSE(firstHit(walls, {2.0, 50.0, 2.0}, Eigen::Vector3d::UnitY()).has_value());
}

}  // namespace
}  // namespace glisson::tools
