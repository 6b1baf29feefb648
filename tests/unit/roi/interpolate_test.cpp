// SPDX-License-Identifier: GPL-3.0-or-later
#include "roi/interpolate.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "roi/plane.h"
#include "roi/polygon.h"
#include "shapes.h"
#include "support/support.h"

namespace glisson::roi {
namespace {

using namespace test;

/// A lattice of shapes.h with room for larger outlines and more slices.
image::Grid roomy(image::Grid g, int slices = 9) {
  g.size = {70, 64, slices};
  return g;
}

/// A circle in millimetres around the middle of slice k.
Polygon circle(const image::Grid& g, int k, double radius_mm, double shift_mm = 0.0) {
  std::vector<std::pair<double, double>> ring;
  for (int v = 0; v < 90; ++v) {
    const double angle = v * std::numbers::pi / 45;
    ring.emplace_back(0.5 * g.size.x() + (shift_mm + radius_mm * std::cos(angle)) / g.spacing_mm.x(),
                      0.5 * g.size.y() + radius_mm * std::sin(angle) / g.spacing_mm.y());
  }
  return polygon(g, k, ring);
}

std::vector<std::uint8_t> slice(const image::Mask& m, int k) {
  const auto n = static_cast<std::ptrdiff_t>(m.grid.linear(0, 0, 1));
  return {m.values.begin() + k * n, m.values.begin() + (k + 1) * n};
}

TEST(InterpolateBetween, DrawnPolygonsStayAndNothingLiesOutside) {
  for (const image::Grid& lattice : grids()) {
    const image::Grid g = roomy(lattice);
    const ContourStack drawn = stack({circle(g, 2, 12), circle(g, 6, 17, 2)});
    EXPECT_EQ(emptySlicesBetween(drawn, g), (std::vector<int>{3, 4, 5}));
    const ContourStack full = interpolateBetween(drawn, g);
    ASSERT_GT(full.polygons.size(), drawn.polygons.size());
    for (std::size_t p = 0; p < full.polygons.size(); ++p) {
      if (p < 2) {
        EXPECT_EQ(full.polygons[p].points_lps_mm, drawn.polygons[p].points_lps_mm);
        EXPECT_EQ(full.polygons[p].state, PolygonState::Accepted);
        continue;
      }
      EXPECT_EQ(full.polygons[p].state, PolygonState::Interpolated);
      EXPECT_FALSE(selfCrosses(full.polygons[p]));
      const double k = sliceOf(full.polygons[p], g);
      EXPECT_NEAR(k, std::round(k), 1e-9);
      EXPECT_GT(k, 2.5);
      EXPECT_LT(k, 5.5);
    }
    const image::Mask before = rasterise(drawn, g), after = rasterise(full, g);
    for (const int k : {0, 1, 2, 6, 7, 8}) EXPECT_EQ(slice(before, k), slice(after, k));
    EXPECT_TRUE(emptySlicesBetween(full, g).empty());
    EXPECT_EQ(interpolateBetween(full, g).polygons.size(), full.polygons.size());
  }
}

TEST(InterpolateBetween, BetweenEqualOutlinesLiesTheSame) {
  for (const image::Grid& lattice : grids()) {
    const image::Grid g = roomy(lattice, 5);
    Polygon hole = rectangle(g, 1, 30.5, 28.5, 36.5, 33.5), holeAbove = rectangle(g, 3, 30.5, 28.5, 36.5, 33.5);
    Polygon out = rectangle(g, 1, 40.5, 30.5, 66.5, 36.5), outAbove = rectangle(g, 3, 40.5, 30.5, 66.5, 36.5);
    out.exclude = outAbove.exclude = true;
    const ContourStack drawn = stack({circle(g, 1, 15), hole, out, circle(g, 3, 15), holeAbove, outAbove});
    const image::Mask m = rasterise(interpolateBetween(drawn, g), g);
    EXPECT_EQ(slice(m, 2), slice(m, 1));
    EXPECT_EQ(slice(m, 3), slice(m, 1));
    EXPECT_EQ(voxels(m), 3 * voxels(rasterise(drawn, g)) / 2);
  }
}

// The distance to concentric circles of radii r1 and r2 is r1 − r and r2 − r, so level 0 lies at (1 − t) r1 + t r2.
TEST(InterpolateBetween, RadiusGoesLinearly) {
  for (const image::Grid& lattice : grids()) {
    const image::Grid g = roomy(lattice);
    const double r1 = 9.0, r2 = 20.0;
    const ContourStack full = interpolateBetween(stack({circle(g, 1, r1), circle(g, 7, r2)}), g);
    const double pixel_mm = g.spacing_mm.head<2>().maxCoeff();
    int seen = 0;
    for (const Polygon& p : full.polygons) {
      if (p.state != PolygonState::Interpolated) continue;
      ++seen;
      const double t = (sliceOf(p, g) - 1.0) / 6.0;
      const Eigen::Vector3d middle = g.indexToLps({0.5 * g.size.x(), 0.5 * g.size.y(), 1.0 + 6.0 * t});
      for (const auto& v : p.points_lps_mm.colwise())
        EXPECT_NEAR((v - middle).norm(), (1.0 - t) * r1 + t * r2, pixel_mm);
    }
    EXPECT_EQ(seen, 5);
  }
}

TEST(InterpolateBetween, PolygonsHoldWhatTheMaskHolds) {
  for (const image::Grid& lattice : grids()) {
    const image::Grid g = roomy(lattice);
    const ContourStack drawn = stack({circle(g, 0, 12, -3), circle(g, 4, 19), circle(g, 8, 8, 5)});
    const image::Mask byPolygon = rasterise(interpolateBetween(drawn, g), g);
    const image::Mask byMask = interpolateSlices(rasterise(drawn, g));
    // Simplification moves an edge by a fifth of a pixel at most: only centres nearer than that may change side.
    std::size_t different = 0;
    for (std::size_t v = 0; v < byMask.values.size(); ++v)
      different += byMask.values[v] != byPolygon.values[v] ? 1U : 0U;
    EXPECT_LT(static_cast<double>(different), 0.02 * static_cast<double>(voxels(byMask)));
  }
}

// All slices but the outer two of the letter F are taken away: what both ends hold is held between, what neither holds
// is not.
TEST(InterpolateSlices, LetterFOnAnObliqueLattice) {
  const image::Mask f = glisson::test::letterF();
  const image::Mask known = interpolateSlices(f);
  EXPECT_EQ(known.values, f.values);
  std::vector<int> with;
  for (int k = 0; k < f.grid.size.z(); ++k) {
    const auto s = slice(f, k);
    if (std::count(s.begin(), s.end(), 1) > 0) with.push_back(k);
  }
  ASSERT_GE(with.size(), 3u);
  image::Mask thinned = f;
  const auto n = static_cast<std::ptrdiff_t>(f.grid.linear(0, 0, 1));
  for (std::size_t s = 1; s + 1 < with.size(); ++s)
    std::fill_n(thinned.values.begin() + with[s] * n, n, std::uint8_t{0});
  const image::Mask back = interpolateSlices(thinned);
  const ContourStack outlines = interpolateBetween(contoursOf(thinned), f.grid);
  const image::Mask fromOutlines = rasterise(outlines, f.grid);
  std::size_t different = 0;
  const auto first = slice(f, with.front()), last = slice(f, with.back());
  for (const int k : with) {
    const auto filled = slice(back, k), drawn = slice(fromOutlines, k);
    for (std::size_t v = 0; v < filled.size(); ++v) {
      if (first[v] == last[v]) {
        EXPECT_EQ(filled[v], first[v]);
      }
      different += filled[v] != drawn[v] ? 1U : 0U;
    }
  }
  for (int k = 0; k < f.grid.size.z(); ++k)
    if (k < with.front() || k > with.back()) {
      const auto s = slice(back, k);
      EXPECT_EQ(std::count(s.begin(), s.end(), 1), 0);
    }
  EXPECT_LT(static_cast<double>(different), 0.02 * static_cast<double>(voxels(back)));
}

TEST(InterpolateBetween, DisjointShapesLeaveTheMiddleEmpty) {
  const image::Grid g = roomy(grids()[0], 3);
  const ContourStack drawn = stack({rectangle(g, 0, 2, 2, 9, 9), rectangle(g, 2, 40, 40, 49, 49)});
  EXPECT_EQ(interpolateBetween(drawn, g).polygons.size(), 2u);
  EXPECT_EQ(emptySlicesBetween(drawn, g), std::vector<int>{1});
}

TEST(InterpolateBetween, DraftsDoNotCountAndNothingIsNothing) {
  const image::Grid g = roomy(grids()[2]);
  Polygon draft = circle(g, 6, 10);
  draft.state = PolygonState::Draft;
  EXPECT_EQ(interpolateBetween(stack({circle(g, 2, 10), draft}), g).polygons.size(), 2u);
  EXPECT_THROW(interpolateSlices(image::Mask(g)), BadInput);
}

}  // namespace
}  // namespace glisson::roi
