// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/progress.h"

namespace glisson::study {

/// The parts of a credibility assessment after ASME V&V 40-2018.
enum class CredibilityTopic {
  ContextOfUse,
  CodeVerification,
  CalculationVerification,
  Validation,
  Uncertainty,
  Applicability
};
inline constexpr int credibilityTopics = 6;

/// "Context of use", ...
std::string nameOf(CredibilityTopic topic);

/// What became of a line of evidence.
enum class EvidenceState {
  Met,     ///< a figure that reaches what was wanted before it was computed
  Missed,  ///< one that does not
  Shown,   ///< a figure without a limit
  Stated,  ///< a statement, no figure
  NotRun   ///< nothing was computed; why says the reason
};

/// "met", "missed", "shown", "stated", "not run".
std::string nameOf(EvidenceState state);

/// A number behind a line.
struct EvidenceFigure {
  std::string name;
  double value = 0.0;
  std::string unit;
};

/// One line of the page.
struct Evidence {
  CredibilityTopic topic{};
  EvidenceState state = EvidenceState::NotRun;
  std::string what;
  std::string command;                  ///< that gives it again; empty for statements
  std::string found;                    ///< in words
  std::string wanted;                   ///< empty where there is no limit
  std::string why;                      ///< of what was not run, or was missed
  std::vector<EvidenceFigure> figures;  ///< what `found` is made of
};

/// Extent of the credibility page.
struct CredibilityOptions {
  bool quick = false;      ///< coarser grids, and without the uncertainty of the patient
  std::uint64_t seed = 1;  ///< of the synthetic patient
};

/// The credibility page.
struct Credibility {
  CredibilityOptions options;
  std::vector<Evidence> lines;  ///< in the order of the topics
};

/// Computes every figure anew: nothing is taken from an earlier run or typed in. What this program cannot compute by
/// itself (experiments, public data, other solvers) is a line that says so and names what would. A part that fails is
/// a line with its message. Minutes; throws Cancelled only.
Credibility studyCredibility(const CredibilityOptions& options, const Progress& progress = {});

/// Writes credibility.html and credibility.pdf; returns the files. Throws BadInput where the folder cannot be written.
std::vector<std::filesystem::path> writeCredibility(const std::filesystem::path& folder, const Credibility& study);

/// The lines for reading, one each.
std::string table(const Credibility& study);

}  // namespace glisson::study
