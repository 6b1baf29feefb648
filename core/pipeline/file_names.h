// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <set>
#include <string>

#include "dicom/series.h"

namespace glisson::pipeline {

/// The files of a scan by number. Names of files are often made of the patient's name: what goes into records and
/// reports says "file 3 of 120" instead, counted in order of names; `glisson-cli scan` tells the names.
class FileNames {
 public:
  explicit FileNames(const dicom::ScanResult& scan);

  /// "file 3 of 120".
  std::string placeOf(const std::filesystem::path& file) const;

  /// The text with every quoted name of one of the files replaced by its place.
  std::string hiddenIn(std::string text) const;

 private:
  std::set<std::string> names_;
};

}  // namespace glisson::pipeline
