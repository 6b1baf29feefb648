// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastography/reading.h"

#include <gtest/gtest.h>

namespace glisson::elastography {
namespace {

/// 40 × 30 voxels of 2 × 2 mm on four slices: 2 kPa inside, 8 kPa on a rim of two voxels, as a map mixes in what lies
/// beside the liver.
struct Liver {
  Liver() {
    image::Grid grid;
    grid.size = {40, 30, 4};
    grid.spacing_mm = {2.0, 2.0, 10.0};
    image::ScalarVolume values(grid, 2.0F), confidence(grid, 1.0F);
    roi = image::Mask(grid);
    for (int k = 0; k < 4; ++k)
      for (int j = 5; j < 25; ++j)
        for (int i = 5; i < 35; ++i) {
          roi.at(i, j, k) = 1;
          if (i < 7 || i >= 33 || j < 7 || j >= 23) values.at(i, j, k) = 8.0F;
          if (k == 3) confidence.at(i, j, k) = 0.0F;                         // no wave at all
          if (k == 2 && (i != 20 || j > 20)) confidence.at(i, j, k) = 0.0F;  // a column of 16 voxels, 64 mm²
        }
    map = makeStiffnessMap(values, StiffnessQuantity::Shear, "kPa");
    attachConfidence(map, confidence, 1.0);
  }
  StiffnessMap map;
  image::Mask roi;
};

TEST(Reading, SaysWhatLeavingOutTheRimChanged) {
  const Liver liver;
  MeasureOptions inner;
  inner.erosion_pixels = 2;
  const Measurement m = measure(liver.map, liver.roi, inner);
  EXPECT_EQ(m.drawn, 4u * 600u);
  EXPECT_EQ(m.rim, 4u * (600u - 26u * 16u));
  EXPECT_DOUBLE_EQ(m.pooled.mean_kPa, 2.0);
  const Measurement whole = measure(liver.map, liver.roi);
  EXPECT_DOUBLE_EQ(m.meanOfAll_kPa, whole.pooled.mean_kPa);
  EXPECT_GT(whole.pooled.mean_kPa, 3.0);
  const Reading r = readingOf(m);
  EXPECT_DOUBLE_EQ(r.meanChange, 2.0 / whole.pooled.mean_kPa - 1.0);
  EXPECT_EQ(readingOf(whole).meanChange, 0.0);
  EXPECT_DOUBLE_EQ(r.shareMeasured, static_cast<double>(m.pooled.n) / 2400.0);
}

TEST(Reading, ChangeToBeRealIsTheRepeatabilityOfTheMean) {
  const Liver liver;
  const Measurement m = measure(liver.map, liver.roi);
  EXPECT_DOUBLE_EQ(readingOf(m).changeToBeReal_kPa, 0.19 * m.pooled.mean_kPa);
}

TEST(Reading, WhatIsExcludedIsCountedOnceAndNotAsRim) {
  const Liver liver;
  image::Mask vessel(liver.roi.grid);
  for (int i = 0; i < 40; ++i) vessel.at(i, 15, 0) = 1;
  MeasureOptions options;
  options.erosion_pixels = 2;
  options.exclude = &vessel;
  const Measurement m = measure(liver.map, liver.roi, options);
  EXPECT_EQ(m.excluded, 26u);  // of 30 inside the outline four are rim
  EXPECT_EQ(m.rim, 4u * (600u - 26u * 16u));
  EXPECT_EQ(m.drawn, m.rim + m.excluded + m.pooled.n + m.lowConfidence + m.notPositive + m.notFinite + m.noConfidence);
}

TEST(Reading, SlicesWithoutWaveAndSmallOnesAreNamed) {
  const Liver liver;
  const Reading r = readingOf(measure(liver.map, liver.roi));
  ASSERT_EQ(r.slices.size(), 4u);
  EXPECT_EQ(r.slices[0].fault, SliceFault::None);
  EXPECT_EQ(r.slices[2].fault, SliceFault::MostlyWithout);
  EXPECT_EQ(r.slices[3].fault, SliceFault::NoReliableWave);
  EXPECT_EQ(r.failed, 1);
  EXPECT_FALSE(r.small);
  Statistics few;
  few.n = few.n_before_mask = 20;
  few.area_mm2 = 80.0;
  EXPECT_EQ(faultOf(few), SliceFault::Small);
}

TEST(Reading, ARegionOfAFewVoxelsIsSmall) {
  const Liver liver;
  image::Mask few(liver.roi.grid);
  for (int i = 10; i < 20; ++i)
    for (int j = 10; j < 20; ++j) few.at(i, j, 0) = 1;
  EXPECT_TRUE(readingOf(measure(liver.map, few)).small);  // 400 mm²
  for (int i = 20; i < 30; ++i)
    for (int j = 10; j < 20; ++j) few.at(i, j, 0) = 1;
  EXPECT_FALSE(readingOf(measure(liver.map, few)).small);  // 800 mm²
}

}  // namespace
}  // namespace glisson::elastography
