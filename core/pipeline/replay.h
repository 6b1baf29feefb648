// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/progress.h"

namespace glisson::pipeline {

/// Where a recorded run and its inputs are.
struct ReplayOptions {
  std::filesystem::path scene;   ///< empty: scene.json beside the record
  std::filesystem::path root;    ///< where the inputs are now; empty: where the scene says
  std::filesystem::path output;  ///< keeps what is computed again; empty: a temporary folder, removed afterwards
};

/// One file of the run, then and now. A digest is empty where the file was not written.
struct ReplayedFile {
  std::string file;
  std::string recorded, found;  ///< SHA-256
  bool identical() const { return recorded == found; }
};

/// What a run gave then and gives now.
struct ReplayResult {
  bool numbersIdentical = false;  ///< every number and word of the record but times, memory and version
  std::vector<ReplayedFile> outputs;
  std::vector<std::string> changed;  ///< filesOfAnotherRun
  std::vector<std::string> notes;
  bool identical() const;
};

/// The record of a run that is named by its record or by the folder it lies in.
std::filesystem::path recordOf(const std::filesystem::path& run);

/// Outputs that lie beside a run record and are not those it was written with, by name: another run has written into
/// the folder, or somebody has changed them. Files that are not there are not named. Throws BadInput where it is no
/// record.
std::vector<std::string> filesOfAnotherRun(const std::filesystem::path& record);

/// Runs the scene of a run record (or of the folder that holds it) again and compares every output by its digest.
/// Throws BadInput where the record is not one, the scene is not the recorded one, or an input is missing or changed.
ReplayResult replay(const std::filesystem::path& record, const ReplayOptions& options, const Progress& progress = {});

}  // namespace glisson::pipeline
