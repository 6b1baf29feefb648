// SPDX-License-Identifier: GPL-3.0-or-later

// Brush and eraser, and outlines combined.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/random.h"
#include "outline_bench.h"

namespace glisson::tools {
namespace {

using roi::PolygonState;
using roi::SetOperation;
using test::area_mm2;
using test::mode;
using test::ToolBench;
constexpr Modifiers shift{.shift = true, .ctrl = false};
constexpr double pi = std::numbers::pi;

/// An accepted square, selected, px.
void acceptedSquare(ToolBench& b, double x, double y, double side) {
  mode(b, ToolMode::Polygon);
  b.tool.deselect();
  b.square(x, y, side);
  b.key(ToolKey::Enter);
}

bool holdsVertex(const roi::Polygon& polygon, const Eigen::Vector3d& p) {
  for (const auto v : polygon.points_lps_mm.colwise())
    if (v == p) return true;
  return false;
}

/// Dark and bright tissue on either side of an upright edge at x = 240 px, with noise; the bench shows 4 px per mm.
std::shared_ptr<const image::ScalarVolume> twoTissues(const ToolBench& b, double noise) {
  auto image = std::make_shared<image::ScalarVolume>(b.plane.grid);
  Random random(9);
  for (int k = 0; k < b.plane.grid.size.z(); ++k)
    for (int j = 0; j < b.plane.grid.size.y(); ++j)
      for (int i = 0; i < b.plane.grid.size.x(); ++i) {
        const double x_px = b.plane.toPixel(b.plane.grid.indexToLps({1.0 * i, 1.0 * j, 1.0 * k})).x();
        image->at(i, j, k) = static_cast<float>((x_px < 240.0 ? 100.0 : 180.0) + noise * random.normal());
      }
  return image;
}

TEST(BrushTool, AStrokeIsADraftOfItsAreaAndAnotherOneJoinsIt) {
  ToolBench b;
  mode(b, ToolMode::Brush);
  b.tool.setBrushRadius(40);
  b.press(150, 200);
  EXPECT_EQ(b.tool.shape().size(), 1u);
  b.move(250, 200);
  b.release(250, 200);
  ASSERT_EQ(b.contours.polygons.size(), 1u);
  EXPECT_EQ(b.contours.polygons[0].state, PolygonState::Draft);
  EXPECT_EQ(b.undo.size(), 1u);
  const double capsule = (pi * 40.0 * 40.0 + 100.0 * 80.0) / 16.0;
  EXPECT_NEAR(area_mm2(b, 0), capsule, 0.02 * capsule);
  b.press(200, 230);
  b.release(200, 230);  // a touch is a disc
  EXPECT_EQ(b.contours.polygons.size(), 1u);
  EXPECT_GT(area_mm2(b, 0), capsule * 1.02);
  EXPECT_EQ(b.undo.size(), 2u);
  b.press(200, 210);
  b.release(200, 210);  // all of it is there already
  EXPECT_EQ(b.undo.size(), 2u);
  b.key(ToolKey::Enter);
  EXPECT_EQ(b.contours.polygons[0].state, PolygonState::Accepted);
}

TEST(BrushTool, PaintingAtAnAcceptedOutlineChangesItsReachAndNoOtherVertex) {
  ToolBench b;
  acceptedSquare(b, 100, 100, 160);
  acceptedSquare(b, 340, 300, 80);
  const auto before = b.contours.polygons;
  b.tool.deselect();
  mode(b, ToolMode::Brush);
  b.drag(250, 180, 290, 180);
  ASSERT_EQ(b.contours.polygons.size(), 2u);
  EXPECT_EQ(b.contours.polygons[0].state, PolygonState::Accepted);
  for (const auto corner : before[0].points_lps_mm.colwise()) EXPECT_TRUE(holdsVertex(b.contours.polygons[0], corner));
  EXPECT_EQ(b.contours.polygons[1].points_lps_mm, before[1].points_lps_mm);
  EXPECT_GT(area_mm2(b, 0), 1600.0);
  b.undo.undo(b.contours);
  EXPECT_EQ(b.contours.polygons[0].points_lps_mm, before[0].points_lps_mm);
}

TEST(EraserTool, CutsThroughMakesHolesAndErasesWhole) {
  ToolBench b;
  acceptedSquare(b, 100, 100, 200);
  mode(b, ToolMode::Eraser);
  b.tool.setBrushRadius(24);
  b.press(200, 200);
  b.release(200, 200);
  ASSERT_EQ(b.contours.polygons.size(), 2u) << "the square as it was, and a hole";
  EXPECT_EQ(b.contours.polygons[0].points_lps_mm.cols(), 4);
  EXPECT_EQ(b.contours.polygons[1].state, PolygonState::Accepted);
  EXPECT_NEAR(roi::area_mm2(b.contours), 2500.0 - pi * 36.0, 0.02 * pi * 36.0);
  b.drag(200, 80, 200, 320);
  ASSERT_EQ(b.contours.polygons.size(), 2u) << "two parts";
  EXPECT_NEAR(roi::area_mm2(b.contours), 2500.0 - 12.0 * 50.0, 8.0);
  b.tool.setBrushRadius(150);
  b.drag(200, 200, 201, 200);
  EXPECT_TRUE(b.contours.polygons.empty());
  b.press(200, 200);
  b.release(200, 200);
  EXPECT_EQ(b.tool.message().text, say::nothingToErase);
  for (int n = 0; n < 3; ++n) b.undo.undo(b.contours);
  ASSERT_EQ(b.contours.polygons.size(), 1u);
  EXPECT_NEAR(roi::area_mm2(b.contours), 2500.0, 1e-9);
}

TEST(BrushTool, KeepsToTheTissueItWasPressedOn) {
  for (const bool bright : {false, true}) {
    ToolBench b;
    b.tool.setImage(twoTissues(b, 6.0));
    mode(b, ToolMode::Brush);
    b.tool.setBrushRadius(50);
    const double x = bright ? 300 : 180;
    b.press(x, 150);
    b.move(bright ? 270 : 210, 200);
    b.move(bright ? 265 : 215, 260);
    b.release(bright ? 265 : 215, 260);
    ASSERT_EQ(b.contours.polygons.size(), 1u);
    double over = -1e9, length = 0.0;
    const Eigen::Matrix3Xd& points = b.contours.polygons[0].points_lps_mm;
    for (Eigen::Index v = 0; v < points.cols(); ++v) {
      const Eigen::Vector2d p = b.plane.toPixel(points.col(v)),
                            q = b.plane.toPixel(points.col((v + 1) % points.cols()));
      over = std::max(over, bright ? 240.0 - p.x() : p.x() - 240.0);
      if (std::abs(p.x() - 240.0) < 4.0 && std::abs(q.x() - 240.0) < 4.0) length += std::abs(p.y() - q.y());
    }
    EXPECT_LT(over, 4.0) << "more than half a pixel of the image (6 px of the view) over the edge";
    EXPECT_GT(length, 80.0) << "it runs along the edge";
    // With Shift the disc takes what lies under it.
    b.press(240, 420, shift);
    b.release(240, 420, shift);
    const std::size_t last = b.contours.polygons.size() - 1;
    EXPECT_NEAR(area_mm2(b, last), pi * 50.0 * 50.0 / 16.0, 0.02 * pi * 50.0 * 50.0 / 16.0);
  }
}

TEST(EraserTool, TakesTheTissueItWasPressedOnBackToTheEdge) {
  ToolBench b;
  b.tool.setImage(twoTissues(b, 6.0));
  acceptedSquare(b, 140, 140, 160);  // 60 px too far over the edge at 240
  mode(b, ToolMode::Eraser);
  b.tool.setBrushRadius(50);
  b.press(290, 120);
  for (int y = 120; y <= 320; y += 10) b.move(275, y);
  b.release(275, 320);
  ASSERT_EQ(b.contours.polygons.size(), 1u);
  EXPECT_NEAR(area_mm2(b, 0), 100.0 * 160.0 / 16.0, 35.0);
  for (const auto p : b.contours.polygons[0].points_lps_mm.colwise()) EXPECT_LT(b.plane.toPixel(p).x(), 246.0);
}

TEST(Combine, UnionDifferenceAndIntersectionOfTheSelectedOutline) {
  const struct {
    SetOperation operation;
    double mm2;
    const char* said;
  } cases[] = {{SetOperation::Union, 2.0 * 1600.0 - 625.0, say::united},
               {SetOperation::Difference, 1600.0 - 625.0, say::takenOut},
               {SetOperation::Intersection, 625.0, say::shared}};
  for (const auto& c : cases) {
    ToolBench b;
    acceptedSquare(b, 100, 100, 160);
    const Eigen::Vector3d corner = b.contours.polygons[0].points_lps_mm.col(0);
    b.apply({AddPolygon{[&] {
      roi::Polygon knife = b.contours.polygons[0];
      knife.state = PolygonState::Draft;
      for (auto p : knife.points_lps_mm.colwise()) p = b.plane.toLps(b.plane.toPixel(p) + Eigen::Vector2d(60, 60));
      return knife;
    }()}});
    b.tool.selectPolygon(1);
    const std::size_t steps = b.undo.size();
    const auto before = b.contours.polygons;
    b.apply(b.tool.combine(c.operation, b.plane));
    EXPECT_EQ(b.undo.size(), steps + 1);
    ASSERT_EQ(b.contours.polygons.size(), 1u);
    EXPECT_EQ(b.contours.polygons[0].state, PolygonState::Accepted) << "what counted goes on to count";
    EXPECT_NEAR(area_mm2(b, 0), c.mm2, 1e-6);
    EXPECT_EQ(holdsVertex(b.contours.polygons[0], corner), c.operation != SetOperation::Intersection);
    EXPECT_EQ(b.tool.message().text, c.said);
    EXPECT_EQ(b.tool.selected(), std::optional<std::size_t>(0));
    b.undo.undo(b.contours);
    ASSERT_EQ(b.contours.polygons.size(), 2u);
    for (std::size_t p = 0; p < 2; ++p) EXPECT_EQ(b.contours.polygons[p].points_lps_mm, before[p].points_lps_mm);
    b.undo.redo(b.contours);
    EXPECT_NEAR(area_mm2(b, 0), c.mm2, 1e-6);
  }
}

TEST(Combine, AHoleIsFilledByUnionAndStaysWhereItIsNotTouched) {
  ToolBench b;
  acceptedSquare(b, 100, 100, 240);
  acceptedSquare(b, 150, 150, 40);  // drawn inside: a hole
  ASSERT_EQ(b.contours.polygons.size(), 2u);
  ASSERT_NEAR(roi::area_mm2(b.contours), 3600.0 - 100.0, 1e-6);
  b.tool.selectPolygon(1);
  EXPECT_TRUE(b.tool.combine(SetOperation::Difference, b.plane).empty());
  EXPECT_EQ(b.tool.message().text, say::combinedAlready);
  b.apply(b.tool.combine(SetOperation::Union, b.plane));
  ASSERT_EQ(b.contours.polygons.size(), 1u);
  EXPECT_EQ(b.contours.polygons[0].points_lps_mm.cols(), 4);
  EXPECT_NEAR(roi::area_mm2(b.contours), 3600.0, 1e-6);
}

TEST(Combine, SaysWhyNothingIsDone) {
  ToolBench b;
  EXPECT_TRUE(b.tool.combine(SetOperation::Union, b.plane).empty());
  EXPECT_EQ(b.tool.message().text, say::selectFirst);
  acceptedSquare(b, 100, 100, 80);
  acceptedSquare(b, 300, 300, 60);
  b.tool.selectPolygon(1);
  EXPECT_TRUE(b.tool.combine(SetOperation::Union, b.plane).empty());
  EXPECT_EQ(b.tool.message().text, say::meetsNone);
  // One that covers another leaves nothing of it; one of another kind is no partner.
  roi::Polygon large = b.contours.polygons[0];
  for (auto p : large.points_lps_mm.colwise())
    p = b.plane.toLps(Eigen::Vector2d(140, 140) + 1.5 * (b.plane.toPixel(p) - Eigen::Vector2d(140, 140)));
  b.apply({AddPolygon{large}});
  b.tool.selectPolygon(2);
  EXPECT_TRUE(b.tool.combine(SetOperation::Difference, b.plane).empty());
  EXPECT_EQ(b.tool.message().text, say::nothingLeft);
  b.apply(b.tool.setKind(true));
  EXPECT_TRUE(b.tool.combine(SetOperation::Difference, b.plane).empty());
  EXPECT_EQ(b.tool.message().text, say::meetsNone);
}

TEST(Combine, PartsUnderFourVoxelsGoAndAreTold) {
  ToolBench b;
  acceptedSquare(b, 100, 100, 120);
  roi::Polygon knife = b.contours.polygons[0];
  // Leaves the lower part, and a tip of 4 × 4 px (a pixel is 6 × 8) at the upper left corner.
  knife.points_lps_mm.resize(3, 4);
  knife.points_lps_mm << b.plane.toLps({114, 90}), b.plane.toLps({240, 90}), b.plane.toLps({240, 160}),
      b.plane.toLps({90, 114});
  b.apply({AddPolygon{knife}});
  b.tool.selectPolygon(1);
  b.apply(b.tool.combine(SetOperation::Difference, b.plane));
  EXPECT_EQ(b.contours.polygons.size(), 1u);
  EXPECT_EQ(b.tool.message().text, say::smallParts);
  EXPECT_EQ(b.tool.message().values, std::vector<std::string>({"4", "1"}));
}

}  // namespace
}  // namespace glisson::tools
