// SPDX-License-Identifier: GPL-3.0-or-later
#include "roi/polygon.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/random.h"
#include "shapes.h"
#include "support/support.h"

namespace glisson::roi {
namespace {

using namespace test;

TEST(SelfCrosses, TellsSimpleFromCrossing) {
  for (const image::Grid& g : grids()) {
    EXPECT_FALSE(selfCrosses(rectangle(g, 2, 2, 2, 9, 9)));
    EXPECT_FALSE(selfCrosses(polygon(g, 2, {{2, 2}, {10, 2}, {10, 10}, {6, 4}, {2, 10}})));
    EXPECT_TRUE(selfCrosses(polygon(g, 2, {{2, 2}, {10, 10}, {10, 2}, {2, 10}})));
    EXPECT_FALSE(selfCrosses(polygon(g, 2, {{2, 2}, {2, 2}, {10, 2}, {10, 9}})));  // a doubled vertex is no crossing
  }
  const image::Grid upright;
  EXPECT_TRUE(selfCrosses(polygon(upright, 0, {{0, 0}, {8, 0}, {8, 4}, {4, 0}, {0, 4}})));  // vertex on an edge
}

TEST(Refusal, NamesTheReason) {
  const image::Grid g = grids()[2];
  EXPECT_FALSE(refusal(rectangle(g, 2, 2.5, 2.5, 4.5, 4.5), g).has_value());
  EXPECT_NE(refusal(rectangle(g, 2, 2.5, 2.5, 5.5, 3.5), g)->find("3 voxel"), std::string::npos);
  EXPECT_NE(refusal(polygon(g, 2, {{2, 2}, {9, 9}, {2, 2}, {9, 9}}), g)->find("2 distinct"), std::string::npos);
  EXPECT_TRUE(refusal(rectangle(g, 9, 2, 2, 9, 9), g).has_value());
}

TEST(Simplified, DropsOnlyWhatLiesWithinTheTolerance) {
  const image::Grid g = grids()[4];
  std::vector<std::pair<double, double>> ring;
  for (int v = 0; v < 100; ++v)
    ring.emplace_back(10 + 7 * std::cos(v * std::numbers::pi / 50), 10 + 7 * std::sin(v * std::numbers::pi / 50));
  const Polygon fine = polygon(g, 1, ring);
  const Polygon coarse = simplified(fine, 0.2);
  EXPECT_LT(coarse.points_lps_mm.cols(), 40);
  for (Eigen::Index v = 0; v < 100; ++v) {
    double nearest = 1e9;
    const Eigen::Index n = coarse.points_lps_mm.cols();
    for (Eigen::Index e = 0; e < n; ++e) {
      const Eigen::Vector3d a = coarse.points_lps_mm.col(e), d = coarse.points_lps_mm.col((e + 1) % n) - a;
      const Eigen::Vector3d q = fine.points_lps_mm.col(v) - a;
      nearest = std::min(nearest, (q - std::clamp(q.dot(d) / d.squaredNorm(), 0.0, 1.0) * d).norm());
    }
    EXPECT_LE(nearest, 0.2 + 1e-12);
  }
  EXPECT_EQ(simplified(fine, 1e6).points_lps_mm.cols(), 3);
  EXPECT_EQ(simplified(rectangle(g, 1, 1, 1, 5, 5), 0.0).points_lps_mm.cols(), 4);
  EXPECT_THROW(simplified(fine, -1.0), BadArgument);
}

TEST(ContoursOf, RasteriseGivesTheMaskBackExactly) {
  const image::Mask f = glisson::test::letterF();
  EXPECT_EQ(rasterise(contoursOf(f), f.grid).values, f.values);
  Random random(5);
  for (const image::Grid& g : grids())
    for (const double density : {0.02, 0.3, 0.5, 0.8, 1.0}) {
      image::Mask m(g);
      for (auto& v : m.values) v = random.uniform() < density ? 1 : 0;
      m.at(0, 0, 0) = 1;
      const ContourStack contours = contoursOf(m);
      EXPECT_EQ(rasterise(contours, g).values, m.values);
      for (const Polygon& p : contours.polygons) EXPECT_FALSE(selfCrosses(p));
    }
}

TEST(ContoursOf, RingHasAnOutlineAndAHole) {
  image::Mask m(grids()[2]);
  for (int j = 3; j < 12; ++j)
    for (int i = 3; i < 15; ++i) m.at(i, j, 2) = (i < 6 || i > 10 || j < 6 || j > 8) ? 1 : 0;
  const ContourStack contours = contoursOf(m);
  ASSERT_EQ(contours.polygons.size(), 2u);
  for (const Polygon& p : contours.polygons) EXPECT_EQ(p.points_lps_mm.cols(), 8);  // straight runs merged, corners cut
  EXPECT_THROW(contoursOf(image::Mask(grids()[0])), BadInput);
}

}  // namespace
}  // namespace glisson::roi
