// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/scene.h"

namespace glisson::pipeline {

/// A case on disk, schema "glisson/case/1" (resources/schemas/case.schema.json): case.json, and beside it contours.json
/// and scene.json, whose SHA-256 it holds, as it holds its own.
struct CaseText {
  std::string record;    ///< case.json; what a window remembers of patient, slices and parameters is in it
  std::string contours;  ///< contours.json
  std::string scene;     ///< scene.json
  int version = 0;       ///< grows by one with each saving
};

inline constexpr int keptVersions = 10;

/// Whether this is a case file, or a folder that holds one.
bool isCase(const std::filesystem::path& path);

/// Writes contours.json, scene.json and case.json, each as a whole, case.json last; what was there before is kept in
/// versions/<n>/, the newest keptVersions of them. record: a JSON object without version, dates and digests, which are
/// added. Returns the new version. Killed at any moment, the folder reads as it was before or as it is after. Throws
/// BadInput where the folder cannot be written to: the case that was there stays readable.
int writeCase(const CaseText& text, const std::filesystem::path& folder);

/// Reads a case. file: case.json or its folder. A saving that was broken off gives what was saved before. Throws
/// BadInput that names the file where anything else differs from what was saved (a flipped bit, an edit by hand), and
/// the newest version that is whole.
CaseText readCase(const std::filesystem::path& file);

/// Versions that are kept beside a case, oldest first: folders that readCase takes.
std::vector<std::filesystem::path> versionsOf(const std::filesystem::path& folder);

/// Where the patient of a case is now: from the case's folder where both were moved together, else where it was.
std::filesystem::path patientOf(const CaseText& text, const std::filesystem::path& folder);

/// The scene of a case, as the workstation runs it: its outlines, its patient where that is now.
/// Throws BadInput as readCase and parseScene do, and where the patient is not to be found.
Scene sceneOfCase(const std::filesystem::path& file);

}  // namespace glisson::pipeline
