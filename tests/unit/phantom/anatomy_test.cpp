// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "base/error.h"
#include "base/parallel.h"
#include "phantom/detail/shape.h"
#include "phantom/detail/torso.h"
#include "roi/contour_stack.h"
#include "shared_patient.h"

namespace glisson::phantom {
namespace {

TEST(Shape, EllipsoidDistanceIsExactOnTheSurfaceAndFirstOrderNearIt) {
  Ellipsoid e;
  e.centre_lps_mm = {3, -4, 5};
  e.radii_mm = {30, 20, 10};
  e.axes = rotation(20, 30, 40);
  Random r(7);
  for (int i = 0; i < 200; ++i) {
    const Point unit = Point(r.normal(), r.normal(), r.normal()).normalized();
    const Point local = e.radii_mm.cwiseProduct(unit);
    const Point normal = unit.cwiseQuotient(e.radii_mm).normalized();
    EXPECT_NEAR(e.distance_mm(e.centre_lps_mm + e.axes * local), 0.0, 1e-9);
    EXPECT_NEAR(e.distance_mm(e.centre_lps_mm + e.axes * (local + 0.01 * normal)), 0.01, 1e-4);
    EXPECT_NEAR(e.distance_mm(e.centre_lps_mm + e.axes * (local - 0.01 * normal)), -0.01, 1e-4);
  }
}

TEST(Shape, SegmentDistanceAgreesWithDenseSampling) {
  Random r(11);
  auto point = [&] { return Point(r.uniform(-10, 10), r.uniform(-10, 10), r.uniform(-10, 10)); };
  for (int i = 0; i < 50; ++i) {
    const Point a = point(), b = point(), c = point(), d = point();
    double nearest = 1e9;
    for (int s = 0; s <= 200; ++s) nearest = std::min(nearest, Capsule{c, d, 0.0}.distance_mm(a + (b - a) * s / 200.0));
    const double exact = segmentDistance_mm(a, b, c, d);
    EXPECT_LE(exact, nearest + 1e-9);
    EXPECT_GE(exact, nearest - (b - a).norm() / 400.0);
  }
}

TEST(Anatomy, LiverVolumeIsThatOfAnAdultAndEqualsTheTruth) {
  const PhantomPatient& p = test::sharedPatient();
  const auto count = std::count(p.liver.values.begin(), p.liver.values.end(), 1);
  EXPECT_DOUBLE_EQ(p.truth.volume_mL, static_cast<double>(count) * p.liver.grid.voxelVolume_mm3() / 1000.0);
  for (const std::uint64_t seed : {2, 3, 4, 5, 6, 7, 8, 9}) {
    const Torso torso(seed);
    EXPECT_GE(torso.targetVolume_mL(), 1300.0);
    EXPECT_LE(torso.targetVolume_mL(), 1850.0);
    std::size_t inside = 0;
    for (double z = -150; z < 130; z += 4.0)
      for (double y = -115; y < 115; y += 4.0)
        for (double x = -170; x < 125; x += 4.0) inside += torso.liver_mm({x, y, z}) < 0.0 ? 1 : 0;
    EXPECT_NEAR(static_cast<double>(inside) * 0.064, torso.targetVolume_mL(), 0.02 * torso.targetVolume_mL()) << seed;
  }
  EXPECT_NEAR(p.truth.volume_mL, Torso(1).targetVolume_mL(), 0.02 * p.truth.volume_mL);
}

TEST(Anatomy, LiverIsOnePieceOnThePatientsRight) {
  const image::Mask& liver = test::sharedPatient().liver;
  const image::Grid& g = liver.grid;
  // Flood fill through faces from the first liver voxel reaches (nearly) all of it.
  std::vector<std::uint8_t> seen(liver.values.size(), 0);
  const auto first =
      static_cast<std::size_t>(std::find(liver.values.begin(), liver.values.end(), 1) - liver.values.begin());
  std::size_t largest = 0;
  std::size_t total = 0;
  double sumX = 0.0;
  const auto nx = static_cast<std::size_t>(g.size.x());
  const std::size_t nxy = nx * static_cast<std::size_t>(g.size.y());
  for (std::size_t start = first; start < liver.values.size(); ++start) {
    if (!liver.values[start] || seen[start]) continue;
    std::vector<std::size_t> stack{start};
    seen[start] = 1;
    std::size_t size = 0;
    while (!stack.empty()) {
      const std::size_t v = stack.back();
      stack.pop_back();
      ++size;
      sumX += g.indexToLps({static_cast<double>(v % nx), 0, 0}).x();
      for (const std::size_t w : {v - 1, v + 1, v - nx, v + nx, v - nxy, v + nxy})
        if (liver.values.at(w) && !seen[w]) {
          seen[w] = 1;
          stack.push_back(w);
        }
    }
    largest = std::max(largest, size);
    total += size;
  }
  EXPECT_GT(static_cast<double>(largest), 0.995 * static_cast<double>(total));
  EXPECT_LT(sumX / static_cast<double>(total), -30.0);  // LPS: the right is negative x
}

TEST(Anatomy, HandDrawnContoursEncloseTheLiverToWithinAPixelOfItsEdge) {
  const PhantomPatient& p = test::sharedPatient();
  const image::Mask drawn = roi::rasterise(p.contours, p.liver.grid);
  std::size_t both = 0, a = 0, b = 0, slices = 0;
  const std::size_t slice =
      static_cast<std::size_t>(p.liver.grid.size.x()) * static_cast<std::size_t>(p.liver.grid.size.y());
  for (std::size_t v = 0; v < drawn.values.size(); ++v) {
    a += drawn.values[v];
    b += p.liver.values[v];
    both += drawn.values[v] && p.liver.values[v] ? 1 : 0;
  }
  EXPECT_GT(2.0 * static_cast<double>(both) / static_cast<double>(a + b), 0.97);
  EXPECT_NEAR(static_cast<double>(a), static_cast<double>(b), 0.02 * static_cast<double>(b));
  EXPECT_LT(both, b);  // drawn by hand, not copied
  for (int k = 0; k < p.liver.grid.size.z(); ++k) {
    const auto begin = p.liver.values.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(k) * slice);
    const auto area = std::count(begin, begin + static_cast<std::ptrdiff_t>(slice), 1);
    const bool has =
        std::any_of(p.contours.polygons.begin(), p.contours.polygons.end(), [&](const roi::Polygon& polygon) {
          return std::abs(p.liver.grid.lpsToIndex(polygon.points_lps_mm.col(0)).z() - k) < 1e-6;
        });
    EXPECT_TRUE(has || area <= 60) << "slice " << k << " holds " << area << " liver voxels and no contour";
    slices += has ? 1 : 0;
  }
  EXPECT_GT(slices, 40U);
}

TEST(Anatomy, SameSeedSameBitsWithAnyNumberOfThreads) {
  setThreadCount(1);
  const PhantomPatient one = makePhantom(1);
  setThreadCount(0);
  const PhantomPatient& many = test::sharedPatient();
  EXPECT_EQ(one.mri.values, many.mri.values);
  EXPECT_EQ(one.stiffness_Pa.values, many.stiffness_Pa.values);
  ASSERT_EQ(one.wave.size(), many.wave.size());
  for (std::size_t t = 0; t < one.wave.size(); ++t) EXPECT_EQ(one.wave[t].values, many.wave[t].values) << "step " << t;
  EXPECT_EQ(one.confidence.values, many.confidence.values);
  EXPECT_EQ(one.magnitude.values, many.magnitude.values);
  EXPECT_EQ(one.truth.shear_kPa, many.truth.shear_kPa);
}

TEST(Anatomy, RefusesWhatItCannotMake) {
  PhantomOptions o;
  o.shear_kPa = -1.0;
  EXPECT_THROW(makePhantom(1, o), BadArgument);
  o.shear_kPa = 3.0;
  o.number = 0;
  EXPECT_THROW(makePhantom(1, o), BadArgument);
}

}  // namespace
}  // namespace glisson::phantom
