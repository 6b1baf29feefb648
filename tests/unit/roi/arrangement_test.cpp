// SPDX-License-Identifier: GPL-3.0-or-later
#include "roi/arrangement.h"

#include <gtest/gtest.h>

#include "roi/plane.h"
#include "roi/polygon.h"
#include "shapes.h"

namespace glisson::roi {
namespace {

using namespace test;

/// 2 mm pixels, 10 mm slices.
image::Grid mre() {
  image::Grid g;
  g.size = {40, 30, 4};
  g.spacing_mm = {2.0, 2.0, 10.0};
  g.origin_lps_mm = {-17.0, 3.0, 120.0};
  return g;
}

Polygon reversed(Polygon p) {
  p.points_lps_mm = p.points_lps_mm.rowwise().reverse().eval();
  return p;
}

Polygon moved(Polygon p, double x_mm, double y_mm, double z_mm) {
  p.points_lps_mm.colwise() += Eigen::Vector3d(x_mm, y_mm, z_mm);
  return p;
}

/// The polygon shrunk towards its middle by a distance, for rectangles.
Polygon shrunk(const Polygon& p, double by_mm) {
  Polygon out = p;
  const Eigen::Vector3d centre = p.points_lps_mm.rowwise().mean();
  for (Eigen::Index v = 0; v < p.points_lps_mm.cols(); ++v)
    for (int a = 0; a < 2; ++a) out.points_lps_mm(a, v) += by_mm * (p.points_lps_mm(a, v) > centre[a] ? -1.0 : 1.0);
  return out;
}

TEST(Outlines, ARepeatedOneCountsOnceHoweverItIsDrawn) {
  const image::Grid g = mre();
  const Polygon one = rectangle(g, 1, 4.5, 3.5, 24.5, 13.5);
  for (const Polygon& again : {one, reversed(one), moved(one, 0.01, 0.01, 0.0), shrunk(one, 0.2), shrunk(one, -0.3)}) {
    const ContourStack both = stack({one, again});
    EXPECT_EQ(voxels(rasterise(both, g)), 200u);
    EXPECT_NEAR(area_mm2(both), 800.0, 40.0);
    EXPECT_TRUE(outlineDoubts(both, g, true).contains(DiagnosticCode::OutlinesRepeated));
    EXPECT_EQ(withoutRepeats(both).polygons.size(), 1u);
  }
  EXPECT_EQ(voxels(rasterise(stack({one, reversed(one), moved(one, 0.02, 0.0, 0.0)}), g)), 200u);
  EXPECT_TRUE(outlineDoubts(stack({one}), g, true).empty());
}

TEST(Outlines, WhatOverlapsIsJoinedAndWhatTouchesIsNotDoubted) {
  const image::Grid g = mre();
  const Polygon left = rectangle(g, 1, 4.5, 3.5, 16.5, 13.5), right = rectangle(g, 1, 12.5, 3.5, 24.5, 13.5);
  EXPECT_EQ(voxels(rasterise(stack({left, right}), g)), 200u);
  EXPECT_NEAR(area_mm2(stack({left, right})), 800.0, 1e-6);
  EXPECT_TRUE(outlineDoubts(stack({left, right}), g, true).contains(DiagnosticCode::OutlinesOverlap));
  const Polygon beside = rectangle(g, 1, 16.5, 3.5, 24.5, 13.5);
  EXPECT_EQ(voxels(rasterise(stack({left, beside}), g)), 200u);
  EXPECT_TRUE(outlineDoubts(stack({left, beside}), g, true).empty());
}

TEST(Outlines, OneInsideAnotherIsAHoleAndOneInTheHoleAnIsland) {
  const image::Grid g = mre();
  const Polygon outer = rectangle(g, 1, 4.5, 3.5, 24.5, 13.5), hole = rectangle(g, 1, 10.5, 5.5, 18.5, 11.5),
                island = rectangle(g, 1, 12.5, 7.5, 14.5, 9.5);
  EXPECT_EQ(voxels(rasterise(stack({island, hole, outer}), g)), 200u - 48u + 4u);
  EXPECT_NEAR(area_mm2(stack({hole, outer, island})), 4.0 * (200 - 48 + 4), 1e-6);
  // A hole that lies in the common part of two outlines is one hole, of both.
  const Polygon left = rectangle(g, 1, 4.5, 3.5, 18.5, 13.5), right = rectangle(g, 1, 10.5, 3.5, 24.5, 13.5);
  EXPECT_EQ(voxels(rasterise(stack({left, right, rectangle(g, 1, 12.5, 5.5, 16.5, 9.5)}), g)), 200u - 16u);
  // Every outline twice: the hole stays a hole.
  EXPECT_EQ(voxels(rasterise(stack({outer, hole, moved(outer, 0.03, 0, 0), reversed(hole)}), g)), 200u - 48u);
  // A hole that runs along the border, over it by rounding.
  EXPECT_EQ(voxels(rasterise(stack({outer, rectangle(g, 1, 10.5, 3.49, 18.5, 7.5)}), g)), 200u - 32u);
}

TEST(Outlines, OnesThatFlipLeaveTheOddParts) {
  const image::Grid g = mre();
  Polygon left = rectangle(g, 1, 4.5, 3.5, 16.5, 13.5), right = rectangle(g, 1, 12.5, 3.5, 24.5, 13.5);
  left.combine = right.combine = Combine::Parity;
  EXPECT_EQ(voxels(rasterise(stack({left, right}), g)), 160u);
  EXPECT_NEAR(area_mm2(stack({left, right})), 640.0, 1e-6);
  // Doubled by mistake they do not vanish.
  EXPECT_EQ(voxels(rasterise(stack({left, left}), g)), 120u);
  const Polygon whole = rectangle(g, 1, 4.5, 3.5, 24.5, 13.5);
  EXPECT_EQ(voxels(rasterise(stack({whole, right}), g)), 80u);
}

TEST(Outlines, ALobeDrawnAtAnotherHeightOfTheSliceCounts) {
  const image::Grid g = mre();
  ContourStack s;
  for (int k = 0; k < 4; ++k) {
    s.polygons.push_back(rectangle(g, k, 4.5, 3.5, 14.5, 13.5));
    s.polygons.push_back(moved(rectangle(g, k, 14.5, 3.5, 24.5, 13.5), 0.0, 0.0, k == 1 ? 1.5 : 0.0));
  }
  EXPECT_EQ(voxels(rasterise(s, g)), 800u);
  const Diagnostics doubts = outlineDoubts(s, g, true);
  EXPECT_TRUE(doubts.contains(DiagnosticCode::OutlinesOffPlane));
  EXPECT_EQ(outlinesOf(s, g).offPlane, std::vector<std::size_t>{3});
  // Drawn again at that height, overlapping: the nearer one counts, and the other is named.
  s.polygons.push_back(moved(rectangle(g, 2, 4.5, 3.5, 12.5, 13.5), 0.0, 0.0, 2.0));
  EXPECT_EQ(voxels(rasterise(s, g)), 800u);
  EXPECT_TRUE(outlineDoubts(s, g, true).contains(DiagnosticCode::OutlinesLeftOut));
}

// Outlines on every millimetre, slices of 10 mm: the second lobe begins one millimetre above a slice's middle and is no
// part of that slice.
TEST(Outlines, AFinerStackIsSampledAtTheMiddleOfEachSlice) {
  const image::Grid g = mre();
  ContourStack s;
  for (int z = 0; z <= 30; ++z) {
    s.polygons.push_back(rectangle(g, 0.1 * z, 4.5, 3.5, 14.5, 13.5));
    if (z > 10) s.polygons.push_back(rectangle(g, 0.1 * z, 16.5, 3.5, 24.5, 13.5));
  }
  const image::Mask m = rasterise(s, g);
  EXPECT_EQ(voxels(m), 4u * 100u + 2u * 80u);
  EXPECT_EQ(m.at(20, 8, 1), 0);
  EXPECT_TRUE(outlineDoubts(s, g, false).empty());
  // Nested outlines 0.4 mm apart are no holes in one another.
  ContourStack tapering;
  for (int z = 0; z <= 20; ++z) {
    const double in = 0.3 * z;
    tapering.polygons.push_back(rectangle(g, 0.04 * z + 0.6, 4.5 + in, 3.5 + in, 24.5 - in, 20.5 - in));
  }
  EXPECT_GT(voxels(rasterise(tapering, g)), 50u);
}

TEST(Outlines, SmallTiltedOnesWithRoundedCornersDoNotRefuseTheRegion) {
  image::Grid g = mre();
  g.direction = Eigen::AngleAxisd(0.21, Eigen::Vector3d::UnitX()).toRotationMatrix();
  ContourStack s = stack({rectangle(g, 1, 4.5, 3.5, 24.5, 13.5), rectangle(g, 1, 26.6, 16.7, 26.66, 16.76)});
  s.polygons[1].points_lps_mm = (100.0 * s.polygons[1].points_lps_mm).array().round() / 100.0;
  EXPECT_EQ(voxels(rasterise(s, g)), 200u);
  EXPECT_TRUE(parallelTo(s.polygons[1], g));
  EXPECT_NEAR(area_mm2(s), 800.0, 0.1);
}

TEST(Outlines, BeyondTheSlicesAreCounted) {
  const image::Grid g = mre();
  const ContourStack s = stack({rectangle(g, 1, 4.5, 3.5, 24.5, 13.5), rectangle(g, 4.2, 4.5, 3.5, 24.5, 13.5)});
  EXPECT_TRUE(outlineDoubts(s, g, true).contains(DiagnosticCode::OutlinesBeyond));
  EXPECT_FALSE(outlineDoubts(s, g, false).contains(DiagnosticCode::OutlinesBeyond));
}

// A shell of one pixel of 0.4 mm: by the rule for drawn outlines it would be one outline drawn twice.
TEST(Outlines, TracedMasksComeBackExactlyHoweverThinTheyAre) {
  image::Grid g = mre();
  g.spacing_mm = {0.4, 0.4, 3.0};
  image::Mask m(g);
  for (int j = 5; j < 25; ++j)
    for (int i = 5; i < 30; ++i)
      if (i == 5 || i == 29 || j == 5 || j == 24) m.at(i, j, 2) = 1;
  const ContourStack traced = contoursOf(m);
  EXPECT_EQ(rasterise(traced, g).values, m.values);
  EXPECT_EQ(traced.polygons.front().combine, Combine::Parity);
}

}  // namespace
}  // namespace glisson::roi
