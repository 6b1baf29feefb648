// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/outline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/random.h"

namespace glisson::tools {
namespace {

Outline polygon(int n, double radius) {
  Outline o(2, n);
  for (int i = 0; i < n; ++i) {
    const double a = 2.0 * std::numbers::pi * i / n;
    o.col(i) << radius * std::cos(a), radius * std::sin(a);
  }
  return o;
}

TEST(Outline, AreaOfARegularPolygon) {
  EXPECT_NEAR(signedArea(polygon(12, 3.0)), 0.5 * 12 * 9.0 * std::sin(2.0 * std::numbers::pi / 12), 1e-12);
}

TEST(Outline, ConvexNeverCrossesAndAStarAlwaysDoes) {
  const Outline convex = polygon(25, 10.0);
  EXPECT_FALSE(crossesItself(convex, true));
  Outline star(2, 5);
  for (int i = 0; i < 5; ++i) star.col(i) = polygon(5, 4.0).col((2 * i) % 5);
  EXPECT_TRUE(crossesItself(star, true));
}

TEST(Outline, OnlyTheClosingEdgeCrosses) {
  Outline hook(2, 5);
  hook << 0, 10, 10, 5, 5, 0, 0, 10, 10, -5;
  hook.col(4) << 5, -5;  // from (5, 10) down through the first edge
  EXPECT_TRUE(crossesItself(hook, false));
  Outline open(2, 4);
  open << 0, 10, 5, 5, 0, 0, 5, 1;  // the edge back to (0, 0) stays clear of the others
  EXPECT_FALSE(crossesItself(open, false));
}

TEST(Outline, SimplifiedLineStaysWithinTheTolerance) {
  Random random(7);
  Outline line(2, 400);
  for (int i = 0; i < 400; ++i) line.col(i) << 0.2 * i, 3.0 * std::sin(0.05 * i) + 0.2 * random.normal();
  for (const double tolerance : {0.01, 0.1, 0.5, 2.0}) {
    const auto kept = simplify(line, tolerance);
    ASSERT_GE(kept.size(), 2u);
    EXPECT_EQ(kept.front(), 0);
    EXPECT_EQ(kept.back(), 399);
    for (std::size_t s = 0; s + 1 < kept.size(); ++s)
      for (Eigen::Index i = kept[s]; i <= kept[s + 1]; ++i)
        EXPECT_LE(distanceToSegment(line.col(i), line.col(kept[s]), line.col(kept[s + 1])), tolerance);
  }
}

TEST(Outline, StraightLineKeepsItsEndsOnly) {
  Outline line(2, 50);
  for (int i = 0; i < 50; ++i) line.col(i) << i, 2.0 * i;
  EXPECT_EQ(simplify(line, 1e-9).size(), 2u);
}

TEST(Outline, CountsDistinctPoints) {
  Outline o(2, 4);
  o << 0, 1, 0, 1, 0, 1, 0, 1;
  EXPECT_EQ(distinctPoints(o, 1e-9), 2);
}

TEST(Outline, InsideAgreesWithTheCircleItApproaches) {
  const Outline circle = polygon(2000, 10.0);
  Random random(3);
  for (int n = 0; n < 2000; ++n) {
    const Eigen::Vector2d p(random.uniform(-12.0, 12.0), random.uniform(-12.0, 12.0));
    if (std::abs(p.norm() - 10.0) > 1e-3) {
      EXPECT_EQ(inside(p, circle), p.norm() < 10.0);
    }
  }
}

}  // namespace
}  // namespace glisson::tools
