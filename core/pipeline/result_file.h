// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "pipeline/run.h"

namespace glisson::pipeline {

/// Name of the file in the folder of a run.
inline constexpr const char* resultFileName = "result.glisson";

/// Keeps a run as it was in memory, so that it can be shown again without solving again: everything of RunResult but
/// the picture (picture_file.h keeps that) and the smooth body. One file: "GLISSONR", number of the form, length and
/// SHA-256 of what follows, then the values as they lie in memory (little-endian). result.files: below the folder.
/// Throws BadInput where the folder cannot be written to.
void writeResultFile(const std::filesystem::path& folder, const RunResult& result);

/// Reads it back, bit by bit the same; files are named in this folder, wherever it lies now. Throws BadInput where the
/// file is missing, of another form, truncated or damaged.
RunResult readResultFile(const std::filesystem::path& folder);

}  // namespace glisson::pipeline
