// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/file_names.h"

#include <iterator>

namespace glisson::pipeline {

FileNames::FileNames(const dicom::ScanResult& scan) {
  for (const dicom::Series& s : scan.series)
    for (const std::filesystem::path& f : s.files) names_.insert(f.filename().string());
  for (const dicom::SkippedFile& f : scan.skipped) names_.insert(f.file.filename().string());
}

std::string FileNames::placeOf(const std::filesystem::path& file) const {
  const auto found = names_.find(file.filename().string());
  if (found == names_.end()) return "a file";
  return "file " + std::to_string(std::distance(names_.begin(), found) + 1) + " of " + std::to_string(names_.size());
}

std::string FileNames::hiddenIn(std::string text) const {
  if (text.find('\'') == std::string::npos) return text;
  for (const std::string& name : names_) {
    const std::string quoted = "'" + name + "'", place = placeOf(name);
    for (std::size_t at = text.find(quoted); at != std::string::npos; at = text.find(quoted, at + place.size()))
      text.replace(at, quoted.size(), place);
  }
  return text;
}

}  // namespace glisson::pipeline
