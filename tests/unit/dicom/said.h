// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "base/error.h"
#include "dicom/series.h"
#include "dicom_bytes.h"
#include "support/support.h"

namespace glisson::dicom {

/// Every sentence that scanning and reading the files of a folder gives, and "[read]" for each volume that was read.
inline std::string saidOf(const std::filesystem::path& path) {
  const ScanResult found = scan(path);
  std::string said;
  for (const SkippedFile& s : found.skipped) said += s.reason + "\n";
  for (const Series& s : found.series) {
    for (const std::string& w : s.warnings) said += w + "\n";
    try {
      readSeries(s);
      said += "[read]\n";
    } catch (const BadInput& e) {
      said += std::string(e.what()) + "\n";
    }
  }
  EXPECT_THAT(said, Not(testing::HasSubstr("CANARY")));
  return said;
}

inline std::string saidOfBytes(const std::string& bytes) {
  const test::TemporaryFolder folder;
  return saidOf(test::DicomBytes::write(folder / "one", bytes));
}

inline std::string saidOfImage(const std::function<void(test::DicomBytes&)>& change) {
  test::DicomBytes image;
  change(image);
  return saidOfBytes(image.bytes());
}

}  // namespace glisson::dicom
