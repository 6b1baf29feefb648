// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <map>

#include "base/error.h"
#include "dicom/series.h"
#include "support/support.h"

namespace glisson::dicom {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

/// What scanning and reading one file came to: "read", or the reason why not.
std::string outcome(const fs::path& file) {
  const auto begin = std::chrono::steady_clock::now();
  const ScanResult found = scan(file);
  std::string said;
  for (const SkippedFile& s : found.skipped) said += s.reason;
  for (const Series& s : found.series) {
    try {
      const image::ScalarVolume volume = readSeries(s);
      said += volume.values.empty() ? "nothing was read" : "read";
      for (const std::string& w : s.warnings) said += "\n  " + w;
    } catch (const BadInput& e) {
      said += e.what();
    }
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  EXPECT_LT(seconds.count(), 2.0) << file;
  EXPECT_FALSE(said.empty()) << file;
  return said;
}

std::map<std::string, std::string> outcomes(const fs::path& folder) {
  std::map<std::string, std::string> all;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().extension() == ".dcm")
      all[entry.path().filename().string()] = outcome(entry.path());
  return all;
}

TEST(MalformedFiles, eachEndsWithPixelsOrAReason) {
  GLISSON_NEEDS_DATA("malformed_dicom");
  const auto all = outcomes(test::sharedData() / "malformed_dicom");
  ASSERT_GT(all.size(), 200U);
  // The well-formed sample is a CT slice without a position: what lies about its pixels must be found before that.
  const std::map<std::string, std::string> expected = {{"BASELINE_valid_ct.dcm", "ImagePositionPatient"},
                                                       {"TC0285_buf_half.dcm", "is truncated"},
                                                       {"TC0291_buf_zero.dcm", "is truncated"},
                                                       {"TC0295_rows_zero.dcm", "Rows (0028,0010) is 0"},
                                                       {"TC0299_bits_bsstored_gt_ba.dcm", "BitsStored"},
                                                       {"TC0303_bits_highbit_gt_ba.dcm", "HighBit"},
                                                       {"TC0315_bits_ba_48.dcm", "BitsAllocated"},
                                                       {"TC0327_mono2_spp3.dcm", "three samples"},
                                                       {"TC0337_mf_nf_zero.dcm", "NumberOfFrames"},
                                                       {"TC0339_mf_nf_million.dcm", "is truncated"},
                                                       {"TC0383_no_dicm.dcm", "is not a DICOM file"},
                                                       {"TC0401_invalid_ts.dcm", "unknown transfer syntax"},
                                                       {"TC0345_deflate_corrupt.dcm", "beyond the end of the file"}};
  for (const auto& [name, reason] : expected) {
    ASSERT_TRUE(all.contains(name)) << name;
    EXPECT_THAT(all.at(name), HasSubstr(reason)) << name;
  }
  // None of them has a place in the patient, so that none may be read.
  for (const auto& [name, said] : all) EXPECT_THAT(said, Not(testing::StartsWith("read"))) << name;
}

}  // namespace
}  // namespace glisson::dicom
