// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/private_folder.h"
#include "pipeline/export.h"
#include "session/session.h"

namespace glisson::session {

/// Where a format belongs in the dialog.
enum class FormatGroup { Dicom, Images, Meshes, Programs, Tables };
/// What must be there before a format can be written.
enum class FormatNeeds { Outlines, Elastogram, Run };

/// A format of pipeline::exportFormats() as the window offers it.
struct FormatOffer {
  const char* name;  ///< as the command line calls it
  FormatGroup group;
  FormatNeeds needs;
  const char* words;  ///< what is written; translated in the context "formats"
};
/// All of them, in the order of the dialog.
const std::vector<FormatOffer>& formatOffers();

/// What is shown now, by value: a worker exports it while the window goes on.
struct ExportSource {
  CaseRecord record;
  CaseFiles files;
  std::shared_ptr<const PrivateFolder> folder;  ///< where the case is written, as `files` expects it
  bool outlines = false;                        ///< there are any that count
  std::filesystem::path runFolder;              ///< empty where no run is of what is shown
  std::shared_ptr<const pipeline::RunResult> result;
};

/// Whether the source has what the format needs.
bool has(const ExportSource& source, FormatNeeds needs);

struct ExportWish {
  std::vector<std::string> formats;
  std::filesystem::path folder;  ///< made where it is missing
  bool replace = false;          ///< files of the same name in it; else it must be empty
  std::string caseName, reader;  ///< of tidy tables; nothing of the patient
};

/// Writes the formats into the folder. A format that is refused is in Exported::refused and the others are there; a
/// file is there as a whole or not at all. The run's numbers are taken, nothing is solved again. Throws BadInput where
/// nothing is asked for, or the folder cannot be written to or is not empty; Cancelled: then no file of it is there.
pipeline::Exported exportFormats(const ExportSource& source, const ExportWish& wish, const Progress& progress = {});

}  // namespace glisson::session
