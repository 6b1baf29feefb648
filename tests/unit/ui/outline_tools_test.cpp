// SPDX-License-Identifier: GPL-3.0-or-later

// Tools whose outlines are more than clicked polygons: ellipse, spline, livewire.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/random.h"
#include "outline_bench.h"
#include "tools/shapes.h"

namespace glisson::tools {
namespace {

using roi::PolygonState;
using test::area_mm2;
using test::flat;
using test::mode;
using test::ToolBench;
constexpr Modifiers shift{.shift = true, .ctrl = false};
constexpr double pi = std::numbers::pi;

TEST(EllipseTool, ADragEndsAsADraftPolygonWithTheAreaOfTheEllipse) {
  ToolBench b;
  mode(b, ToolMode::Ellipse);
  b.press(100, 120);
  b.move(200, 200);
  ASSERT_EQ(b.tool.shape().size(), 1u);
  EXPECT_TRUE(b.contours.polygons.empty());
  b.move(300, 220);
  b.release(300, 220);
  ASSERT_EQ(b.contours.polygons.size(), 1u);
  EXPECT_TRUE(b.tool.shape().empty());
  EXPECT_EQ(b.contours.polygons[0].state, PolygonState::Draft);
  EXPECT_EQ(b.tool.state(), ToolState::Editing);
  EXPECT_EQ(b.undo.size(), 1u);
  EXPECT_NEAR(area_mm2(b, 0), pi * 25.0 * 12.5, 1e-9);  // 200 × 100 px, 4 px per mm
  b.key(ToolKey::Enter);
  EXPECT_EQ(b.tool.state(), ToolState::Accepted);
}

TEST(EllipseTool, ShiftMakesACircleFromTheFirstCornerOn) {
  ToolBench b;
  mode(b, ToolMode::Ellipse);
  b.drag(300, 300, 180, 260, shift);
  ASSERT_EQ(b.contours.polygons.size(), 1u);
  const Outline ring = flat(b, b.contours.polygons[0].points_lps_mm);
  const Eigen::Vector2d centre = b.plane.toPlane_mm(b.plane.toLps({240, 240}));
  for (const auto p : ring.colwise()) EXPECT_NEAR((p - centre).norm(), 15.0, 0.15);
  EXPECT_NEAR(area_mm2(b, 0), pi * 225.0, 1e-9);
}

TEST(EllipseTool, ClicksSelectDragsOnTheSelectedOneMoveItAndEscapeCallsADragOff) {
  ToolBench b;
  mode(b, ToolMode::Ellipse);
  b.click(50, 50);
  EXPECT_EQ(b.tool.state(), ToolState::Idle) << "a click begins no polygon";
  b.drag(100, 100, 200, 200);
  const Eigen::Vector3d before = b.contours.polygons[0].points_lps_mm.rowwise().mean();
  b.drag(150, 150, 190, 150);
  ASSERT_EQ(b.contours.polygons.size(), 1u);
  const Eigen::Vector3d after = b.contours.polygons[0].points_lps_mm.rowwise().mean();
  EXPECT_NEAR((after - before).norm(), 10.0, 1e-9);
  b.press(300, 100);
  b.move(380, 180);
  b.key(ToolKey::Escape);
  b.release(380, 180);
  EXPECT_EQ(b.contours.polygons.size(), 1u);
  EXPECT_TRUE(b.tool.shape().empty());
  // Another one beside it is another outline, and what holds no four voxels is refused.
  b.drag(300, 100, 380, 180);
  EXPECT_EQ(b.contours.polygons.size(), 2u);
  b.drag(20, 300, 26, 305);
  EXPECT_EQ(b.contours.polygons.size(), 2u);
  EXPECT_FALSE(b.tool.message().empty());
  b.click(150, 150);
  EXPECT_EQ(b.tool.selected(), std::optional<std::size_t>(0));
}

TEST(Shapes, PolygonsStayWithinTheirTolerance) {
  const Outline ring = ellipse({0, 0}, {100, 40}, false, 0.1);
  for (Eigen::Index v = 0; v < ring.cols(); ++v)
    for (const double t : {0.0, 0.5}) {
      const Eigen::Vector2d p = (1.0 - t) * ring.col(v) + t * ring.col((v + 1) % ring.cols()) - Eigen::Vector2d(50, 20);
      const double r = std::hypot(p.x() / 50.0, p.y() / 20.0);
      EXPECT_LT(std::abs(r - 1.0) * p.norm() / r, 0.1);
    }
  EXPECT_EQ(ellipse({0, 0}, {50, 0}, false, 0.1).cols(), 0);
  Outline corners(2, 12);
  for (Eigen::Index v = 0; v < 12; ++v)
    corners.col(v) = 40.0 * Eigen::Vector2d(std::cos(2.0 * pi * static_cast<double>(v) / 12.0),
                                            std::sin(2.0 * pi * static_cast<double>(v) / 12.0));
  const Outline round = closedSpline(corners, 0.05);
  for (const auto p : round.colwise()) EXPECT_NEAR(p.norm(), 40.0, 0.3);
  EXPECT_NEAR(signedArea(round), pi * 1600.0, 0.01 * pi * 1600.0);
  EXPECT_FALSE(crossesItself(round, true));
  Outline repeated(2, 13);
  repeated << corners, corners.rightCols(1);
  EXPECT_EQ(closedSpline(repeated, 0.05), round);
}

TEST(SplineTool, TheClosedCurveRunsThroughEveryClickAndUndoTakesClicks) {
  ToolBench b;
  mode(b, ToolMode::Spline);
  for (const auto& [x, y] : {std::pair{200, 100}, {300, 200}, {310, 210}, {200, 300}, {100, 200}}) b.click(x, y);
  EXPECT_EQ(b.tool.drawing().cols(), 5);
  EXPECT_GT(b.tool.curve().cols(), 20);
  ASSERT_TRUE(b.tool.undoDrawing(b.plane));
  EXPECT_EQ(b.tool.drawing().cols(), 4);
  ASSERT_TRUE(b.tool.redoDrawing(b.plane));
  b.key(ToolKey::Backspace);
  EXPECT_EQ(b.tool.drawing().cols(), 4);
  b.click(100, 200);
  const Eigen::Matrix3Xd clicked = b.tool.drawing();
  b.drag(202, 101, 203, 102);  // on the first vertex: closes
  ASSERT_EQ(b.contours.polygons.size(), 1u);
  EXPECT_EQ(b.tool.state(), ToolState::Editing);
  EXPECT_EQ(b.tool.curve().cols(), 0);
  for (const auto p : clicked.colwise()) {
    double nearest = 1e9;
    for (const auto v : b.contours.polygons[0].points_lps_mm.colwise()) nearest = std::min(nearest, (v - p).norm());
    EXPECT_LT(nearest, 1e-9);
  }
}

TEST(SplineTool, LeavingTheSliceParksTheCurveAndTwoClicksAreNoOutline) {
  ToolBench b;
  mode(b, ToolMode::Spline);
  for (const auto& [x, y] : {std::pair{200, 100}, {300, 200}}) b.click(x, y);
  b.key(ToolKey::Enter);
  EXPECT_TRUE(b.contours.polygons.empty());
  EXPECT_FALSE(b.tool.message().empty());
  b.click(200, 300);
  b.click(100, 200);
  b.apply(b.tool.leaveSlice(b.plane));
  ASSERT_EQ(b.contours.polygons.size(), 1u);
  EXPECT_EQ(b.contours.polygons[0].state, PolygonState::Draft);
  EXPECT_GT(b.contours.polygons[0].points_lps_mm.cols(), 12);
}

TEST(LivewireTool, FourClicksOnADiscGiveTheDisc) {
  ToolBench b;
  // In pixels of the view, so that the disc is round there though voxels are not square.
  const Eigen::Vector2d middle(260, 240);
  auto image = std::make_shared<image::ScalarVolume>(b.plane.grid);
  Random random(5);
  for (int j = 0; j < 60; ++j)
    for (int i = 0; i < 80; ++i) {
      const double off_px = (b.plane.toPixel(b.plane.grid.indexToLps({1.0 * i, 1.0 * j, 2.0})) - middle).norm();
      const double in = std::clamp((140.0 - off_px) / 7.0 + 0.5, 0.0, 1.0);
      image->at(i, j, 2) = static_cast<float>(50.0 + 100.0 * in + 5.0 * random.normal());
    }
  b.tool.setImage(image);
  mode(b, ToolMode::Livewire);
  b.click(400, 240);
  b.move(260, 380);
  EXPECT_GT(b.tool.curve().cols(), 8) << "the line to the mouse follows the edge";
  b.click(260, 380);
  b.click(120, 240);
  b.click(260, 100);
  EXPECT_EQ(b.tool.drawing().cols(), 4);
  b.click(401, 241);
  ASSERT_EQ(b.contours.polygons.size(), 1u);
  const Outline ring = flat(b, b.contours.polygons[0].points_lps_mm);
  EXPECT_FALSE(crossesItself(ring, true));
  EXPECT_NEAR(area_mm2(b, 0), pi * 35.0 * 35.0, 0.025 * pi * 35.0 * 35.0);
  for (const auto p : b.contours.polygons[0].points_lps_mm.colwise())
    EXPECT_LT(std::abs((b.plane.toPixel(p) - middle).norm() - 140.0), 6.0);
}

TEST(LivewireTool, WithoutAnImageItIsAPolygon) {
  ToolBench b;
  mode(b, ToolMode::Livewire);
  b.square(100, 100, 100);
  ASSERT_EQ(b.contours.polygons.size(), 1u);
  EXPECT_EQ(b.contours.polygons[0].points_lps_mm.cols(), 4);
  // A drag is a click where it is let go.
  b.tool.deselect();
  b.drag(300, 300, 350, 300);
  ASSERT_EQ(b.tool.drawing().cols(), 1);
  EXPECT_NEAR((b.plane.toPixel(b.tool.drawing().col(0)) - Eigen::Vector2d(350, 300)).norm(), 0.0, 1e-9);
}

}  // namespace
}  // namespace glisson::tools
