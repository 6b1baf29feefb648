// SPDX-License-Identifier: GPL-3.0-or-later

// What keeps an outline a region: crossing, too small, parked, and what is said of it.
#include <gtest/gtest.h>

#include <utility>

#include "tool_bench.h"
#include "tools/outline.h"

namespace glisson::tools {
namespace {

using test::ToolBench;

/// An accepted square of side 200 px with its corner at (100, 100), selected.
ToolBench acceptedSquare() {
  ToolBench b;
  b.square(100, 100, 200);
  b.key(ToolKey::Enter);
  return b;
}

TEST(OutlineRules, AnAcceptedOutlineDraggedAcrossItselfIsADraftAgainInOneStep) {
  ToolBench b = acceptedSquare();
  const auto before = b.contours;
  const std::size_t steps = b.undo.size();
  b.drag(300, 100, 150, 360);  // a corner through the opposite side
  EXPECT_EQ(b.undo.size(), steps + 1);
  EXPECT_EQ(b.contours.polygons[0].state, roi::PolygonState::Draft);
  EXPECT_EQ(b.tool.state(), ToolState::Editing);
  EXPECT_NE(b.tool.message().english().find("crosses itself"), std::string::npos);
  // It was asked with that: accepting it all the same takes one key, and what was accepted so stays so.
  b.key(ToolKey::Enter);
  EXPECT_EQ(b.contours.polygons[0].state, roi::PolygonState::Accepted);
  b.drag(150, 360, 160, 370);
  EXPECT_EQ(b.contours.polygons[0].state, roi::PolygonState::Accepted);
  while (b.undo.size() > 0 && !test::same(b.contours, before)) b.undo.undo(b.contours);
  EXPECT_TRUE(test::same(b.contours, before));
}

TEST(OutlineRules, NothingTakesAnAcceptedOutlineBelowFourVoxels) {
  const auto refused = [](ToolBench& b, const auto& act) {
    const auto before = b.contours;
    const std::size_t steps = b.undo.size();
    act();
    EXPECT_TRUE(test::same(b.contours, before));
    EXPECT_EQ(b.undo.size(), steps);
    EXPECT_NE(b.tool.message().english().find("Not changed"), std::string::npos) << b.tool.message().english();
  };
  // 7.5 by 10 mm with pixels of 1.5 by 2 mm, and one vertex far away that makes it large.
  ToolBench b;
  b.click(100, 100);
  b.click(104, 100);
  b.click(104, 104);
  b.click(400, 140);
  b.click(100, 104);
  b.key(ToolKey::CtrlEnter);
  ASSERT_EQ(b.tool.state(), ToolState::Accepted);
  refused(b, [&] { b.drag(400, 140, 102, 106); });
  refused(b, [&] {
    b.click(400, 140);
    b.key(ToolKey::Delete);
  });
  EXPECT_FALSE(b.tool.selectedVertices().empty()) << "what is refused leaves the selection";
  refused(b, [&] {
    b.click(100, 100);
    b.click(104, 104, {.shift = true, .ctrl = false});
    b.apply(b.tool.split(b.plane));
  });
  // A draft may be anything until it is accepted.
  ToolBench draft;
  draft.square(100, 100, 60);
  for (const auto& [x, y] : {std::pair(160, 100), std::pair(160, 160), std::pair(100, 160)})
    draft.drag(x, y, 100 + (x - 100) / 20.0 + 8, 100 + (y - 100) / 20.0 + 8);
  EXPECT_EQ(draft.contours.polygons[0].state, roi::PolygonState::Draft);
  draft.key(ToolKey::Enter);
  EXPECT_EQ(draft.contours.polygons[0].state, roi::PolygonState::Draft);
}

TEST(OutlineRules, ACutAcrossABayMakesDraftsOfWhatCrosses) {
  ToolBench b;  // a U: the chord between the tops of its arms runs outside; one from arm to foot crosses edges
  for (const auto& [x, y] : {std::pair(100, 100), std::pair(160, 100), std::pair(160, 260), std::pair(240, 260),
                             std::pair(240, 180), std::pair(300, 100), std::pair(300, 320), std::pair(100, 320)})
    b.click(x, y);
  b.key(ToolKey::CtrlEnter);
  ASSERT_EQ(b.tool.state(), ToolState::Accepted);
  b.click(100, 100);
  b.click(300, 320, {.shift = true, .ctrl = false});
  b.apply(b.tool.split(b.plane));
  ASSERT_EQ(b.contours.polygons.size(), 2u);
  int crossing = 0;
  for (const roi::Polygon& part : b.contours.polygons) {
    Outline flat(2, part.points_lps_mm.cols());
    for (Eigen::Index i = 0; i < flat.cols(); ++i) flat.col(i) = b.plane.toPlane_mm(part.points_lps_mm.col(i));
    crossing += crossesItself(flat, true) ? 1 : 0;
    EXPECT_EQ(part.state, crossesItself(flat, true) ? roi::PolygonState::Draft : roi::PolygonState::Accepted);
  }
  EXPECT_EQ(crossing, 1);
}

TEST(OutlineRules, UndoWhileDrawingTellsAtOnceWhetherItStillCrosses) {
  ToolBench b;
  for (const auto& [x, y] :
       {std::pair(100, 100), std::pair(200, 200), std::pair(220, 100), std::pair(90, 190), std::pair(60, 250)})
    b.click(x, y);
  EXPECT_TRUE(b.tool.crosses());
  b.tool.undoDrawing(b.plane);
  b.tool.undoDrawing(b.plane);
  EXPECT_TRUE(b.tool.canRedoDrawing());
  b.tool.redoDrawing(b.plane);
  EXPECT_TRUE(b.tool.crosses());
}

TEST(OutlineRules, ADoubleClickWithTooFewVerticesSaysWhatIsMissing) {
  ToolBench b;
  b.click(100, 100);
  b.click(200, 100);
  b.apply(b.tool.doubleClick(ToolBench::at(200, 100), b.plane));
  EXPECT_EQ(b.tool.state(), ToolState::Drawing);
  EXPECT_NE(b.tool.message().english().find("three different vertices"), std::string::npos);
}

TEST(OutlineRules, AParkedDraftIsTakenUpAsItsMessageSays) {
  ToolBench b;
  b.click(100, 100);
  b.click(300, 100);
  b.click(300, 300);
  b.apply(b.tool.leaveSlice(b.plane));
  EXPECT_EQ(b.tool.message().english(),
            "Parked as a draft on slice 3. Click it there: Backspace takes it up again, Esc discards it.");
  b.click(200, 100);
  b.key(ToolKey::Backspace);
  EXPECT_EQ(b.tool.state(), ToolState::Drawing);
  EXPECT_EQ(b.tool.drawing().cols(), 3);
  b.key(ToolKey::Escape);
  EXPECT_EQ(b.tool.message().english(), "Parked as a draft. Backspace takes it up again, Esc discards it.");
  b.apply(b.tool.leaveSlice(b.plane));
  b.click(200, 100);
  b.key(ToolKey::Escape);
  EXPECT_TRUE(b.contours.polygons.empty());
}

}  // namespace
}  // namespace glisson::tools
