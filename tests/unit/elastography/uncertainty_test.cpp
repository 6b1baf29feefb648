// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/random.h"
#include "elastography/fill.h"
#include "elastography/statistics.h"
#include "image/morphology.h"
#include "image/resample.h"

namespace glisson::elastography {
namespace {

image::Grid mreGrid() {
  image::Grid g;
  g.size = {64, 60, 4};
  g.spacing_mm = {1.64, 1.64, 10.0};
  g.direction = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY()).toRotationMatrix();
  return g;
}

image::Mask disc(const image::Grid& g, double radius_mm) {
  image::Mask m(g);
  for (int k = 0; k < g.size.z(); ++k)
    for (int j = 0; j < g.size.y(); ++j)
      for (int i = 0; i < g.size.x(); ++i)
        m.at(i, j, k) = std::hypot((i - 32) * g.spacing_mm.x(), (j - 30) * g.spacing_mm.y()) < radius_mm ? 1 : 0;
  return m;
}

/// 3 kPa and noise of 0.3 kPa, averaged over boxes of (2 reach + 1)² pixels.
image::ScalarVolume noisy(const image::Grid& g, int reach, Random& random) {
  image::ScalarVolume raw(g), out(g);
  for (float& v : raw.values) v = static_cast<float>(0.3 * random.normal());
  for (int k = 0; k < g.size.z(); ++k)
    for (int j = 0; j < g.size.y(); ++j)
      for (int i = 0; i < g.size.x(); ++i) {
        double sum = 0.0;
        for (int b = -reach; b <= reach; ++b)
          for (int a = -reach; a <= reach; ++a)
            sum += static_cast<double>(raw.at((i + a + g.size.x()) % g.size.x(), (j + b + g.size.y()) % g.size.y(), k));
        out.at(i, j, k) = static_cast<float>(3.0 + sum / std::pow(2 * reach + 1, 2));
      }
  return out;
}

// The standard error that is announced is the standard deviation of the mean over repeated scans, white noise or not.
TEST(MeanUncertainty, IsTheSpreadOfTheMeanOverRepeatedScans) {
  const image::Grid g = mreGrid();
  const image::Mask roi = disc(g, 30.0);
  for (const int reach : {0, 1, 2}) {
    double sum = 0.0, squares = 0.0, announced = 0.0;
    constexpr int scans = 60;
    Random random(5);
    for (int s = 0; s < scans; ++s) {
      const Measurement m = measure({noisy(g, reach, random), StiffnessQuantity::Shear, {}, {}, {}, {}}, roi);
      sum += m.pooled.mean_kPa;
      squares += m.pooled.mean_kPa * m.pooled.mean_kPa;
      announced += m.uncertainty.se_kPa / scans;
      EXPECT_NEAR(m.uncertainty.high_kPa - m.uncertainty.low_kPa, 3.92 * m.uncertainty.se_kPa, 1e-12);
    }
    const double seen = std::sqrt((squares - sum * sum / scans) / (scans - 1));
    std::printf("pooled over %d x %d pixels: announced %.5f kPa, seen %.5f kPa\n", 2 * reach + 1, 2 * reach + 1,
                announced, seen);
    // The SD of 60 scans is itself known to 9 %; three of these.
    EXPECT_GT(announced, 0.73 * seen);
    EXPECT_LT(announced, 1.27 * seen);
  }
}

TEST(MeanUncertainty, ConstantMapIsExactAndOneVoxelSaysNothing) {
  const image::Grid g = mreGrid();
  const MeanUncertainty u = meanUncertainty(image::ScalarVolume(g, 2.0F), disc(g, 20.0));
  EXPECT_EQ(u.se_kPa, 0.0);
  EXPECT_EQ(u.low_kPa, 2.0);
  image::Mask one(g);
  one.at(3, 4, 1) = 1;
  EXPECT_TRUE(std::isnan(meanUncertainty(image::ScalarVolume(g, 2.0F), one).se_kPa));
}

TEST(Measure, ErosionInMillimetresAndExclusion) {
  const image::Grid g = mreGrid();
  const image::Mask roi = disc(g, 30.0);
  const StiffnessMap map{image::ScalarVolume(g, 2.0F), StiffnessQuantity::Shear, {}, {}, {}, {}};
  MeasureOptions o;
  o.erosion_mm = 8.0;
  const double inner_mm2 = measure(map, roi, o).slices.front().statistics.area_mm2;
  // What is kept lies deeper than 8 mm below pixels that reach half a diagonal (1.16 mm) to either side of the circle.
  EXPECT_GT(inner_mm2, std::numbers::pi * std::pow(22.0 - 2 * 1.16, 2));
  EXPECT_LT(inner_mm2, std::numbers::pi * std::pow(22.0 + 1.16, 2));
  const image::Mask vessel = disc(g, 5.0);
  o.erosion_mm = 0.0;
  o.exclude = &vessel;
  EXPECT_EQ(measure(map, roi, o).pooled.n_before_mask, image::count(roi) - image::count(vessel));
  o.exclude = &roi;
  EXPECT_THROW(measure(map, roi, o), BadInput);
  o.exclude = nullptr;
  o.erosion_mm = 100.0;
  EXPECT_THROW(measure(map, roi, o), BadInput);
}

// A masked map that is interpolated across its border mixes in the zeros there; the filler does not.
TEST(FillStiffness, ResamplingDoesNotBiasTheMean) {
  const image::Grid g = mreGrid();
  const image::Mask roi = disc(g, 30.0);
  StiffnessMap map{image::ScalarVolume(g), StiffnessQuantity::Shear, {}, {}, {}, {}};
  for (std::size_t v = 0; v < roi.values.size(); ++v) map.values_kPa.values[v] = roi.values[v] != 0 ? 3.0F : 0.0F;
  image::Grid fine = g;
  fine.size = {70, 70, 12};
  fine.spacing_mm = {1.5, 1.5, 2.9};
  const image::Mask body = image::resampleNearest(roi, fine);
  const auto mean = [&](const image::ScalarVolume& values) {
    double sum = 0.0;
    for (std::size_t v = 0; v < body.values.size(); ++v)
      if (body.values[v] != 0) sum += static_cast<double>(values.values[v]);
    return sum / static_cast<double>(image::count(body));
  };
  const double ours = mean(fillStiffness(map, body, &roi).values_kPa) / 3.0 - 1.0;
  const double naive = mean(image::resampleLinear(map.values_kPa, fine, 0.0F)) / 3.0 - 1.0;
  std::printf("mean after resampling: ours %+.5f %%, across the border %+.2f %%\n", 100 * ours, 100 * naive);
  EXPECT_LT(std::abs(ours), 1e-3);
  EXPECT_LT(naive, -0.01);
}

// Bounds hold what noise makes of a modulus, and nothing within them is touched.
TEST(FillStiffness, Bounds) {
  const image::Grid g = mreGrid();
  const image::Mask roi = disc(g, 30.0);
  StiffnessMap map{image::ScalarVolume(g, 3.0F), StiffnessQuantity::Shear, {}, {}, {}, {}};
  map.values_kPa.at(32, 30, 1) = 900.0F;
  map.values_kPa.at(20, 30, 1) = 1e-6F;
  const FilledStiffness filled = fillStiffness(map, roi, &roi, {.low_kPa = 0.2, .high_kPa = 50.0});
  EXPECT_FLOAT_EQ(filled.values_kPa.at(32, 30, 1), 50.0F);
  EXPECT_FLOAT_EQ(filled.values_kPa.at(20, 30, 1), 0.2F);
  EXPECT_FLOAT_EQ(filled.values_kPa.at(25, 25, 1), 3.0F);
}

// The same stiffness in every unit and storage.
TEST(Measure, UnitsAndIntegersGiveTheSameKilopascals) {
  const image::Grid g = mreGrid();
  const image::Mask roi = disc(g, 30.0);
  Random random(8);
  image::ScalarVolume pascal(g), kilopascal(g), hundredth(g);
  for (std::size_t v = 0; v < roi.values.size(); ++v) {
    const double whole = std::round(2100.0 + 300.0 * random.normal());  // whole pascals, as GE stores them
    pascal.values[v] = static_cast<float>(whole);
    kilopascal.values[v] = static_cast<float>(1e-3 * whole);
    hundredth.values[v] = static_cast<float>(0.1 * whole);
  }
  const auto pooled = [&](image::ScalarVolume values, const std::string& unit) {
    return measure(makeStiffnessMap(std::move(values), StiffnessQuantity::Shear, unit), roi);
  };
  const Measurement a = pooled(pascal, "Pa"), b = pooled(kilopascal, "kPa"), c = pooled(hundredth, "0.01kPa");
  EXPECT_NEAR(a.pooled.mean_kPa, b.pooled.mean_kPa, 1e-6);
  EXPECT_NEAR(a.pooled.mean_kPa, c.pooled.mean_kPa, 1e-6);
  EXPECT_NEAR(a.pooled.sd_kPa, c.pooled.sd_kPa, 1e-6);
  EXPECT_NEAR(a.areaWeightedMean_kPa, a.pooled.mean_kPa, 1e-9);
  EXPECT_EQ(a.slices.size(), 4u);
}

}  // namespace
}  // namespace glisson::elastography
