// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "pipeline/detail/json_reader.h"
#include "retraction/setup.h"

namespace glisson::pipeline::detail {

// What a scene's text says of mechanics: supports, loads, model, analysis, solver. All throw BadInput with key and
// line.

/// value, which must be greater than 0; key is named where it is not.
double positive(JsonObject& o, const std::string& key, double value);

/// The file or folder that a key names, relative to the scene's folder; it must be there.
std::filesystem::path existing(JsonObject& o, const std::string& key, const std::filesystem::path& folder);

retraction::SupportSpec readSupport(JsonObject o, const std::filesystem::path& folder);
retraction::LoadSpec readLoad(JsonObject o, const std::filesystem::path& folder);
retraction::ModelSpec readModel(JsonObject o);
retraction::AnalysisSpec readAnalysis(JsonObject o);
mechanics::SolverOptions readSolver(JsonObject o);

}  // namespace glisson::pipeline::detail
