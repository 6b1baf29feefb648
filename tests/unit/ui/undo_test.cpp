// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <vector>

#include "commands/replace_contours.h"
#include "tool_bench.h"

namespace glisson::commands {
namespace {

using test::ToolBench;

/// Random gestures, keys and slice changes; every act goes through the undo stack.
void randomWork(ToolBench& b, std::uint64_t seed, int gestures) {
  Random random(seed);
  for (int n = 0; n < gestures; ++n) {
    const double x = random.uniform(-20, 520), y = random.uniform(-20, 520);
    const tools::Modifiers m{random.uniform() < 0.15, random.uniform() < 0.15};
    const auto action = random.below(16);
    if (action < 5)
      b.click(x, y, m);
    else if (action == 5)
      b.drag(x, y, random.uniform(0, 500), random.uniform(0, 500), m);
    else if (action == 6)
      b.apply(b.tool.rightClick(ToolBench::at(x, y), b.plane));
    else if (action == 7)
      b.apply(b.tool.doubleClick(ToolBench::at(x, y), b.plane));
    else if (action == 8)
      b.key(static_cast<tools::ToolKey>(random.below(5)));
    else if (action == 9) {
      b.apply(b.tool.leaveSlice(b.plane));
      b.plane.slice = static_cast<int>(random.below(5));
    } else if (action == 10)
      b.apply(b.tool.setMode(static_cast<tools::ToolMode>(random.below(tools::toolModeCount)), b.plane));
    else if (action == 11)
      b.apply(random.uniform() < 0.5 ? b.tool.split(b.plane) : b.tool.trim(b.plane));
    else if (action == 12)
      b.apply(b.tool.setKind(random.uniform() < 0.5));
    else if (action == 13)
      b.apply(b.tool.nudge({random.uniform(-1, 1), random.uniform(-1, 1)}, b.plane));
    else if (action == 14)
      b.apply(b.tool.combine(static_cast<roi::SetOperation>(random.below(3)), b.plane));
    else
      b.tool.selectAll(b.plane);
  }
}

TEST(UndoStack, UndoAllIsTheFirstStateAndRedoAllTheLast) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    ToolBench b;
    b.undo = UndoStack(100000);
    randomWork(b, seed, 1500);
    const roi::ContourStack last = b.contours;
    ASSERT_GT(b.undo.size(), 20u) << "the random work did nothing worth undoing";
    std::vector<roi::ContourStack> way;
    while (b.undo.canUndo()) {
      way.push_back(b.contours);
      b.undo.undo(b.contours);
    }
    EXPECT_TRUE(b.contours.polygons.empty());
    while (b.undo.canRedo()) {
      b.undo.redo(b.contours);
      EXPECT_TRUE(test::same(b.contours, way.back()));
      way.pop_back();
    }
    EXPECT_TRUE(test::same(b.contours, last)) << "seed " << seed;
  }
}

TEST(UndoStack, NothingIsEverDroppedSilently) {
  // Without Delete, Esc on a draft, and Ctrl (delete vertex) the number of outlines never falls.
  ToolBench b;
  Random random(5);
  std::size_t outlines = 0;
  for (int n = 0; n < 3000; ++n) {
    const double x = random.uniform(0, 500), y = random.uniform(0, 500);
    const auto action = random.below(8);
    if (action < 5)
      b.click(x, y);
    else if (action == 5)
      b.drag(x, y, random.uniform(0, 500), random.uniform(0, 500));
    else if (action == 6)
      b.key(tools::ToolKey::Enter);
    else {
      b.apply(b.tool.leaveSlice(b.plane));
      b.plane.slice = static_cast<int>(random.below(5));
    }
    EXPECT_GE(b.contours.polygons.size(), outlines);
    outlines = b.contours.polygons.size();
  }
  EXPECT_GT(outlines, 10u);
}

/// A triangle somewhere on the slice shown.
roi::Polygon triangle(const ToolBench& b, double x_px) {
  roi::Polygon polygon;
  polygon.points_lps_mm.resize(3, 3);
  polygon.points_lps_mm << b.plane.toLps({x_px, 20.0}), b.plane.toLps({x_px + 90.0, 20.0}),
      b.plane.toLps({x_px, 140.0});
  return polygon;
}

TEST(UndoStack, KeepsAtLeastTwoHundredSteps) {
  ToolBench b;
  for (int n = 0; n < 300; ++n) b.apply({tools::AddPolygon{triangle(b, n)}});
  int undone = 0;
  while (b.undo.undo(b.contours)) ++undone;
  EXPECT_GE(undone, 200);
}

TEST(UndoStack, ForgetsTheOldestBeyondItsLimit) {
  ToolBench b;
  b.undo = UndoStack(3);
  for (int n = 0; n < 5; ++n) b.apply({tools::AddPolygon{triangle(b, n)}});
  EXPECT_EQ(b.undo.size(), 3u);
  while (b.undo.undo(b.contours)) {
  }
  EXPECT_EQ(b.contours.polygons.size(), 2u);
}

TEST(UndoStack, TellsWhichSliceAnActConcerned) {
  ToolBench b;
  b.square(100, 100, 100);
  b.apply(b.tool.leaveSlice(b.plane));
  b.plane.slice = 4;
  b.square(100, 100, 100);
  const auto second = b.undo.undo(b.contours), first = b.undo.undo(b.contours);
  ASSERT_TRUE(first && second);
  EXPECT_NEAR(b.plane.grid.lpsToIndex(*second).z(), 4.0, 1e-9);
  EXPECT_NEAR(b.plane.grid.lpsToIndex(*first).z(), 2.0, 1e-9);
}

TEST(UndoStack, ANewActForgetsWhatCouldBeRedone) {
  ToolBench b;
  b.square(100, 100, 100);
  b.undo.undo(b.contours);
  b.tool.contoursChanged();
  EXPECT_TRUE(b.undo.canRedo());
  b.square(200, 100, 100);
  EXPECT_FALSE(b.undo.canRedo());
}

TEST(UndoStack, AnImportIsOneStep) {
  ToolBench b;
  b.square(100, 100, 100);
  const roi::ContourStack drawn = b.contours;
  roi::ContourStack other = drawn;
  other.polygons.push_back(drawn.polygons[0]);
  b.undo.push(std::make_unique<ReplaceContours>(b.contours, other, "import outlines"), b.contours);
  EXPECT_EQ(b.contours.polygons.size(), 2u);
  b.undo.undo(b.contours);
  EXPECT_TRUE(test::same(b.contours, drawn));
}

}  // namespace
}  // namespace glisson::commands
