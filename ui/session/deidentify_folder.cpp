// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/deidentify_folder.h"

#include <algorithm>

#include "base/error.h"

namespace glisson::session {

namespace {

namespace fs = std::filesystem;

bool isEmptyPlace(const fs::path& folder) {
  std::error_code failed;
  return !fs::exists(folder, failed) || (fs::is_directory(folder, failed) && fs::is_empty(folder, failed));
}

std::vector<DeidentifyReport::LeftOut> byReason(const std::vector<dicom::SkippedFile>& files) {
  std::vector<DeidentifyReport::LeftOut> all;
  for (const dicom::SkippedFile& file : files) {
    auto found = std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.reason == file.reason; });
    if (found == all.end()) found = all.insert(all.end(), {file.reason, 0});
    ++found->files;
  }
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.files > b.files; });
  return all;
}

}  // namespace

DeidentifyReport deidentifyFolder(const DeidentifyWish& wish, const Progress& progress) {
  if (wish.in.empty() || wish.out.empty() || wish.key.empty())
    throw BadInput("choose the folder to read, the folder to write, and the key file of the project");
  const bool wasThere = fs::exists(wish.out), wasEmpty = isEmptyPlace(wish.out);
  DeidentifyReport report;
  report.keyMade = !fs::exists(wish.key);
  const dicom::ProjectKey key = dicom::openProjectKey(wish.key, {wish.in, wish.out});
  dicom::DeidentifyResult result;
  try {
    result = dicom::deidentify(wish.in, wish.out, key, wish.options, progress);
  } catch (...) {
    std::error_code ignored;
    if (wasEmpty && !wasThere) {
      fs::remove_all(wish.out, ignored);
    } else if (wasEmpty) {
      for (const auto& entry : fs::directory_iterator(wish.out, ignored)) fs::remove_all(entry.path(), ignored);
    }
    throw;
  }
  report.files = result.files.size();
  report.patients = result.patients;
  report.changes = result.changes;
  report.leftOut = byReason(result.leftOut);
  report.notes = result.notes;
  return report;
}

}  // namespace glisson::session
