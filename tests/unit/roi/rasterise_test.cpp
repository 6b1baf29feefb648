// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <limits>

#include "base/error.h"
#include "base/random.h"
#include "shapes.h"

namespace glisson::roi {
namespace {

using namespace test;

TEST(Rasterise, SquareOnPixelBordersHoldsItsPixels) {
  for (const image::Grid& g : grids()) {
    const image::Mask m = rasterise(stack({rectangle(g, 2, 2.5, 3.5, 8.5, 7.5)}), g);
    EXPECT_EQ(voxels(m), 24u);
    for (int j = 4; j < 8; ++j)
      for (int i = 3; i < 9; ++i) EXPECT_EQ(m.at(i, j, 2), 1);
  }
}

// Half a pixel on: every border runs through voxel centres, and the tie rule takes the low side and leaves the high
// side.
TEST(Rasterise, SquareThroughCentresTakesTheLowSideOnly) {
  for (const image::Grid& g : grids()) {
    const image::Mask m = rasterise(stack({rectangle(g, 2, 3, 4, 9, 8)}), g);
    EXPECT_EQ(voxels(m), 24u);
    EXPECT_EQ(m.at(3, 4, 2), 1);
    EXPECT_EQ(m.at(3, 7, 2), 1);
    EXPECT_EQ(m.at(8, 4, 2), 1);
    EXPECT_EQ(m.at(9, 5, 2), 0);
    EXPECT_EQ(m.at(5, 8, 2), 0);
    EXPECT_EQ(m.at(9, 8, 2), 0);
  }
}

// Triangles that fan out from centre to centre share edges through centres: every voxel is held exactly once.
TEST(Rasterise, PolygonsThatShareEdgesPartitionTheVoxels) {
  Random random(11);
  for (const image::Grid& g : grids())
    for (int round = 0; round < 20; ++round) {
      auto at = [&](int low, int high) {
        return low + static_cast<double>(random.below(static_cast<std::uint64_t>(high - low)));
      };
      const std::pair<double, double> middle{at(8, 14), at(7, 12)};
      const std::vector<std::pair<double, double>> ring = {{1, 1},   {at(4, 20), 1},  {22, 1}, {22, at(4, 16)},
                                                           {22, 18}, {at(4, 20), 18}, {1, 18}, {1, at(4, 16)}};
      std::vector<int> held(g.voxelCount(), 0);
      for (std::size_t t = 0; t < ring.size(); ++t) {
        const image::Mask m = rasterise(stack({polygon(g, 1, {middle, ring[t], ring[(t + 1) % ring.size()]})}), g);
        for (std::size_t v = 0; v < held.size(); ++v) held[v] += m.values[v];
      }
      const image::Mask whole = rasterise(stack({rectangle(g, 1, 1, 1, 22, 18)}), g);
      EXPECT_EQ(voxels(whole), 21u * 17u);
      for (std::size_t v = 0; v < held.size(); ++v) ASSERT_EQ(held[v], whole.values[v]);
    }
}

TEST(Rasterise, VertexOrderAndStartDoNotMatter) {
  const image::Grid g = grids()[4];
  const std::vector<std::pair<double, double>> ring = {{2, 3}, {11.3, 2.2}, {19, 9}, {12, 17}, {7, 9.5}, {3, 15}};
  const image::Mask m = rasterise(stack({polygon(g, 2, ring)}), g);
  auto turned = ring;
  for (std::size_t s = 0; s < ring.size(); ++s) {
    std::rotate(turned.begin(), turned.begin() + 1, turned.end());
    EXPECT_EQ(rasterise(stack({polygon(g, 2, turned)}), g).values, m.values);
    const std::vector<std::pair<double, double>> reversed(turned.rbegin(), turned.rend());
    EXPECT_EQ(rasterise(stack({polygon(g, 2, reversed)}), g).values, m.values);
  }
}

TEST(Rasterise, InnerPolygonIsAHoleAndExclusionIsTakenOut) {
  for (const image::Grid& g : grids()) {
    const Polygon outer = rectangle(g, 2, 2.5, 2.5, 14.5, 14.5);
    const Polygon inner = rectangle(g, 2, 5.5, 5.5, 8.5, 8.5);
    EXPECT_EQ(voxels(rasterise(stack({outer, inner}), g)), 144u - 9u);
    Polygon excluded = rectangle(g, 2, 12.5, 12.5, 18.5, 18.5);
    excluded.exclude = true;
    // Half of the exclusion lies outside: it takes away, it never adds.
    EXPECT_EQ(voxels(rasterise(stack({excluded, outer, inner}), g)), 144u - 9u - 4u);
    // Exclusions that overlap are a union.
    EXPECT_EQ(voxels(rasterise(stack({excluded, excluded, outer}), g)), 144u - 4u);
    Polygon draft = rectangle(g, 2, 16.5, 2.5, 20.5, 6.5);
    draft.state = PolygonState::Draft;
    EXPECT_EQ(voxels(rasterise(stack({outer, draft}), g)), 144u);
  }
}

TEST(Rasterise, PolygonBelongsToTheNearestSlice) {
  for (const image::Grid& g : grids()) {
    EXPECT_EQ(rasterise(stack({rectangle(g, 2.4, 2.5, 2.5, 5.5, 5.5)}), g).at(4, 4, 2), 1);
    EXPECT_EQ(rasterise(stack({rectangle(g, 2.5, 2.5, 2.5, 5.5, 5.5)}), g).at(4, 4, 2), 1);  // half-way: the lower one
    EXPECT_EQ(rasterise(stack({rectangle(g, -0.4, 2.5, 2.5, 5.5, 5.5)}), g).at(4, 4, 0), 1);
    // Two planes on one slice do not cancel each other: the nearer one counts.
    const image::Mask m =
        rasterise(stack({rectangle(g, 1.7, 2.5, 2.5, 5.5, 5.5), rectangle(g, 2.1, 2.5, 2.5, 6.5, 5.5)}), g);
    EXPECT_EQ(voxels(m), 12u);
  }
}

TEST(Rasterise, ReachesBeyondTheImageAreCut) {
  const image::Grid g = grids()[2];
  EXPECT_EQ(voxels(rasterise(stack({rectangle(g, 0, -50, -50, 500, 500)}), g)), 24u * 20u);
}

TEST(Rasterise, RefusesWhatDoesNotMeetTheGrid) {
  const image::Grid g = grids()[2];
  EXPECT_THROW(rasterise(ContourStack{}, g), BadInput);
  EXPECT_THROW(rasterise(stack({rectangle(g, 5.6, 2, 2, 9, 9)}), g), BadInput);
  EXPECT_THROW(rasterise(stack({rectangle(g, 2, 102, 2, 109, 9)}), g), BadInput);
  Polygon draft = rectangle(g, 2, 2, 2, 9, 9);
  draft.state = PolygonState::Draft;
  EXPECT_THROW(rasterise(stack({draft}), g), BadInput);
  Polygon two = rectangle(g, 2, 2, 2, 9, 9);
  two.points_lps_mm.conservativeResize(3, 2);
  EXPECT_THROW(rasterise(stack({two}), g), BadInput);
  Polygon nan = rectangle(g, 2, 2, 2, 9, 9);
  nan.points_lps_mm(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(rasterise(stack({nan}), g), BadInput);
}

TEST(Rasterise, RefusesTilt) {
  const image::Grid g = grids()[2];
  for (const double degrees : {0.9, 20.0, 90.0}) {
    Polygon p = rectangle(g, 2, 3.5, 3.5, 8.5, 8.5);
    const Eigen::Vector3d centre = p.points_lps_mm.rowwise().mean();
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(degrees * std::numbers::pi / 180.0, g.direction.col(0)).toRotationMatrix();
    p.points_lps_mm = (turn * (p.points_lps_mm.colwise() - centre)).colwise() + centre;
    if (degrees < 1.0) {
      EXPECT_EQ(voxels(rasterise(stack({p}), g)), 25u);
    } else {
      EXPECT_THROW(rasterise(stack({p}), g), BadInput);
    }
  }
}

TEST(Area, ClosedFormsOnEveryGrid) {
  for (const image::Grid& g : grids()) {
    const double pixel_mm2 = g.spacing_mm.x() * g.spacing_mm.y();
    const Polygon outer = rectangle(g, 2, 2, 2, 14, 14);
    const Polygon inner = rectangle(g, 2, 5, 5, 8, 8);
    EXPECT_NEAR(area_mm2(stack({outer, inner})) / pixel_mm2, 144 - 9, 1e-9);
    Polygon excluded = rectangle(g, 2, 12, 12, 18, 18);
    excluded.exclude = true;
    EXPECT_NEAR(area_mm2(stack({outer, inner, excluded, excluded})) / pixel_mm2, 144 - 9 - 4, 1e-9);
    EXPECT_NEAR(area_mm2(stack({outer, rectangle(g, 3, 0, 0, 3, 4)})) / pixel_mm2, 144 + 12, 1e-9);
    // A bow tie: even-odd, two triangles.
    EXPECT_NEAR(area_mm2(stack({polygon(g, 1, {{2, 2}, {10, 10}, {10, 2}, {2, 10}})})) / pixel_mm2, 32, 1e-9);
    // Two overlapping squares: what both hold cancels.
    EXPECT_NEAR(area_mm2(stack({outer, rectangle(g, 2, 8, 8, 18, 18)})) / pixel_mm2, 144 + 100 - 36, 1e-9);
  }
}

TEST(Area, RasterisedCircleApproachesTheTrueArea) {
  image::Grid g = grids()[4];
  g.size = {200, 200, 1};
  std::vector<std::pair<double, double>> ring;
  for (int v = 0; v < 720; ++v)
    ring.emplace_back(97.3 + 80.0 * std::cos(v * std::numbers::pi / 360),
                      101.1 + 80.0 * std::sin(v * std::numbers::pi / 360));
  const ContourStack s = stack({polygon(g, 0, ring)});
  const double pixel_mm2 = g.spacing_mm.x() * g.spacing_mm.y();
  EXPECT_NEAR(area_mm2(s) / pixel_mm2, std::numbers::pi * 6400, 1.0);
  EXPECT_NEAR(static_cast<double>(voxels(rasterise(s, g))), area_mm2(s) / pixel_mm2, 60.0);  // ~ lattice discrepancy
}

}  // namespace
}  // namespace glisson::roi
