// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "pipeline/run.h"

namespace glisson::pipeline {

/// Where the files of a run that has ended go once more.
struct WriteAgain {
  std::filesystem::path from;  ///< folder the run was written into
  std::filesystem::path into;  ///< another folder; made where it is not there
  render::Palette palette = render::Palette::RedBlue;
  /// Files that lie in `into` already and are none of the run's: named in the record beside the outputs.
  std::vector<std::filesystem::path> beside{};
};

/// Writes what the run wrote into another folder, as the run itself would have with this palette: fields, tables and
/// picture data as they are, pictures drawn again, report and record with the digests of what lies in the new folder.
/// The scene is not copied: it names places on this computer. written: grows with every file begun, so that a caller
/// can take them away again. Throws BadInput where the run's files are gone or the folder cannot be written,
/// RenderUnavailable, Cancelled.
void writeAgain(const RunResult& result, const WriteAgain& where, std::vector<std::filesystem::path>& written,
                const Progress& progress = {});

}  // namespace glisson::pipeline
