// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/kept_results.h"

#include "base/error.h"
#include "pipeline/picture_file.h"
#include "pipeline/replay.h"
#include "pipeline/result_file.h"

namespace glisson::session {

namespace {

namespace fs = std::filesystem;

constexpr const char* caseFiles[] = {"case.json", "contours.json", "scene.json", "contours-measured.json", "mri.nrrd"};
constexpr const char* results = "results";
constexpr const char* preview = "preview";  ///< of the model as it would be run: not the run's

/// Copies a run from one folder into another, which is made anew.
void copyRun(const fs::path& from, const fs::path& to) {
  std::error_code failed;
  fs::remove_all(to / results, failed);
  fs::create_directories(to / results, failed);
  for (const char* name : caseFiles) {
    fs::remove(to / name, failed);
    if (fs::is_regular_file(from / name, failed)) fs::copy_file(from / name, to / name);
  }
  for (fs::recursive_directory_iterator entry(from / results), end; entry != end; ++entry) {
    const fs::path name = entry->path().lexically_relative(from);
    if (name == fs::path(results) / preview) {
      entry.disable_recursion_pending();
    } else if (entry->is_directory()) {
      fs::create_directories(to / name);
    } else if (entry->is_regular_file() && !entry->is_symlink()) {
      fs::copy_file(entry->path(), to / name, fs::copy_options::overwrite_existing);
    }
  }
}

}  // namespace

void keepRun(const fs::path& work, const fs::path& caseFolder) {
  const fs::path kept = caseFolder / lastRunName, making = caseFolder / ".last-run-making";
  std::error_code failed;
  try {
    fs::remove_all(making);
    copyRun(work, making);
    fs::remove_all(kept);
    fs::rename(making, kept);
  } catch (const fs::filesystem_error& e) {
    fs::remove_all(making, failed);
    throw BadInput("the results of the last run cannot be kept in the case: " + e.code().message() +
                   "; check the folder's rights and the free space");
  }
}

void forgetRun(const fs::path& caseFolder) {
  std::error_code ignored;
  fs::remove_all(caseFolder / lastRunName, ignored);
}

std::optional<ShownRun> keptRun(const fs::path& caseFolder, const fs::path& work) {
  const fs::path kept = caseFolder / lastRunName;
  std::error_code failed;
  if (!fs::is_regular_file(kept / results / pipeline::resultFileName, failed)) return std::nullopt;
  if (const auto others = pipeline::filesOfAnotherRun(kept / results / "run.json"); !others.empty())
    throw BadInput("'" + others.front() + "' of the kept results is not the one that was written; run the case again");
  try {
    copyRun(kept, work);
  } catch (const fs::filesystem_error& e) {
    throw BadInput("the kept results cannot be read: " + e.code().message());
  }
  ShownRun run;
  run.result = std::make_shared<const pipeline::RunResult>(pipeline::readResultFile(work / results));
  if (fs::exists(work / results / pipeline::pictureFileName, failed))
    run.picture = std::make_shared<const render::RetractionScene>(
        pipeline::readPictureFile(work / results / pipeline::pictureFileName).scene);
  return run;
}

}  // namespace glisson::session
