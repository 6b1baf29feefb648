// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "commands/outlines.h"
#include "session/settings.h"

namespace glisson::session {

/// What the window keeps in a case and takes up again; how it lies on disk is pipeline/case_folder.h, which the command
/// line reads too.
struct CaseRecord : Settings {
  std::filesystem::path source;  ///< the DICOM folder, file or archive; written relative and absolute
  std::string seriesUid;         ///< of the image drawn on
  commands::Outlines outlines;
  std::string sceneJson;             ///< text of scene.json
  std::optional<bool> lastRunStale;  ///< a run is kept beside it (kept_results.h): has anything changed since?
  int version = 0;                   ///< grows by one with each saving; set by readCaseRecord
};

/// Writes the case as pipeline::writeCase does, which see. Returns the new version.
int writeCaseRecord(const CaseRecord& record, const std::filesystem::path& folder);

/// Reads a case. file: case.json or its folder. Throws BadInput as pipeline::readCase and readContours do.
CaseRecord readCaseRecord(const std::filesystem::path& file);

}  // namespace glisson::session
