// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/detail/slice_stack.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace glisson::dicom {
namespace {

std::vector<double> places(int count, double step_mm, const std::function<double(int, double)>& change) {
  std::vector<double> all;
  for (int k = 0; k < count; ++k) all.push_back(change(k, -37.5 + step_mm * k));
  return all;
}

TEST(SliceStack, roundedPlacesAreEvenAndTellHowFarTheyAreOff) {
  for (const double step_mm : {0.7, 1.25, 3.333, 10.0}) {
    const SliceStack exact = stackOf(places(21, step_mm, [](int, double z) { return z; }));
    EXPECT_TRUE(exact.even && exact.exact);
    EXPECT_NEAR(exact.step_mm, step_mm, 1e-12);
    const SliceStack rounded = stackOf(places(21, step_mm, [](int, double z) { return std::round(10.0 * z) / 10.0; }));
    EXPECT_TRUE(rounded.even);
    EXPECT_LE(rounded.off_mm, 0.1);
    EXPECT_NEAR(rounded.step_mm, step_mm, 1e-3 * step_mm);
    EXPECT_TRUE(rounded.missing.empty());
  }
}

TEST(SliceStack, aShiftedHalfIsUnevenAndAMissingSliceIsNamed) {
  const SliceStack shifted = stackOf(places(20, 1.25, [](int k, double z) { return k < 10 ? z : z + 0.65; }));
  EXPECT_FALSE(shifted.even);
  EXPECT_EQ(shifted.odd, 10U);
  std::vector<double> gap = places(9, 5.0, [](int, double z) { return z; });
  gap.erase(gap.begin() + 4, gap.begin() + 6);
  const SliceStack missing = stackOf(gap);
  EXPECT_TRUE(missing.even);
  ASSERT_EQ(missing.missing.size(), 2U);
  EXPECT_NEAR(missing.missing[1].at_mm, -37.5 + 25.0, 1e-9);
  EXPECT_EQ(missing.missing[1].before, 4U);
  EXPECT_FALSE(stackOf({0.0, 10.0, 24.0, 40.0}).even);
}

}  // namespace
}  // namespace glisson::dicom
