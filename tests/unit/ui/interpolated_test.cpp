// SPDX-License-Identifier: GPL-3.0-or-later

// What gestures mean on a slice whose outline was interpolated.
#include <gtest/gtest.h>

#include "roi/interpolate.h"
#include "session/interpolated_slices.h"
#include "tool_bench.h"

namespace glisson::session {
namespace {

using roi::PolygonState;

/// Squares on slices 0 and 4 of the bench's grid, and what is interpolated between them; slice 2 is shown.
struct Interpolated : test::ToolBench {
  Interpolated() {
    for (const int k : {0, 4}) {
      plane.slice = k;
      square(100, 100, 160);
      key(tools::ToolKey::Enter);
      apply(tool.key(tools::ToolKey::Escape, plane));
    }
    plane.slice = 2;
    static_cast<roi::ContourStack&>(contours) = roi::interpolateBetween(contours, plane.grid);
  }
  void settle(const tools::Acts& acts) {
    for (const tools::Act& act : acts) {
      auto settled = settleInterpolated(act, contours, plane.grid);
      undo.push(settled ? std::move(settled->command) : commandOf(act, contours), contours);
      if (settled) tool.selectPolygon(settled->selected);
    }
    if (!acts.empty()) tool.contoursChanged();
  }
  std::size_t count(PolygonState state, int slice) const {
    return static_cast<std::size_t>(std::count_if(
        contours.polygons.begin(), contours.polygons.end(),
        [&](const roi::Polygon& p) { return p.state == state && tools::sliceOf(p, plane.grid) == slice; }));
  }
};

TEST(InterpolatedSlices, CoverageTellsDrawnFromInterpolatedFromEmpty) {
  Interpolated b;
  EXPECT_EQ(coverageOf(b.contours, b.plane.grid).drawn, (std::set<int>{0, 4}));
  EXPECT_EQ(coverageOf(b.contours, b.plane.grid).interpolated, (std::set<int>{1, 2, 3}));
  EXPECT_TRUE(coverageOf(b.contours, b.plane.grid).empty.empty());
  std::erase_if(b.contours.polygons, [](const auto& p) { return p.state == PolygonState::Interpolated; });
  EXPECT_EQ(coverageOf(b.contours, b.plane.grid).empty, (std::set<int>{1, 2, 3}));
}

TEST(InterpolatedSlices, AcceptingOneOutlineAcceptsItsSliceInOneStep) {
  Interpolated b;
  const roi::ContourStack before = b.contours;
  b.press(180, 100);
  b.release(180, 100);
  ASSERT_TRUE(b.tool.interpolated());
  b.settle(b.tool.key(tools::ToolKey::Enter, b.plane));
  EXPECT_EQ(b.count(PolygonState::Interpolated, 2), 0u);
  EXPECT_EQ(b.count(PolygonState::Accepted, 2), 1u);
  EXPECT_EQ(b.count(PolygonState::Interpolated, 1), 1u);
  EXPECT_EQ(b.tool.state(), tools::ToolState::Accepted);
  b.undo.undo(b.contours);
  EXPECT_TRUE(test::same(b.contours, before));
}

TEST(InterpolatedSlices, CorrectingAnOutlineAcceptsIt) {
  Interpolated b;
  b.press(180, 100);
  for (int s = 1; s <= 10; ++s) b.move(180, 100 - 2 * s);
  b.settle(b.tool.release(test::ToolBench::at(180, 80), b.plane));
  EXPECT_EQ(b.count(PolygonState::Interpolated, 2), 0u);
  EXPECT_EQ(b.count(PolygonState::Accepted, 2), 1u);
}

TEST(InterpolatedSlices, AnOutlineDrawnThereReplacesThemOnceAccepted) {
  Interpolated b;
  const roi::ContourStack before = b.contours;
  b.square(120, 120, 60);
  EXPECT_EQ(b.count(PolygonState::Draft, 2), 1u);
  EXPECT_EQ(b.count(PolygonState::Interpolated, 2), 1u);  // a draft replaces nothing yet
  const Eigen::Matrix3Xd drawn = b.contours.polygons.back().points_lps_mm;
  b.settle(b.tool.key(tools::ToolKey::Enter, b.plane));
  EXPECT_EQ(b.count(PolygonState::Interpolated, 2), 0u);
  ASSERT_EQ(b.count(PolygonState::Accepted, 2), 1u);
  ASSERT_TRUE(b.tool.selected().has_value());
  EXPECT_EQ(b.contours.polygons[*b.tool.selected()].points_lps_mm, drawn);
  while (b.contours.polygons.size() > before.polygons.size()) b.undo.undo(b.contours);
  b.undo.undo(b.contours);
  b.undo.undo(b.contours);
  EXPECT_EQ(b.count(PolygonState::Interpolated, 2), 1u);
}

TEST(InterpolatedSlices, EscapeLetsGoAndDeletesNothing) {
  Interpolated b;
  const std::size_t n = b.contours.polygons.size();
  b.press(180, 100);
  b.release(180, 100);
  b.apply(b.tool.key(tools::ToolKey::Backspace, b.plane));
  b.apply(b.tool.key(tools::ToolKey::Escape, b.plane));
  EXPECT_EQ(b.contours.polygons.size(), n);
  EXPECT_EQ(b.tool.state(), tools::ToolState::Idle);
}

TEST(InterpolatedSlices, WhatNobodyDrewIsNamedAfterItIsAcceptedAndUntilItIsCorrected) {
  Interpolated b;
  using commands::MadeBy;
  for (const roi::Polygon& p : b.contours.polygons)
    if (p.state == PolygonState::Interpolated)
      b.contours.made.try_emplace(commands::digestOf(p), MadeBy::Interpolation);
  EXPECT_EQ(madeSlices(b.contours, b.plane.grid).size(), 3u);
  b.press(180, 100);
  b.release(180, 100);
  b.settle(b.tool.key(tools::ToolKey::Enter, b.plane));
  EXPECT_EQ(b.count(PolygonState::Accepted, 2), 1u);
  EXPECT_EQ(madeSlices(b.contours, b.plane.grid).count(2), 1u) << "accepted, and still drawn by nobody";
  b.press(180, 100);
  for (int s = 1; s <= 10; ++s) b.move(180, 100 - 2 * s);
  b.settle(b.tool.release(test::ToolBench::at(180, 80), b.plane));
  EXPECT_EQ(madeSlices(b.contours, b.plane.grid).count(2), 0u) << "corrected by hand";
  b.undo.undo(b.contours);
  EXPECT_EQ(madeSlices(b.contours, b.plane.grid).count(2), 1u) << "as it was made";
}

TEST(InterpolatedSlices, DraftsAreNamedBesideWhatCounts) {
  Interpolated b;
  b.contours.polygons.push_back(b.contours.polygons.front());
  b.contours.polygons.back().state = PolygonState::Draft;
  const OutlineCoverage c = coverageOf(b.contours, b.plane.grid);
  EXPECT_EQ(c.drafts, (std::set<int>{0}));
  EXPECT_EQ(c.drawn, (std::set<int>{0, 4}));
}

}  // namespace
}  // namespace glisson::session
