// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "pipeline/run.h"
#include "render/overlay.h"

namespace glisson::session {

/// Name of the folder of a case that holds its last run: the case as it was run, and results/ below it, as the window's
/// work folder has them.
inline constexpr const char* lastRunName = "last-run";

/// A run as pages show it.
struct ShownRun {
  std::shared_ptr<const pipeline::RunResult> result;
  std::shared_ptr<const render::RetractionScene> picture;  ///< null where the scene drew none
};

/// Keeps the run of a work folder (case.json, results/) in the folder of a case, in place of the one kept before;
/// killed half way, either is there as a whole or none. Throws BadInput where it cannot be written.
void keepRun(const std::filesystem::path& work, const std::filesystem::path& caseFolder);

/// No run is kept in the case from now on.
void forgetRun(const std::filesystem::path& caseFolder);

/// Puts the run that is kept in a case into a work folder and reads it. Empty where none is kept. Throws BadInput where
/// it cannot be read, or where a file of it is not the one that was written.
std::optional<ShownRun> keptRun(const std::filesystem::path& caseFolder, const std::filesystem::path& work);

}  // namespace glisson::session
