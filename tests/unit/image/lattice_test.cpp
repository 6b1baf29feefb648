// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "image/components.h"
#include "image/distance.h"
#include "image/extend.h"
#include "image/morphology.h"
#include "image/resample.h"
#include "support/support.h"

namespace glisson::image {
namespace {

Grid oblique(const Eigen::Vector3i& size, const Eigen::Vector3d& spacing_mm) {
  Grid g;
  g.size = size;
  g.spacing_mm = spacing_mm;
  g.origin_lps_mm = {-20, 35, 700};
  g.direction = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -1, 2).normalized()).toRotationMatrix() *
                Eigen::Matrix3d(Eigen::Vector3d(1, -1, 1).asDiagonal());
  return g;
}

TEST(Resample, LinearFieldIsExactAndTheBorderHolds) {
  const Grid g = oblique({12, 9, 7}, {1.3, 2.1, 5});
  auto field = [](const Eigen::Vector3d& p) { return 3.0 + 0.1 * p.x() - 0.2 * p.y() + 0.05 * p.z(); };
  ScalarVolume v(g);
  for (int k = 0; k < 7; ++k)
    for (int j = 0; j < 9; ++j)
      for (int i = 0; i < 12; ++i) v.at(i, j, k) = static_cast<float>(field(g.indexToLps(Eigen::Vector3d(i, j, k))));
  Random random(4);
  for (int n = 0; n < 500; ++n) {
    const Eigen::Vector3d index(random.uniform(0, 11), random.uniform(0, 8), random.uniform(0, 6));
    EXPECT_NEAR(sampleLinear(v, g.indexToLps(index), -1.0F), field(g.indexToLps(index)), 1e-5);
  }
  EXPECT_EQ(sampleLinear(v, g.indexToLps({-0.4, 0, 0}), -1.0F), v.at(0, 0, 0));
  EXPECT_EQ(sampleLinear(v, g.indexToLps({-0.6, 0, 0}), -1.0F), -1.0F);
  EXPECT_EQ(sampleLinear(v, g.indexToLps({0, 8.6, 0}), -1.0F), -1.0F);
  v.at(5, 5, 5) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(std::isnan(sampleLinear(v, g.indexToLps({5.5, 5, 5}), -1.0F)));
  EXPECT_FALSE(std::isnan(sampleLinear(v, g.indexToLps({6, 5, 5}), -1.0F)));  // weight 0 does not spread it
}

/// Red-black over-relaxation as text books have it, on the field as it lies; odd voxels come first.
void sweepPlainly(const Mask& known, double omega, DisplacementField& u) {
  const Grid& g = u.grid;
  const Eigen::Vector3d w =
      g.spacing_mm.cwiseAbs2().cwiseInverse() / (2 * g.spacing_mm.cwiseAbs2().cwiseInverse().sum());
  for (const int parity : {1, 0})
    for (int k = 1; k + 1 < g.size.z(); ++k)
      for (int j = 1; j + 1 < g.size.y(); ++j)
        for (int i = 1; i + 1 < g.size.x(); ++i) {
          if ((i + j + k) % 2 != parity || known.at(i, j, k)) continue;
          const Eigen::Vector3f mean = static_cast<float>(w.x()) * (u.at(i - 1, j, k) + u.at(i + 1, j, k)) +
                                       static_cast<float>(w.y()) * (u.at(i, j - 1, k) + u.at(i, j + 1, k)) +
                                       static_cast<float>(w.z()) * (u.at(i, j, k - 1) + u.at(i, j, k + 1));
          u.at(i, j, k) += static_cast<float>(omega) * (mean - u.at(i, j, k));
        }
}

TEST(Extend, IsPlainOverRelaxationOnAnyGrid) {
  for (const Eigen::Vector3i& size : {Eigen::Vector3i(5, 4, 3), Eigen::Vector3i(4, 3, 6), Eigen::Vector3i(1, 2, 1)})
    for (const double margin_mm : {0.0, 2.5, 6.0}) {
      const Grid g = oblique(size, {1.3, 2.1, 3});
      DisplacementField u(g, Eigen::Vector3f::Zero());
      Mask inside(g);
      Random random(3);
      for (std::size_t n = 0; n < u.values.size(); ++n) {
        inside.values[n] = random.uniform() < 0.7;
        for (int c = 0; c < 3; ++c) u.values[n][c] = static_cast<float>(random.normal());
      }
      const DisplacementField wide = extendHarmonically(u, inside, margin_mm);
      const Eigen::Vector3i pad = (wide.grid.size - size) / 2;
      DisplacementField plain(wide.grid, Eigen::Vector3f::Zero());
      Mask known(wide.grid);
      for (int k = 0; k < size.z(); ++k)
        for (int j = 0; j < size.y(); ++j)
          for (int i = 0; i < size.x(); ++i) {
            if (!inside.at(i, j, k)) continue;
            plain.at(Eigen::Vector3i(i, j, k) + pad) = u.at(i, j, k);
            known.at(Eigen::Vector3i(i, j, k) + pad) = 1;
          }
      const int longest = pad.maxCoeff();
      const double omega = 2.0 / (1.0 + std::sin(std::acos(-1.0) / std::max(4, 2 * longest)));
      for (int sweep = 0; sweep < std::max(20, 4 * longest); ++sweep) sweepPlainly(known, omega, plain);
      for (std::size_t n = 0; n < plain.values.size(); ++n)
        EXPECT_LT((wide.values[n] - plain.values[n]).norm(), 1e-5F) << n;
    }
}

TEST(Resample, OwnGridGivesTheSameBits) {
  const Mask f = glisson::test::letterF();
  EXPECT_EQ(resampleNearest(f, f.grid).values, f.values);
  ScalarVolume v(f.grid);
  Random random(8);
  for (float& x : v.values) x = static_cast<float>(random.normal());
  EXPECT_EQ(resampleLinear(v, f.grid, 0.0F).values, v.values);
  EXPECT_EQ(resampleNearest(v, f.grid, 0.0F).values, v.values);
}

TEST(Resample, NearestTakesTheVoxelThatHoldsTheCentre) {
  const Grid coarse = oblique({5, 4, 3}, {3, 3, 6});
  Grid fine = coarse;  // every coarse voxel is 3 × 3 × 3 fine ones
  fine.size = coarse.size * 3;
  fine.spacing_mm = coarse.spacing_mm / 3.0;
  fine.origin_lps_mm = coarse.indexToLps(Eigen::Vector3d::Constant(-1.0 / 3.0));
  LabelMap labels(coarse);
  for (std::size_t i = 0; i < labels.values.size(); ++i) labels.values[i] = static_cast<std::int32_t>(i);
  const LabelMap r = resampleNearest(labels, fine);
  for (int k = 0; k < 9; ++k)
    for (int j = 0; j < 12; ++j)
      for (int i = 0; i < 15; ++i) EXPECT_EQ(r.at(i, j, k), labels.at(i / 3, j / 3, k / 3));
  EXPECT_FALSE(voxelAt(coarse, coarse.indexToLps({-0.51, 0, 0})).has_value());
  EXPECT_EQ(voxelAt(coarse, coarse.indexToLps({0.5, 0, 0}))->x(), 1);
}

/// Distance from a voxel centre to the box of another voxel, brute force.
double toBox(const Grid& g, const Eigen::Vector3i& a, const Eigen::Vector3i& b) {
  const Eigen::Vector3d gap = ((a - b).cast<double>().cwiseAbs().array() - 0.5).cwiseMax(0.0);
  return gap.cwiseProduct(g.spacing_mm).norm();
}

TEST(Distance, EqualsBruteForceOnAnisotropicGrids) {
  Random random(12);
  for (const double density : {0.02, 0.5, 0.95}) {
    const Grid g = oblique({9, 8, 6}, {0.7, 1.9, 4.0});
    Mask m(g);
    for (auto& v : m.values) v = random.uniform() < density ? 1 : 0;
    m.at(4, 4, 3) = 1;
    const ScalarVolume d = distanceToBoundary_mm(m);
    const std::vector<std::size_t> near = nearestInside(m);
    std::vector<Eigen::Vector3i> all;
    for (int k = -1; k <= 6; ++k)
      for (int j = -1; j <= 8; ++j)
        for (int i = -1; i <= 9; ++i) all.emplace_back(i, j, k);
    for (const auto& p : all) {
      if (!g.contains(p)) continue;
      double other = 1e9, centre = 1e9;
      for (const auto& q : all) {
        const bool in = g.contains(q) && m.at(q) != 0;
        if (in != (m.at(p) != 0)) other = std::min(other, toBox(g, p, q));
        if (in) centre = std::min(centre, (p - q).cast<double>().cwiseProduct(g.spacing_mm).norm());
      }
      EXPECT_NEAR(d.at(p), m.at(p) != 0 ? other : -other, 1e-5);
      const std::size_t n = near[g.linear(p)];
      ASSERT_EQ(m.values[n], 1);
      const Eigen::Vector3i q(static_cast<int>(n % 9), static_cast<int>(n / 9 % 8), static_cast<int>(n / 72));
      EXPECT_NEAR((p - q).cast<double>().cwiseProduct(g.spacing_mm).norm(), centre, 1e-9);
    }
  }
  EXPECT_THROW(distanceToBoundary_mm(Mask(oblique({3, 3, 3}, {1, 1, 1}))), BadInput);
}

TEST(Distance, BallHasItsDepthAndThreadsDoNotMatter) {
  Grid g = oblique({60, 60, 60}, {1, 1, 1});
  Mask m(g);
  for (int k = 0; k < 60; ++k)
    for (int j = 0; j < 60; ++j)
      for (int i = 0; i < 60; ++i) m.at(i, j, k) = (Eigen::Vector3d(i, j, k) - Eigen::Vector3d(30, 30, 30)).norm() < 20;
  setThreadCount(1);
  const ScalarVolume d = distanceToBoundary_mm(m);
  setThreadCount(2);
  EXPECT_EQ(distanceToBoundary_mm(m).values, d.values);
  setThreadCount(0);
  EXPECT_NEAR(d.at(30, 30, 30), 20, 0.87);  // half a voxel diagonal
  EXPECT_NEAR(d.at(30, 30, 40), 10, 0.87);
  EXPECT_NEAR(d.at(30, 30, 57), -7, 0.87);
}

// The voxel solid of a ball of radius R lies between the balls of R − d and R + d, d half a voxel diagonal; erosion and
// dilation by r keep that order. So no voxel centre nearer than R − d − r is lost, none beyond R + d − r is left, and
// for dilation the same with +r. On any grid.
TEST(Morphology, ErodedAndDilatedBallsLieBetweenBalls) {
  for (const Eigen::Vector3d& spacing : {Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(1, 2, 3)}) {
    const Grid g = oblique((Eigen::Vector3d(60, 60, 60).cwiseQuotient(spacing)).array().ceil().cast<int>(), spacing);
    const Eigen::Vector3d centre = g.indexToLps(0.5 * (g.size.cast<double>().array() - 1.2).matrix());
    const double R = 20, r = 5, d = 0.5 * spacing.norm();
    Mask m(g);
    const auto away = [&](int i, int j, int k) { return (g.indexToLps(Eigen::Vector3d(i, j, k)) - centre).norm(); };
    for (int k = 0; k < g.size.z(); ++k)
      for (int j = 0; j < g.size.y(); ++j)
        for (int i = 0; i < g.size.x(); ++i) m.at(i, j, k) = away(i, j, k) < R ? 1 : 0;
    const Mask eroded = erode(m, r), dilated = dilate(m, r);
    std::size_t sure = 0, open = 0;
    for (int k = 0; k < g.size.z(); ++k)
      for (int j = 0; j < g.size.y(); ++j)
        for (int i = 0; i < g.size.x(); ++i) {
          const double a = away(i, j, k);
          if (a < R - d - r) {
            EXPECT_EQ(eroded.at(i, j, k), 1);
            ++sure;
          }
          if (a > R + d - r) {
            EXPECT_EQ(eroded.at(i, j, k), 0);
          }
          if (a < R - d + r) {
            EXPECT_EQ(dilated.at(i, j, k), 1);
          }
          if (a > R + d + r) {
            EXPECT_EQ(dilated.at(i, j, k), 0);
            ++open;
          }
        }
    EXPECT_GT(sure, 500u);
    EXPECT_GT(open, 500u);
  }
}

TEST(Morphology, ErosionAndDilationAreDual) {
  const Grid g = oblique({14, 13, 12}, {1, 1.5, 2});
  Random random(6);
  Mask m(g);
  for (int k = 4; k < 8; ++k)
    for (int j = 4; j < 9; ++j)
      for (int i = 4; i < 10; ++i) m.at(i, j, k) = random.uniform() < 0.9 ? 1 : 0;
  Mask complement = m;
  for (auto& v : complement.values) v = v != 0 ? 0 : 1;
  for (const double r : {0.0, 0.6, 1.3, 2.2}) {
    const Mask a = erode(m, r), b = dilate(complement, r);
    for (std::size_t i = 0; i < a.values.size(); ++i) EXPECT_NE(a.values[i], b.values[i]);
  }
  EXPECT_EQ(erode(m, 0).values, m.values);
  EXPECT_EQ(count(erode(Mask(g), 1)), 0u);
  EXPECT_THROW(erode(m, -1), BadArgument);
  EXPECT_THROW(dilate(m, std::nan("")), BadArgument);
}

TEST(Morphology, InPlaneErosionStaysInItsSlice) {
  Mask m(oblique({15, 15, 3}, {1, 3, 10}));
  for (int j = 2; j < 13; ++j)
    for (int i = 2; i < 13; ++i) m.at(i, j, 1) = 1;
  const Mask e = erodeInPlane(m, 3);
  EXPECT_EQ(count(e), 25u);  // a square of 11 leaves one of 5, a lone slice is not worn away from above
  EXPECT_EQ(e.at(5, 5, 1), 1);
  EXPECT_EQ(erodeInPlane(m, 0).values, m.values);
  m.at(7, 7, 1) = 0;  // a hole wears away a disk round it
  EXPECT_EQ(count(erodeInPlane(m, 1)), 81u - 5u);
  EXPECT_THROW(erodeInPlane(m, -1), BadArgument);
}

TEST(Components, AreSortedBySizeAndJoinedByFacesOnly) {
  Mask m(oblique({10, 10, 10}, {1, 1, 1}));
  for (int i = 0; i < 3; ++i) m.at(i, 0, 0) = 1;
  for (int i = 3; i < 9; ++i) m.at(i, 1, 0) = 1;  // touches the first along an edge only
  m.at(5, 5, 5) = 1;
  const Components parts = components(m);
  EXPECT_EQ(parts.voxels, (std::vector<std::size_t>{6, 3, 1}));
  EXPECT_EQ(parts.labels.at(4, 1, 0), 1);
  EXPECT_EQ(parts.labels.at(0, 0, 0), 2);
  EXPECT_EQ(parts.labels.at(5, 5, 5), 3);
  EXPECT_EQ(count(largestComponent(m)), 6u);
  EXPECT_TRUE(components(Mask(m.grid)).voxels.empty());
  EXPECT_EQ(count(largestComponent(Mask(m.grid))), 0u);
}

TEST(Components, HolesAreFilledAndBaysAreNot) {
  Mask m(oblique({10, 10, 10}, {1, 1, 1}));
  for (int k = 2; k < 8; ++k)
    for (int j = 2; j < 8; ++j)
      for (int i = 2; i < 8; ++i) m.at(i, j, k) = 1;
  const Mask solid = m;
  m.at(4, 4, 4) = m.at(5, 4, 4) = 0;
  EXPECT_EQ(fillHoles(m).values, solid.values);
  Mask bay = solid;
  for (int k = 4; k < 8; ++k) bay.at(4, 4, k) = 0;
  EXPECT_EQ(fillHoles(bay).values, bay.values);
}

}  // namespace
}  // namespace glisson::image
