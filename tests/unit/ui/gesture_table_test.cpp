// SPDX-License-Identifier: GPL-3.0-or-later

// Every row of the gesture table, in every state. Rows of the view alone (zoom, pan, slice, window) are tested through
// the window, in tests/gui.
#include <gtest/gtest.h>

#include <cmath>

#include "tool_bench.h"
#include "tools/measure_tool.h"
#include "tools/outline.h"

namespace glisson::tools {
namespace {

using test::ToolBench;
constexpr Modifiers shift{.shift = true, .ctrl = false}, ctrl{.shift = false, .ctrl = true};

/// An accepted square of side 200 px with its corner at (100, 100), nothing selected.
ToolBench accepted() {
  ToolBench b;
  b.square(100, 100, 200);
  b.key(ToolKey::Enter);
  b.tool.deselect();
  return b;
}

void doubleClick(ToolBench& b, double x, double y) {
  b.click(x, y);
  b.apply(b.tool.doubleClick(ToolBench::at(x, y), b.plane));
}

TEST(GestureTable, LeftClickIdleIsTheFirstVertex) {
  ToolBench b;
  b.click(50, 60);
  EXPECT_EQ(b.tool.state(), ToolState::Drawing);
  EXPECT_EQ(b.tool.drawing().cols(), 1);
}

TEST(GestureTable, LeftClickEditingSelectsVertexEdgeOrOutlineAndEmptyClears) {
  for (const bool accept : {false, true}) {
    ToolBench b;
    b.square(100, 100, 200);
    if (accept) b.key(ToolKey::Enter);
    b.click(300, 100);
    EXPECT_EQ(b.tool.selectedVertices(), std::vector<Eigen::Index>({1}));
    b.click(200, 100);
    EXPECT_EQ(b.tool.selectedVertices(), std::vector<Eigen::Index>({0, 1}));
    b.click(200, 200);
    EXPECT_EQ(b.tool.selectedVertices().size(), 4u);
    b.click(420, 40);
    EXPECT_EQ(b.tool.state(), ToolState::Idle);
    EXPECT_FALSE(b.tool.selected());
  }
}

TEST(GestureTable, LeftDragIdleIsFreehandEvenInsideAnOutline) {
  ToolBench b = accepted();
  b.drag(150, 150, 250, 150);
  EXPECT_EQ(b.tool.state(), ToolState::Drawing);
  EXPECT_GE(b.tool.drawing().cols(), 2);
  EXPECT_EQ(b.undo.size(), 2u) << "a drawing in work is no undo step of the outlines yet";
}

TEST(GestureTable, DoubleClickIdleOnAnOutlineAsksForItsProperties) {
  ToolBench b = accepted();
  doubleClick(b, 200, 200);
  EXPECT_EQ(b.tool.takePropertiesWish(), 0u);
  EXPECT_FALSE(b.tool.takePropertiesWish()) << "asked once";
  EXPECT_EQ(b.tool.state(), ToolState::Accepted);
  EXPECT_EQ(b.contours.polygons.size(), 1u);
  EXPECT_EQ(b.tool.drawing().cols(), 0);
}

TEST(GestureTable, DoubleClickIdleBesideOutlinesDrawsOneVertexOnly) {
  ToolBench b;
  doubleClick(b, 200, 200);
  EXPECT_FALSE(b.tool.takePropertiesWish());
  EXPECT_EQ(b.tool.drawing().cols(), 1);
}

TEST(GestureTable, DoubleClickEditingAcceptsAndOnAcceptedAsksForProperties) {
  ToolBench b;
  b.square(100, 100, 200);
  doubleClick(b, 200, 200);
  EXPECT_EQ(b.contours.polygons[0].state, roi::PolygonState::Accepted);
  EXPECT_FALSE(b.tool.takePropertiesWish());
  doubleClick(b, 200, 200);
  EXPECT_EQ(b.tool.takePropertiesWish(), 0u);
}

TEST(GestureTable, DoubleClickDrawingAddsTheLastVertexAndCloses) {
  ToolBench b;
  b.click(100, 100);
  b.click(300, 100);
  b.click(300, 300);
  doubleClick(b, 100, 300);
  ASSERT_EQ(b.contours.polygons.size(), 1u);
  EXPECT_EQ(b.contours.polygons[0].points_lps_mm.cols(), 4);
}

TEST(GestureTable, RightClickSelectsForTheMenuAndChangesNothing) {
  ToolBench b = accepted();
  const auto before = b.contours;
  b.apply(b.tool.rightClick(ToolBench::at(200, 200), b.plane));
  EXPECT_EQ(b.tool.selected(), 0u);
  EXPECT_EQ(b.tool.selectedVertices().size(), 4u);
  b.apply(b.tool.rightClick(ToolBench::at(300, 100), b.plane));
  EXPECT_EQ(b.tool.selected(), 0u) << "a selection stays for the menu";
  b.tool.deselect();
  b.apply(b.tool.rightClick(ToolBench::at(450, 30), b.plane));
  EXPECT_FALSE(b.tool.selected());
  EXPECT_TRUE(test::same(b.contours, before));
}

TEST(GestureTable, ZoomAndPanKeepTheDrawing) {
  ToolBench b;
  b.click(100, 100);
  b.click(300, 100);
  const Eigen::Matrix3Xd before = b.tool.drawing();
  b.plane.scale_px_mm *= 2.5;
  b.plane.offset_px += Eigen::Vector2d(33, -12);
  b.move(200, 200);
  EXPECT_EQ(b.tool.drawing(), before);
  b.click(310, 250);
  EXPECT_NEAR((b.plane.toPixel(b.tool.drawing().col(2)) - Eigen::Vector2d(310, 250)).norm(), 0.0, 1e-9);
}

TEST(GestureTable, CtrlClickOnEmptyInsertsNothing) {
  ToolBench b = accepted();
  b.click(300, 100);
  const auto before = b.contours;
  b.click(420, 40, ctrl);
  EXPECT_TRUE(test::same(b.contours, before));
}

TEST(GestureTable, ShiftClickAddsToAndTakesFromTheSelection) {
  ToolBench b = accepted();
  b.click(100, 100);
  b.click(300, 300, shift);
  EXPECT_EQ(b.tool.selectedVertices().size(), 2u);
  b.click(100, 100, shift);
  EXPECT_EQ(b.tool.selectedVertices(), std::vector<Eigen::Index>({2}));
}

TEST(GestureTable, AFingerClosesWithin36Pixels) {
  for (const bool touch : {false, true}) {
    ToolBench b;
    b.click(100, 100);
    b.click(300, 100);
    b.click(300, 300);
    Pointer at{{125, 125}, {}, touch};  // 35.4 px from the first vertex
    b.apply(b.tool.move(at, b.plane));
    EXPECT_EQ(b.tool.closes(), touch);
    b.apply(b.tool.press(at, b.plane));
    b.apply(b.tool.release(at, b.plane));
    EXPECT_EQ(b.tool.state(), touch ? ToolState::Editing : ToolState::Drawing);
  }
}

TEST(GestureTable, FreehandSpacingIsWhatWasChosenBetween1And100) {
  for (const double spacing : {0.1, 3.0, 25.0, 400.0}) {
    ToolBench b;
    b.tool.setFreehandSpacing(spacing);
    EXPECT_DOUBLE_EQ(b.tool.freehandSpacing(), std::clamp(spacing, 1.0, 100.0));
    b.press(20, 20);
    b.move(420, 20);
    // The start, and one point per spacing on the way, before letting go simplifies the line.
    EXPECT_EQ(b.tool.drawing().cols(), 1 + static_cast<Eigen::Index>(std::floor(400.0 / b.tool.freehandSpacing())));
  }
}

TEST(ToolModes, AnotherToolParksTheOutline) {
  ToolBench b;
  b.click(100, 100);
  b.click(300, 100);
  b.apply(b.tool.setMode(ToolMode::Sculpt, b.plane));
  ASSERT_EQ(b.contours.polygons.size(), 1u);
  EXPECT_EQ(b.contours.polygons[0].state, roi::PolygonState::Draft);
}

TEST(ToolModes, FreehandDrawsOverOutlinesAndLettingGoCloses) {
  ToolBench b = accepted();
  b.apply(b.tool.setMode(ToolMode::Freehand, b.plane));
  b.press(300, 100);  // on a vertex of the square
  for (int s = 1; s <= 60; ++s) {
    const double a = 2.0 * M_PI * s / 70.0;
    b.move(240 + 60 * std::cos(a), 100 + 60 * std::sin(a));
  }
  b.release(250, 42);
  EXPECT_EQ(b.tool.state(), ToolState::Editing);
  EXPECT_EQ(b.contours.polygons.size(), 2u);
}

TEST(ToolModes, SculptingPushesTheOutlineAwayFromTheDiscInOneStep) {
  ToolBench b = accepted();
  b.apply(b.tool.setMode(ToolMode::Sculpt, b.plane));
  b.tool.setBrushRadius(30);
  const Eigen::Matrix3Xd before = b.contours.polygons[0].points_lps_mm;
  const std::size_t steps = b.undo.size();
  b.press(330, 200);  // outside, right of the right edge
  b.move(300, 200);
  b.move(280, 200);
  EXPECT_GT(b.tool.preview().cols(), 4);
  b.release(280, 200);
  EXPECT_EQ(b.undo.size(), steps + 1);
  const Eigen::Matrix3Xd& after = b.contours.polygons[0].points_lps_mm;
  Outline px(2, after.cols());
  for (Eigen::Index i = 0; i < after.cols(); ++i) px.col(i) = b.plane.toPixel(after.col(i));
  for (Eigen::Index i = 0; i < px.cols(); ++i) EXPECT_GE((px.col(i) - Eigen::Vector2d(280, 200)).norm(), 30.0 - 1e-6);
  EXPECT_FALSE(inside({280, 200}, px)) << "pushed inwards from outside";
  for (Eigen::Index corner = 0; corner < 4; ++corner) {
    bool kept = false;
    for (Eigen::Index i = 0; i < after.cols(); ++i) kept = kept || after.col(i) == before.col(corner);
    EXPECT_TRUE(kept) << "a vertex out of reach moved: " << corner;
  }
  EXPECT_LT(std::abs(signedArea(px)), 200.0 * 200.0);
  b.undo.undo(b.contours);
  EXPECT_EQ(b.contours.polygons[0].points_lps_mm, before);
}

TEST(ToolModes, SculptingFromInsidePushesOutwards) {
  ToolBench b = accepted();
  b.apply(b.tool.setMode(ToolMode::Sculpt, b.plane));
  b.drag(200, 200, 310, 200);
  const Eigen::Matrix3Xd& after = b.contours.polygons[0].points_lps_mm;
  Outline px(2, after.cols());
  for (Eigen::Index i = 0; i < after.cols(); ++i) px.col(i) = b.plane.toPixel(after.col(i));
  EXPECT_TRUE(inside({310, 200}, px));
  EXPECT_GT(std::abs(signedArea(px)), 200.0 * 200.0);
}

TEST(ToolModes, SculptingWithNoOutlineSaysSo) {
  ToolBench b;
  b.apply(b.tool.setMode(ToolMode::Sculpt, b.plane));
  b.drag(100, 100, 200, 200);
  EXPECT_TRUE(b.contours.polygons.empty());
  EXPECT_EQ(b.tool.state(), ToolState::Idle);
}

TEST(Selection, NudgeMovesByImagePixelsAsSeen) {
  ToolBench b = accepted();
  b.click(300, 100);
  const Eigen::Vector3d before = b.contours.polygons[0].points_lps_mm.col(1);
  b.apply(b.tool.nudge({0.1, 0.0}, b.plane));
  const Eigen::Vector3d index =
      b.plane.grid.lpsToIndex(b.contours.polygons[0].points_lps_mm.col(1)) - b.plane.grid.lpsToIndex(before);
  EXPECT_NEAR((index - Eigen::Vector3d(0.1, 0.0, 0.0)).norm(), 0.0, 1e-9);
  b.plane.scale_px_mm.y() *= -1.0;  // a flipped view: down the view is up the image
  b.apply(b.tool.nudge({0.0, 1.0}, b.plane));
  const Eigen::Vector3d all =
      b.plane.grid.lpsToIndex(b.contours.polygons[0].points_lps_mm.col(1)) - b.plane.grid.lpsToIndex(before);
  EXPECT_NEAR((all - Eigen::Vector3d(0.1, -1.0, 0.0)).norm(), 0.0, 1e-9);
}

TEST(Selection, SplitHalvesSelectedEdges) {
  ToolBench b = accepted();
  b.click(200, 100);
  b.apply(b.tool.split(b.plane));
  EXPECT_EQ(b.contours.polygons[0].points_lps_mm.cols(), 5);
  EXPECT_NEAR((b.plane.toPixel(b.contours.polygons[0].points_lps_mm.col(1)) - Eigen::Vector2d(200, 100)).norm(), 0,
              1e-9);
}

TEST(Selection, SplitBetweenTwoVerticesCutsInTwoInOneStepAndKeepsTheArea) {
  ToolBench b = accepted();
  b.click(100, 100);
  b.click(300, 300, shift);
  const double before = roi::area_mm2(b.contours);
  const std::size_t steps = b.undo.size();
  b.apply(b.tool.split(b.plane));
  ASSERT_EQ(b.contours.polygons.size(), 2u);
  EXPECT_EQ(b.undo.size(), steps + 1);
  EXPECT_NEAR(roi::area_mm2(b.contours), before, 1e-6 * before);
  b.undo.undo(b.contours);
  EXPECT_EQ(b.contours.polygons.size(), 1u);
  EXPECT_EQ(b.contours.polygons[0].points_lps_mm.cols(), 4);
}

TEST(Selection, TrimBetweenTwoVerticesKeepsTheLargerPart) {
  ToolBench b;
  b.click(100, 100);
  b.click(400, 100);
  b.click(400, 300);
  b.click(250, 300);
  b.click(100, 300);
  b.key(ToolKey::CtrlEnter);
  b.click(400, 100);
  b.click(250, 300, shift);
  b.apply(b.tool.trim(b.plane));
  EXPECT_EQ(b.contours.polygons[0].points_lps_mm.cols(), 4);  // the corner at (400, 300) is gone
  EXPECT_NEAR(roi::area_mm2(b.contours), (300.0 * 200.0 - 0.5 * 150.0 * 200.0) / 16.0, 1e-6);
}

TEST(Selection, TrimThinsOutWhatSplitHalved) {
  ToolBench b = accepted();
  const Eigen::Matrix3Xd four = b.contours.polygons[0].points_lps_mm;
  b.tool.selectAll(b.plane);
  b.apply(b.tool.split(b.plane));
  EXPECT_EQ(b.contours.polygons[0].points_lps_mm.cols(), 8);
  b.tool.selectAll(b.plane);
  b.apply(b.tool.trim(b.plane));
  EXPECT_EQ(b.contours.polygons[0].points_lps_mm, four);
}

TEST(Selection, KindChangesAndGoesBack) {
  ToolBench b = accepted();
  b.tool.selectAll(b.plane);
  b.apply(b.tool.setKind(true));
  EXPECT_TRUE(b.contours.polygons[0].exclude);
  b.apply(b.tool.setKind(true));
  EXPECT_EQ(b.undo.size(), 3u) << "saying it again is no step";
  b.undo.undo(b.contours);
  EXPECT_FALSE(b.contours.polygons[0].exclude);
}

TEST(Selection, WithoutASelectionActsSayWhatIsMissing) {
  ToolBench b = accepted();
  EXPECT_TRUE(b.tool.split(b.plane).empty());
  EXPECT_FALSE(b.tool.message().empty());
  EXPECT_TRUE(b.tool.trim(b.plane).empty());
  EXPECT_TRUE(b.tool.setKind(true).empty());
  EXPECT_TRUE(b.tool.nudge({1, 0}, b.plane).empty());
}

TEST(Measure, ADragOrTwoClicksMeasureMillimetres) {
  ToolBench b;
  MeasureTool m;
  m.press({100, 100}, b.plane);
  m.move({150, 100}, b.plane);
  m.release({140, 100}, b.plane);
  m.press({100, 100}, b.plane);
  m.release({101, 100}, b.plane);
  EXPECT_TRUE(m.inWork());
  m.press({100, 300}, b.plane);
  m.release({100, 300}, b.plane);
  ASSERT_EQ(m.distances().size(), 2u);
  EXPECT_NEAR(m.distances()[0].length_mm(), 10.0, 1e-9);  // 40 px at 4 px/mm
  EXPECT_NEAR(m.distances()[1].length_mm(), 50.0, 1e-9);
  m.removeLast();
  EXPECT_EQ(m.distances().size(), 1u);
}

}  // namespace
}  // namespace glisson::tools
