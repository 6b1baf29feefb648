// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "base/progress.h"
#include "base/quantity.h"

namespace glisson::pipeline {

struct RunResult;

/// What to export, and from what.
struct ExportRequest {
  std::filesystem::path source;  ///< a scene file, or the folder of a run (its scene.json is solved again)
  std::vector<std::string> formats;
  std::filesystem::path output;               ///< folder, made where it is missing
  std::uint64_t seed = 1;                     ///< of new DICOM identifiers
  std::string caseName;                       ///< "case" of tidy tables; no patient's name
  std::string reader;                         ///< "reader" of tidy tables
  std::optional<StiffnessQuantity> quantity;  ///< of exported stiffness; empty: as measured
  std::shared_ptr<const RunResult> solved;    ///< what the source's run gave, where it is at hand; null: solved again
  /// A format that the source cannot give is left out with its reason (Exported::refused), and the others are written;
  /// else it ends the export.
  bool leaveOutRefused = false;
};

/// A format that the source cannot give, and why. None of its files is in Exported::files.
struct RefusedFormat {
  std::string format, reason;
};

/// What an export has written.
struct Exported {
  std::vector<std::filesystem::path> files;
  std::vector<std::string> warnings;
  Diagnostics diagnostics;             ///< of what a format cannot say
  std::vector<RefusedFormat> refused;  ///< only with ExportRequest::leaveOutRefused
};

/// A format by the name that the command line uses, and what it gives.
struct ExportFormat {
  std::string name, gives;
};
std::vector<ExportFormat> exportFormats();

/// Writes the formats asked for. Steps that several formats share (reading, solving) are done once. Throws BadInput:
/// unknown format, a scene without what a format needs (naming it); SolverFailed, Cancelled.
Exported exportFiles(const ExportRequest& request, const Progress& progress = {});

}  // namespace glisson::pipeline
