// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "dicom/series.h"
#include "image/io.h"
#include "support/support.h"

namespace glisson::dicom {
namespace {

using testing::HasSubstr;

std::filesystem::path odd(const std::string& name) {
  return test::sharedData() / "mr750_and_odd_series" / name;
}

/// The voxel of an independently converted volume at the same place in the patient must hold the same value; every
/// voxel of one has its partner in the other.
void expectSameImage(const image::ScalarVolume& ours, const image::ScalarVolume& theirs, double tolerance_mm) {
  ASSERT_EQ(ours.values.size(), theirs.values.size());
  std::vector<bool> met(theirs.values.size(), false);
  std::size_t wrong = 0;
  for (int k = 0; k < ours.grid.size.z(); ++k)
    for (int j = 0; j < ours.grid.size.y(); ++j)
      for (int i = 0; i < ours.grid.size.x(); ++i) {
        const Eigen::Vector3d p = ours.grid.indexToLps(Eigen::Vector3d(i, j, k));
        const Eigen::Vector3i there = theirs.grid.lpsToIndex(p).array().round().cast<int>().matrix();
        ASSERT_TRUE(theirs.grid.contains(there)) << p.transpose();
        ASSERT_LT((theirs.grid.indexToLps(there.cast<double>()) - p).norm(), tolerance_mm);
        met[theirs.grid.linear(there)] = true;
        if (std::abs(ours.at(i, j, k) - theirs.at(there)) > 1e-3F) ++wrong;
      }
  EXPECT_EQ(wrong, 0U);
  EXPECT_EQ(std::count(met.begin(), met.end(), false), 0);
}

TEST(RealSeries, geMr750EqualsItsIndependentConversion) {
  GLISSON_NEEDS_DATA("mr750_and_odd_series");
  const ScanResult found = scan(odd("ge/anatomical/001"));
  ASSERT_EQ(found.series.size(), 1U);
  EXPECT_TRUE(found.skipped.empty());
  const Series& series = found.series.front();
  EXPECT_FALSE(series.error) << *series.error;
  EXPECT_EQ(series.role, SeriesRole::Anatomical);
  EXPECT_EQ(series.files.size(), 4U);
  const image::ScalarVolume volume = readSeries(series);
  for (const char* truth :
       {"ge/anatomical/001_ground_truth.nii.gz", "ge/anatomical/001_ground_truth_reoriented.nii.gz"})
    expectSameImage(volume, image::readVolume(odd(truth)), 0.02);
}

TEST(RealSeries, siemensEnhancedEqualsItsIndependentConversion) {
  GLISSON_NEEDS_DATA("mr750_and_odd_series");
  const ScanResult found = scan(odd("siemens_multiframe/anatomical/001"));
  ASSERT_EQ(found.series.size(), 1U);
  const Series& series = found.series.front();
  ASSERT_FALSE(series.error) << *series.error;
  EXPECT_EQ(series.files.size(), 1U);
  EXPECT_EQ(series.frames.size(), 8U);
  const image::ScalarVolume volume = readSeries(series);
  for (const char* truth : {"siemens_multiframe/anatomical/001_ground_truth.nii.gz",
                            "siemens_multiframe/anatomical/001_ground_truth_reoriented.nii.gz"})
    expectSameImage(volume, image::readVolume(odd(truth)), 0.02);
}

TEST(RealSeries, philipsEnhancedIsSplitIntoItsFourTimePoints) {
  GLISSON_NEEDS_DATA("mr750_and_odd_series");
  const ScanResult found = scan(odd("philips_enhanced/fmri/001"));
  ASSERT_EQ(found.series.size(), 4U);
  for (std::size_t n = 0; n < 4; ++n) {
    const Series& series = found.series[n];
    EXPECT_FALSE(series.error) << *series.error;
    EXPECT_EQ(series.grid.size, Eigen::Vector3i(64, 64, 8));
    EXPECT_EQ(series.uid.ends_with("#" + std::to_string(n + 1)), n > 0);
    for (std::size_t k = 0; k < 8; ++k) EXPECT_EQ(series.frames[k] % 4, static_cast<int>(n));
    EXPECT_NEAR(series.grid.spacing_mm.z(), (-45.849945068359 + 69.037445068359) / 7.0, 1e-6);
  }
}

TEST(RealSeries, aMaskOfTheSameSlicesMadeElsewhereLiesOnThem) {
  GLISSON_NEEDS_DATA("dicom_seg_rtstruct");
  const auto folder = test::sharedData() / "dicom_seg_rtstruct" / "dcmqi";
  const ScanResult found = scan(folder / "ct-3slice");
  ASSERT_EQ(found.series.size(), 1U);
  const image::ScalarVolume ct = readSeries(found.series.front());
  const image::Mask liver = image::readMask(folder / "liver_seg.nrrd");
  ASSERT_EQ(liver.grid.voxelCount(), ct.grid.voxelCount());
  double sum = 0.0;
  double count = 0.0;
  for (int k = 0; k < liver.grid.size.z(); ++k)
    for (int j = 0; j < liver.grid.size.y(); ++j)
      for (int i = 0; i < liver.grid.size.x(); ++i) {
        if (liver.at(i, j, k) == 0) continue;
        const Eigen::Vector3d index = ct.grid.lpsToIndex(liver.grid.indexToLps(Eigen::Vector3d(i, j, k)));
        const Eigen::Vector3i there = index.array().round().cast<int>().matrix();
        ASSERT_TRUE(ct.grid.contains(there));
        ASSERT_LT((index - there.cast<double>()).norm(), 0.01);
        sum += static_cast<double>(ct.at(there));
        ++count;
      }
  // The same mask exists as a DICOM segmentation of the same slices: pydicom finds 107098 pixels whose CT values add up
  // to 3997854 (whole numbers, so that the sum is exact).
  EXPECT_EQ(count, 107098.0);
  EXPECT_EQ(sum, 3997854.0);
}

struct Failing {
  const char* folder;
  const char* said;
};

class FailingSeries : public testing::TestWithParam<Failing> {};

TEST_P(FailingSeries, isRefusedOrWarnedAbout) {
  GLISSON_NEEDS_DATA("mr750_and_odd_series");
  const ScanResult found = scan(odd(std::string("failing/") + GetParam().folder));
  ASSERT_FALSE(found.series.empty());
  bool said = false;
  for (const Series& s : found.series) {
    std::string all = s.error.value_or("");
    for (const std::string& w : s.warnings) all += "\n" + w;
    said = said || all.find(GetParam().said) != std::string::npos;
    if (s.error) {
      EXPECT_THROW(readSeries(s), BadInput);
    }
  }
  EXPECT_TRUE(said);
}

INSTANTIATE_TEST_SUITE_P(Odd, FailingSeries,
                         testing::Values(Failing{"gantrytilting/001", "gantry tilt"},
                                         Failing{"notavolume/001", "lie at one position"},
                                         Failing{"slicecount/001", "only 2 slices"},
                                         Failing{"sliceincrement/001", "a slice is missing at 33.107"},
                                         Failing{"sliceincrement/002", "gantry tilt"},
                                         Failing{"sliceorientation/001", "orientation"}));

}  // namespace
}  // namespace glisson::dicom
