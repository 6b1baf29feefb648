// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/run.h"

namespace glisson::pipeline::detail {

/// The run record of contract.md as JSON text: results, solver history, every parameter with its unit, SHA-256 of the
/// inputs, of the results and of each file in result.files; version, seed. No user, host or path.
std::string runRecord(const Scene& scene, const RunResult& result, render::Palette palette, Language language);

/// In which the pictures of a record are; English of records that do not say.
Language languageOf(const std::string& record);

/// The record of a run with the files of another folder in it, drawn with this palette. beside: files that the run does
/// not write, named under "charts" with their digests.
std::string recordOfFiles(const std::string& record, const std::vector<std::filesystem::path>& files,
                          const std::vector<std::filesystem::path>& beside, render::Palette palette);

/// The inputs as the record holds them: as they were when the run read them.
std::vector<std::pair<std::string, std::string>> inputDigestsOf(const std::string& record);

/// What each input is, and its SHA-256 (of a folder: of the digests of its files, in their order).
std::vector<std::pair<std::string, std::string>> inputDigests(const Scene& scene);

/// The scene with every default written out and no path, as JSON text: what two runs of one scene have in common.
std::string parameters(const Scene& scene);

/// The scene as a file in the folder: every path as it is seen from there.
std::string sceneSeenFrom(const Scene& scene, const std::filesystem::path& folder);

/// Lengths of the displacement over the body.
struct Motion {
  double mean_mm = 0.0;          ///< over the cells
  double max_mm = 0.0;           ///< over the nodes
  double at_retractor_mm = 0.0;  ///< mean over the contact; 0 where there is no retractor
};
Motion motionOf(const retraction::Model& model, const retraction::Result& result);

}  // namespace glisson::pipeline::detail
