// SPDX-License-Identifier: GPL-3.0-or-later
#include "roi/agreement.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/random.h"
#include "shapes.h"

namespace glisson::roi {
namespace {

using namespace test;

image::Mask box(const image::Grid& g, const Eigen::Vector3i& low, const Eigen::Vector3i& high) {
  image::Mask m(g);
  for (int k = low.z(); k < high.z(); ++k)
    for (int j = low.y(); j < high.y(); ++j)
      for (int i = low.x(); i < high.x(); ++i) m.at(i, j, k) = 1;
  return m;
}

image::Grid lattice() {
  image::Grid g = grids()[2];
  g.size = {40, 30, 16};
  g.spacing_mm = {1.5, 2.0, 3.0};
  return g;
}

// A box moved by s voxels: |A ∩ B| = (n − s) of n slabs, the border moves by s spacings.
TEST(Agreement, ShiftedBox) {
  const image::Grid g = lattice();
  const image::Mask a = box(g, {5, 5, 4}, {25, 20, 12}), b = box(g, {9, 5, 4}, {29, 20, 12});
  const Agreement r = agreement(a, b);
  EXPECT_NEAR(r.dice, 16.0 / 20.0, 1e-12);
  EXPECT_NEAR(r.jaccard, 16.0 / 24.0, 1e-12);
  EXPECT_NEAR(r.hausdorff_mm, 4 * 1.5, 1e-9);
  EXPECT_GT(r.meanSurfaceDistance_mm, 0.0);
  EXPECT_LT(r.meanSurfaceDistance_mm, r.hausdorff95_mm);
  EXPECT_LE(r.hausdorff95_mm, r.hausdorff_mm);
  EXPECT_NEAR(r.volumeA_mL, 20 * 15 * 8 * 9e-3, 1e-9);
  EXPECT_EQ(r.volumeDifference_mL, 0.0);
  const Agreement outlines = agreement(a, b, Border::Outline);
  EXPECT_NEAR(outlines.hausdorff_mm, 6.0, 1e-9);
}

// One box inside another, one voxel on each side: every border voxel of the inner one has the outer border beside it.
TEST(Agreement, NestedBoxes) {
  const image::Grid g = lattice();
  const image::Mask inner = box(g, {6, 6, 5}, {24, 19, 11}), outer = box(g, {5, 5, 4}, {25, 20, 12});
  const Agreement r = agreement(inner, outer);
  const double a = 18 * 13 * 6, b = 20 * 15 * 8;
  EXPECT_NEAR(r.dice, 2 * a / (a + b), 1e-12);
  EXPECT_NEAR(r.jaccard, a / b, 1e-12);
  EXPECT_NEAR(r.volumeDifference_percent, 200 * (b - a) / (a + b), 1e-9);
  EXPECT_NEAR(r.hausdorff_mm, std::sqrt(1.5 * 1.5 + 4.0 + 9.0), 1e-6);  // corner to corner
  EXPECT_EQ(r.slicesOnlyInA.size(), 0u);
  EXPECT_EQ(r.slicesOnlyInB, (std::vector<int>{4, 11}));
  // In the slices every outer border pixel is one step away, at the corners along the diagonal.
  const Agreement outlines = agreement(inner, outer, Border::Outline);
  EXPECT_NEAR(outlines.hausdorff_mm, 2.5, 1e-9);
}

TEST(Agreement, IdentityAndSymmetry) {
  const image::Grid g = lattice();
  Random random(4);
  for (int round = 0; round < 5; ++round) {
    image::Mask a(g), b(g);
    for (std::size_t v = 0; v < a.values.size(); ++v) {
      a.values[v] = random.uniform() < 0.02 ? 1 : 0;
      b.values[v] = random.uniform() < 0.03 ? 1 : 0;
    }
    const Agreement same = agreement(a, a), ab = agreement(a, b), ba = agreement(b, a);
    EXPECT_EQ(same.dice, 1.0);
    EXPECT_EQ(same.hausdorff_mm, 0.0);
    EXPECT_EQ(ab.dice, ba.dice);
    EXPECT_EQ(ab.hausdorff_mm, ba.hausdorff_mm);
    EXPECT_NEAR(ab.meanSurfaceDistance_mm, ba.meanSurfaceDistance_mm, 1e-9);
    EXPECT_NEAR(ab.jaccard, ab.dice / (2.0 - ab.dice), 1e-12);
    EXPECT_EQ(ab.volumeDifference_mL, -ba.volumeDifference_mL);
  }
}

TEST(Agreement, RefusesWhatCannotBeCompared) {
  const image::Grid g = lattice();
  const image::Mask a = box(g, {5, 5, 4}, {9, 9, 6});
  EXPECT_THROW(agreement(a, image::Mask(g)), BadInput);
  image::Grid other = g;
  other.spacing_mm.x() = 2.0;
  EXPECT_THROW(agreement(a, image::Mask(other, 1)), BadInput);
  EXPECT_THROW(agreement(a, box(g, {5, 5, 8}, {9, 9, 9}), Border::Outline), BadInput);
}

}  // namespace
}  // namespace glisson::roi
