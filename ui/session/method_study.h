// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "base/progress.h"
#include "render/charts.h"
#include "session/parameters.h"
#include "study/tradeoff.h"

namespace glisson::session {

/// How well every method answers on this very patient, and how long it takes: the trade-off study of the command line
/// (`glisson-cli tradeoff case.json`), with the default method and the one that was chosen marked.
struct MethodStudy {
  study::TradeoffStudy study;
  std::optional<std::size_t> ofDefault, ofChoice;  ///< rows of the study; empty where the method is not among them
  render::XyChart chart;                           ///< error against run time, both axes logarithmic
};

/// Words for the two marked points, in the reader's language.
struct MethodWords {
  std::string title, time, error, ofDefault, ofChoice, both;
};

/// Measures the methods on a scene or case. Takes about a minute. Throws BadInput, SolverFailed, Cancelled as
/// study::studyTradeoff does.
MethodStudy studyMethods(const std::filesystem::path& scene, const Parameters& chosen, const MethodWords& words,
                         const Progress& progress = {});

/// The row that answers as these parameters ask: their method at the scene's own cells, or the nearest number of sites.
std::optional<std::size_t> rowOf(const std::vector<study::Row>& rows, const Parameters& parameters);

}  // namespace glisson::session
