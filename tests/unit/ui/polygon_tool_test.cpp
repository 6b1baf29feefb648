// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tool_bench.h"
#include "tools/outline.h"

namespace glisson::tools {
namespace {

using test::ToolBench;

TEST(PolygonTool, ClicksAddVerticesAndTheFirstVertexCloses) {
  ToolBench b;
  EXPECT_EQ(b.tool.state(), ToolState::Idle);
  b.click(100, 100);
  b.click(200, 100);
  b.click(200, 180);
  EXPECT_EQ(b.tool.state(), ToolState::Drawing);
  b.move(106, 106);  // 8.5 px from the first vertex
  EXPECT_TRUE(b.tool.closes());
  b.click(106, 106);
  EXPECT_EQ(b.tool.state(), ToolState::Editing);
  ASSERT_EQ(b.contours.polygons.size(), 1u);
  EXPECT_EQ(b.contours.polygons[0].points_lps_mm.cols(), 3);
  EXPECT_EQ(b.contours.polygons[0].state, roi::PolygonState::Draft);
  b.key(ToolKey::Enter);
  EXPECT_EQ(b.tool.state(), ToolState::Accepted);
  EXPECT_EQ(b.contours.polygons[0].state, roi::PolygonState::Accepted);
}

TEST(PolygonTool, VerticesLieExactlyInThePlaneOfTheSlice) {
  ToolBench b;
  b.square(60, 60, 100);
  for (const Eigen::Vector3d p : b.contours.polygons.at(0).points_lps_mm.colwise())
    EXPECT_NEAR(b.plane.grid.lpsToIndex(p).z(), 2.0, 1e-12);
  EXPECT_NEAR((b.plane.toPixel(b.contours.polygons[0].points_lps_mm.col(0)) - Eigen::Vector2d(60, 60)).norm(), 0.0,
              1e-9);
}

TEST(PolygonTool, ElevenPixelsFromTheFirstVertexIsAnotherVertex) {
  ToolBench b;
  b.click(100, 100);
  b.click(200, 100);
  b.click(200, 180);
  b.click(111, 100);
  EXPECT_EQ(b.tool.state(), ToolState::Drawing);
  EXPECT_EQ(b.tool.drawing().cols(), 4);
}

TEST(PolygonTool, TwoVerticesNeverClose) {
  ToolBench b;
  b.click(100, 100);
  b.click(105, 100);
  EXPECT_FALSE(b.tool.closes());
  b.key(ToolKey::Enter);
  EXPECT_EQ(b.tool.state(), ToolState::Drawing);
  EXPECT_NE(b.tool.message().english().find("three"), std::string::npos);
  EXPECT_TRUE(b.contours.polygons.empty());
}

TEST(PolygonTool, RightClickEnterAndDoubleClickClose) {
  for (int way = 0; way < 3; ++way) {
    ToolBench b;
    b.click(100, 100);
    b.click(200, 100);
    b.click(200, 180);
    if (way == 0) b.apply(b.tool.rightClick(ToolBench::at(150, 150), b.plane));
    if (way == 1) b.key(ToolKey::Enter);
    if (way == 2) b.apply(b.tool.doubleClick(ToolBench::at(200, 180), b.plane));
    EXPECT_EQ(b.tool.state(), ToolState::Editing) << way;
    EXPECT_EQ(b.contours.polygons.size(), 1u) << way;
  }
}

TEST(PolygonTool, CtrlEnterClosesAndAcceptsAtOnce) {
  ToolBench b;
  b.click(100, 100);
  b.click(200, 100);
  b.click(200, 180);
  b.key(ToolKey::CtrlEnter);
  EXPECT_EQ(b.tool.state(), ToolState::Accepted);
  EXPECT_EQ(b.undo.size(), 1u);
}

TEST(PolygonTool, BackspaceTakesTheLastVertexAndUndoBringsItBack) {
  ToolBench b;
  b.click(100, 100);
  b.click(200, 100);
  b.click(200, 180);
  b.key(ToolKey::Backspace);
  EXPECT_EQ(b.tool.drawing().cols(), 2);
  EXPECT_TRUE(b.tool.undoDrawing(b.plane));
  EXPECT_EQ(b.tool.drawing().cols(), 3);
  EXPECT_TRUE(b.tool.undoDrawing(b.plane));
  EXPECT_EQ(b.tool.drawing().cols(), 2);
  EXPECT_TRUE(b.tool.redoDrawing(b.plane));
  EXPECT_EQ(b.tool.drawing().cols(), 3);
}

TEST(PolygonTool, EscapeParksAsDraftAndAgainDiscardsUndoably) {
  ToolBench b;
  b.click(100, 100);
  b.click(200, 100);
  b.click(200, 180);
  b.key(ToolKey::Escape);
  ASSERT_EQ(b.contours.polygons.size(), 1u);
  EXPECT_EQ(b.contours.polygons[0].state, roi::PolygonState::Draft);
  b.key(ToolKey::Escape);
  EXPECT_TRUE(b.contours.polygons.empty());
  EXPECT_EQ(b.tool.state(), ToolState::Idle);
  b.undo.undo(b.contours);
  EXPECT_EQ(b.contours.polygons.size(), 1u);
}

TEST(PolygonTool, LeavingTheSliceParksTheOutline) {
  ToolBench b;
  b.click(100, 100);
  b.click(200, 100);
  b.apply(b.tool.leaveSlice(b.plane));
  ASSERT_EQ(b.contours.polygons.size(), 1u);
  EXPECT_EQ(b.contours.polygons[0].state, roi::PolygonState::Draft);
  EXPECT_EQ(b.tool.state(), ToolState::Idle);
}

TEST(PolygonTool, ADraftIsTakenUpWhereItWasLeft) {
  ToolBench b;
  b.click(100, 100);
  b.click(200, 100);
  b.click(200, 180);
  b.key(ToolKey::Escape);
  b.key(ToolKey::Backspace);
  EXPECT_EQ(b.tool.state(), ToolState::Drawing);
  EXPECT_EQ(b.tool.drawing().cols(), 3);
  EXPECT_TRUE(b.contours.polygons.empty());
}

TEST(PolygonTool, AClickMayShakeByTwoPixels) {
  ToolBench b;
  b.press(100, 100);
  b.move(102, 100);
  b.release(102, 100);
  EXPECT_EQ(b.tool.drawing().cols(), 1);
}

TEST(PolygonTool, FreehandCircleClosesOnItsStartAndKeepsItsShape) {
  ToolBench b;
  const double r = 90.0;
  b.press(150 + r, 150);
  for (int s = 1; s <= 200; ++s) {
    const double a = 2.0 * std::numbers::pi * s / 200.0;
    b.move(150 + r * std::cos(a), 150 + r * std::sin(a));
  }
  b.release(150 + r, 150);
  ASSERT_EQ(b.contours.polygons.size(), 1u);
  EXPECT_EQ(b.tool.state(), ToolState::Editing);
  const auto& points = b.contours.polygons[0].points_lps_mm;
  // Sampled every 8 px the circle has 70 points; simplifying to a quarter pixel spacing (1.5 px) leaves far fewer.
  EXPECT_LT(points.cols(), 40);
  Outline px(2, points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i) px.col(i) = b.plane.toPixel(points.col(i));
  EXPECT_NEAR(std::abs(signedArea(px)) / (std::numbers::pi * r * r), 1.0, 0.04);
  for (Eigen::Index i = 0; i < points.cols(); ++i) EXPECT_NEAR((px.col(i) - Eigen::Vector2d(150, 150)).norm(), r, 0.2);
}

TEST(PolygonTool, FreehandMixesWithClicks) {
  ToolBench b;
  b.click(100, 100);
  b.drag(150, 100, 250, 100);
  EXPECT_EQ(b.tool.state(), ToolState::Drawing);
  b.click(250, 200);
  b.key(ToolKey::Enter);
  ASSERT_EQ(b.contours.polygons.size(), 1u);
}

TEST(PolygonTool, AVertexWinsOverAnEdgeWithinSixPixels) {
  ToolBench b;
  b.square(100, 100, 100);
  b.key(ToolKey::Enter);
  b.move(105, 100);
  ASSERT_TRUE(b.tool.hover());
  EXPECT_EQ(b.tool.hover()->kind, Hit::Kind::Vertex);
  b.move(150, 105.5);
  EXPECT_EQ(b.tool.hover()->kind, Hit::Kind::Edge);
  EXPECT_EQ(b.tool.hover()->vertex, 0);
  b.move(150, 107);
  EXPECT_EQ(b.tool.hover()->kind, Hit::Kind::Inside);
  b.move(150, 93);
  EXPECT_FALSE(b.tool.hover());
}

TEST(PolygonTool, DraggingAVertexOfAnAcceptedPolygonMovesItAlone) {
  ToolBench b;
  b.square(100, 100, 100);
  b.key(ToolKey::Enter);
  b.click(400, 40);  // empty: clears
  EXPECT_EQ(b.tool.state(), ToolState::Idle);
  const Eigen::Matrix3Xd before = b.contours.polygons[0].points_lps_mm;
  b.drag(200, 100, 220, 85);
  const Eigen::Matrix3Xd after = b.contours.polygons[0].points_lps_mm;
  EXPECT_EQ(b.tool.state(), ToolState::Accepted);
  EXPECT_EQ(before.col(0), after.col(0));
  EXPECT_EQ(before.col(2), after.col(2));
  EXPECT_EQ(before.col(3), after.col(3));
  EXPECT_NEAR((b.plane.toPixel(after.col(1)) - Eigen::Vector2d(220, 85)).norm(), 0.0, 1e-9);
}

TEST(PolygonTool, DraggingTheInsideOfTheSelectedPolygonMovesAllOfIt) {
  ToolBench b;
  b.square(100, 100, 100);
  const Eigen::Matrix3Xd before = b.contours.polygons[0].points_lps_mm;
  b.drag(150, 150, 170, 160);
  const Eigen::Matrix3Xd moved = b.contours.polygons[0].points_lps_mm - before;
  for (Eigen::Index i = 1; i < 4; ++i) EXPECT_NEAR((moved.col(i) - moved.col(0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR(moved.col(0).norm(), std::hypot(20.0, 10.0) / 4.0, 1e-9);
}

TEST(PolygonTool, CtrlClickInsertsOnAnEdgeAndDeletesAVertex) {
  ToolBench b;
  b.square(100, 100, 100);
  const Eigen::Matrix3Xd four = b.contours.polygons[0].points_lps_mm;
  b.click(150, 103, {.shift = false, .ctrl = true});
  ASSERT_EQ(b.contours.polygons[0].points_lps_mm.cols(), 5);
  EXPECT_NEAR((b.plane.toPixel(b.contours.polygons[0].points_lps_mm.col(1)) - Eigen::Vector2d(150, 103)).norm(), 0,
              1e-9);
  b.click(150, 103, {.shift = false, .ctrl = true});
  EXPECT_EQ(b.contours.polygons[0].points_lps_mm, four);
}

TEST(PolygonTool, DeletingBelowThreeVerticesDeletesThePolygon) {
  ToolBench b;
  b.square(100, 100, 100);
  b.click(100, 100, {.shift = false, .ctrl = true});
  EXPECT_EQ(b.contours.polygons[0].points_lps_mm.cols(), 3);
  b.click(200, 100, {.shift = false, .ctrl = true});
  EXPECT_TRUE(b.contours.polygons.empty());
}

TEST(PolygonTool, BoxSelectsVerticesAndShiftAddsToThem) {
  ToolBench b;
  b.square(100, 100, 100);
  b.drag(90, 85, 240, 120);
  EXPECT_EQ(b.tool.selectedVertices().size(), 2u);
  b.click(100, 200, {.shift = true, .ctrl = false});
  EXPECT_EQ(b.tool.selectedVertices().size(), 3u);
  b.click(100, 200, {.shift = true, .ctrl = false});
  EXPECT_EQ(b.tool.selectedVertices().size(), 2u);
}

TEST(PolygonTool, ACrossingOutlineIsShownAndAcceptingAsksOnce) {
  ToolBench b;
  b.click(100, 100);
  b.click(200, 200);
  b.click(220, 100);
  b.move(90, 190);
  EXPECT_TRUE(b.tool.crosses());
  b.click(90, 190);
  b.key(ToolKey::CtrlEnter);
  ASSERT_EQ(b.contours.polygons.size(), 1u);
  EXPECT_EQ(b.contours.polygons[0].state, roi::PolygonState::Draft);
  EXPECT_NE(b.tool.message().english().find("crosses itself"), std::string::npos);
  b.key(ToolKey::Enter);
  EXPECT_EQ(b.contours.polygons[0].state, roi::PolygonState::Accepted);
}

TEST(PolygonTool, LessThanFourVoxelsIsRefusedWithTheReason) {
  ToolBench b;
  b.click(100, 100);
  b.click(108, 100);
  b.click(108, 108);
  b.key(ToolKey::Enter);
  EXPECT_TRUE(b.contours.polygons.empty());
  EXPECT_EQ(b.tool.state(), ToolState::Drawing);
  EXPECT_FALSE(b.tool.message().empty());
}

TEST(PolygonTool, ShiftClickInsideStartsAHole) {
  ToolBench b;
  b.square(60, 60, 200);
  b.key(ToolKey::Enter);
  b.click(120, 120, {.shift = true, .ctrl = false});
  EXPECT_EQ(b.tool.state(), ToolState::Drawing);
  b.click(200, 120);
  b.click(200, 200);
  b.click(120, 200);
  b.key(ToolKey::CtrlEnter);
  ASSERT_EQ(b.contours.polygons.size(), 2u);
  // 200 px and 80 px at 4 px/mm: what is between them counts.
  EXPECT_NEAR(roi::area_mm2(b.contours), 50.0 * 50.0 - 20.0 * 20.0, 1e-6);
}

TEST(PolygonTool, ShiftDrawsInStepsOf45Degrees) {
  ToolBench b;
  b.click(100, 100);
  b.click(200, 108, {.shift = true, .ctrl = false});
  const Eigen::Vector2d px = b.plane.toPixel(b.tool.drawing().col(1));
  EXPECT_NEAR(px.y(), 100.0, 1e-9);
  EXPECT_NEAR(px.x(), 100.0 + std::hypot(100.0, 8.0), 1e-9);
}

TEST(PolygonTool, OutlinesOfOtherSlicesAreOutOfReach) {
  ToolBench b;
  b.square(100, 100, 100);
  b.key(ToolKey::Enter);
  b.apply(b.tool.leaveSlice(b.plane));
  b.plane.slice = 3;
  b.move(100, 100);
  EXPECT_FALSE(b.tool.hover());
  b.click(150, 150);
  EXPECT_EQ(b.tool.state(), ToolState::Drawing);
}

}  // namespace
}  // namespace glisson::tools
