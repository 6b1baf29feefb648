// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastography/statistics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "base/error.h"
#include "base/random.h"
#include "image/morphology.h"

namespace glisson::elastography {
namespace {

using testing::HasSubstr;

image::Grid mreGrid() {
  image::Grid g;
  g.size = {20, 16, 4};
  g.spacing_mm = {1.64, 1.7, 10.0};
  g.origin_lps_mm = {-17, 4, 33};
  return g;
}

StiffnessMap noisyMap(std::uint64_t seed) {
  image::ScalarVolume v(mreGrid());
  Random random(seed);
  for (float& x : v.values) x = static_cast<float>(random.uniform(1.0, 5.0));
  return makeStiffnessMap(v, StiffnessQuantity::Shear, "kPa");
}

TEST(StiffnessMap, UnitsAndFactors) {
  EXPECT_DOUBLE_EQ(unitFactor_kPa("Pa"), 1e-3);
  EXPECT_DOUBLE_EQ(unitFactor_kPa("kPa"), 1.0);
  EXPECT_DOUBLE_EQ(unitFactor_kPa("0.01kPa"), 0.01);
  EXPECT_DOUBLE_EQ(unitFactor_kPa("2.5e-3 kPa"), 2.5e-3);
  for (const char* bad :
       {"", "kpa", "MPa", "0kPa", "-1kPa", "nankPa", "infkPa", "1,5kPa", "xkPa", " kPa", "1  kPa", "1e400kPa"})
    EXPECT_THROW(unitFactor_kPa(bad), BadInput) << bad;
}

TEST(StiffnessMap, PascalAndKilopascalAgreeAndQuantitiesConvert) {
  image::ScalarVolume pascal(mreGrid(), 2100.0F);
  const StiffnessMap map = makeStiffnessMap(pascal, StiffnessQuantity::Shear, "Pa");
  EXPECT_NEAR(map.values_kPa.values[0], 2.1, 1e-6);
  const StiffnessMap E = toQuantity(map, StiffnessQuantity::Youngs, 0.5);
  EXPECT_NEAR(E.values_kPa.values[0], 6.3, 1e-6);
  EXPECT_EQ(E.quantity, StiffnessQuantity::Youngs);
  EXPECT_NEAR(toQuantity(E, StiffnessQuantity::Shear, 0.5).values_kPa.values[0], 2.1, 1e-6);
  EXPECT_NEAR(toQuantity(map, StiffnessQuantity::Youngs, 0.45).values_kPa.values[0], 2.1 * 2.9, 1e-6);
  EXPECT_THROW(toQuantity(map, StiffnessQuantity::Youngs, 0.6), BadArgument);
}

TEST(StiffnessMap, ConfidenceScales) {
  StiffnessMap map = noisyMap(1);
  image::ScalarVolume c(mreGrid(), 950.0F);
  c.values[0] = 999.0F;
  attachConfidence(map, c);
  EXPECT_FLOAT_EQ(map.confidence->values[0], 1.0F);
  EXPECT_FLOAT_EQ(map.confidence->values[1], 950.0F / 999.0F);
  for (float& v : c.values) v /= 999.0F;
  c.values[2] = std::numeric_limits<float>::quiet_NaN();
  attachConfidence(map, c);
  EXPECT_FLOAT_EQ(map.confidence->values[1], 950.0F / 999.0F);
  EXPECT_EQ(map.confidence->values[2], 0.0F);
  for (float& v : c.values) v = 100.0F;
  EXPECT_THROW(attachConfidence(map, c), BadInput);
  attachConfidence(map, c, 100.0);
  EXPECT_FLOAT_EQ(map.confidence->values[2], 1.0F);
  c.values[5] = -1.0F;
  EXPECT_THROW(attachConfidence(map, c), BadInput);
  // Other scales: told by a largest value that is the full one of 8, 10 or 12 bits or of a thousand; else asked for.
  for (const float full : {255.0F, 1000.0F, 1023.0F, 4095.0F}) {
    for (float& v : c.values) v = 0.5F * full;
    c.values[0] = full;
    const ConfidenceScale scale = attachConfidence(map, c);
    EXPECT_TRUE(scale.guessed);
    EXPECT_FLOAT_EQ(map.confidence->values[1], 0.5F);
    EXPECT_TRUE(doubtsAboutConfidence(map, scale).contains(DiagnosticCode::ConfidenceScaleTaken));
  }
  for (const float unknown : {2.0F, 254.0F, 500.0F, 948.0F, 2000.0F}) {
    c.values[0] = unknown;
    for (std::size_t v = 1; v < c.values.size(); ++v) c.values[v] = 0.0F;
    EXPECT_THROW(attachConfidence(map, c), BadInput) << unknown;
  }
}

TEST(StiffnessMap, WhereThereIsNoConfidenceIsMarked) {
  StiffnessMap map = noisyMap(4);
  image::Grid less = mreGrid();
  less.size.z() -= 1;
  const image::ScalarVolume stored(less, 1.0F);
  const ConfidenceScale scale = attachConfidence(map, stored);
  ASSERT_TRUE(map.noConfidence);
  const std::size_t perSlice = mreGrid().linear(0, 0, 1);
  EXPECT_EQ(image::count(*map.noConfidence), perSlice);
  EXPECT_EQ(map.noConfidence->values.back(), 1);
  const Diagnostics doubts = doubtsAboutConfidence(map, scale);
  ASSERT_TRUE(doubts.contains(DiagnosticCode::ConfidenceCoversLess));
  EXPECT_THAT(doubts.begin()->text(), testing::HasSubstr("without any: " + std::to_string(mreGrid().size.z() - 1)));
  const Measurement m = measure(map, image::Mask(mreGrid(), 1));
  EXPECT_EQ(m.noConfidence, perSlice);
  EXPECT_EQ(m.lowConfidence, 0u);
  EXPECT_TRUE(m.diagnostics.contains(DiagnosticCode::NoConfidenceThere));
  attachConfidence(map, image::ScalarVolume(mreGrid(), 1.0F));
  EXPECT_FALSE(map.noConfidence);
}

TEST(Statistics, ClosedForms) {
  const Statistics s = statisticsOf({4, 1, 3, 2}, 2.5);
  EXPECT_EQ(s.n, 4u);
  EXPECT_DOUBLE_EQ(s.area_mm2, 10.0);
  EXPECT_DOUBLE_EQ(s.mean_kPa, 2.5);
  EXPECT_DOUBLE_EQ(s.median_kPa, 2.5);
  EXPECT_DOUBLE_EQ(s.sd_kPa, std::sqrt(5.0 / 3.0));
  EXPECT_DOUBLE_EQ(s.min_kPa, 1.0);
  EXPECT_DOUBLE_EQ(s.max_kPa, 4.0);
  // 1 ... n: mean (n + 1) / 2, sample variance n (n + 1) / 12.
  std::vector<double> v(101);
  std::iota(v.begin(), v.end(), 1.0);
  EXPECT_DOUBLE_EQ(statisticsOf(v, 1.0).mean_kPa, 51.0);
  EXPECT_DOUBLE_EQ(statisticsOf(v, 1.0).median_kPa, 51.0);
  EXPECT_NEAR(statisticsOf(v, 1.0).sd_kPa, std::sqrt(101.0 * 102.0 / 12.0), 1e-12);
  EXPECT_TRUE(std::isnan(statisticsOf({}, 1.0).mean_kPa));
  EXPECT_TRUE(std::isnan(statisticsOf({1.0}, 1.0).sd_kPa));
}

TEST(Measure, CountsWhatIsLeftOutAndWhy) {
  StiffnessMap map = noisyMap(2);
  image::Mask roi(mreGrid());
  for (int k = 1; k < 3; ++k)
    for (int j = 4; j < 12; ++j)
      for (int i = 4; i < 14; ++i) roi.at(i, j, k) = 1;
  map.values_kPa.at(5, 5, 1) = 0.0F;
  map.values_kPa.at(6, 5, 1) = -3.0F;
  map.values_kPa.at(7, 5, 1) = std::numeric_limits<float>::quiet_NaN();
  image::ScalarVolume c(mreGrid(), 1.0F);
  c.at(8, 5, 1) = 0.94F;
  c.at(9, 5, 1) = 0.95F;
  c.at(9, 5, 2) = 0.1F;
  attachConfidence(map, c);
  const Measurement m = measure(map, roi);
  EXPECT_EQ(m.notPositive, 2u);
  EXPECT_EQ(m.notFinite, 1u);
  EXPECT_EQ(m.lowConfidence, 2u);
  EXPECT_EQ(m.pooled.n_before_mask, 160u);
  EXPECT_EQ(m.pooled.n, 155u);
  ASSERT_EQ(m.slices.size(), 2u);
  EXPECT_EQ(m.slices[0].slice, 1);
  EXPECT_EQ(m.slices[0].statistics.n, 76u);
  EXPECT_EQ(m.slices[1].statistics.n, 79u);
  EXPECT_NEAR(m.pooled.area_mm2, 155 * 1.64 * 1.7, 1e-9);
  // Weighted by area the slice means give the pooled mean.
  EXPECT_NEAR(m.areaWeightedMean_kPa, m.pooled.mean_kPa, 1e-12);
  EXPECT_NEAR(m.youngs_mean_kPa, 2.9 * m.pooled.mean_kPa, 1e-12);
  EXPECT_DOUBLE_EQ(m.shear_mean_kPa, m.pooled.mean_kPa);
  ASSERT_EQ(m.warnings.size(), 1u);
  EXPECT_THAT(m.warnings[0], testing::HasSubstr("3 of 160 voxels hold no stiffness"));
  MeasureOptions all;
  all.confidenceThreshold = 0.0;
  EXPECT_EQ(measure(map, roi, all).pooled.n, 157u);
}

TEST(Measure, AFewEmptyVoxelsAreNotedAndNoReasonToDoubt) {
  StiffnessMap map = noisyMap(2);
  image::Mask roi(mreGrid());
  for (int k = 1; k < 3; ++k)
    for (int j = 4; j < 12; ++j)
      for (int i = 4; i < 14; ++i) roi.at(i, j, k) = 1;
  map.values_kPa.at(5, 5, 1) = 0.0F;
  attachConfidence(map, image::ScalarVolume(mreGrid(), 1.0F));
  const Measurement m = measure(map, roi);
  EXPECT_TRUE(m.warnings.empty());
  EXPECT_TRUE(m.diagnostics.contains(DiagnosticCode::FewVoxelsEmpty));
}

TEST(Measure, ErosionLeavesTheInnerRegion) {
  const StiffnessMap map = noisyMap(3);
  image::Mask roi(mreGrid());
  for (int j = 2; j < 14; ++j)
    for (int i = 3; i < 17; ++i) roi.at(i, j, 2) = 1;
  MeasureOptions options;
  options.erosion_pixels = 3;
  EXPECT_EQ(measure(map, roi, options).pooled.n, std::size_t{(14 - 6) * (12 - 6)});
  options.erosion_pixels = 6;
  EXPECT_THROW(measure(map, roi, options), BadInput);
}

TEST(Measure, WrongUnitIsSuspected) {
  StiffnessMap map = noisyMap(4);
  const image::Mask roi(mreGrid(), 1);
  for (float& v : map.values_kPa.values) v *= 1000.0F;
  ASSERT_EQ(measure(map, roi).warnings.size(), 1u);
  EXPECT_THAT(measure(map, roi).warnings[0], HasSubstr("Pa or kPa?"));
  for (float& v : map.values_kPa.values) v *= 1e-6F;
  EXPECT_THAT(measure(map, roi).warnings[0], HasSubstr("Pa or kPa?"));
  // 20 kPa is odd as a shear modulus, and ordinary as a Young's modulus.
  for (float& v : map.values_kPa.values) v = 20.0F;
  EXPECT_EQ(measure(map, roi).warnings.size(), 1u);
  map.quantity = StiffnessQuantity::Youngs;
  EXPECT_TRUE(measure(map, roi).warnings.empty());
  EXPECT_NEAR(measure(map, roi).youngs_mean_kPa, 20.0, 1e-12);
  EXPECT_NEAR(measure(map, roi).shear_mean_kPa, 20.0 / 2.9, 1e-12);
}

TEST(Measure, RefusesWhatCannotBeMeasured) {
  StiffnessMap map = noisyMap(5);
  EXPECT_THROW(measure(map, image::Mask(mreGrid())), BadInput);
  image::Grid other = mreGrid();
  other.origin_lps_mm.x() += 1.0;
  EXPECT_THROW(measure(map, image::Mask(other, 1)), BadInput);
  attachConfidence(map, image::ScalarVolume(mreGrid(), 0.5F));
  EXPECT_THROW(measure(map, image::Mask(mreGrid(), 1)), BadInput);
}

}  // namespace
}  // namespace glisson::elastography
