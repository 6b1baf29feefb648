// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "base/progress.h"
#include "uncertainty/columns.h"
#include "uncertainty/one_stiffness.h"
#include "uncertainty/sampling.h"
#include "uncertainty/sources.h"
#include "uncertainty/surgeon.h"

namespace glisson::uncertainty {

/// A combination of all sources, drawn at random, solved in full.
struct Check {
  bool found = false;            ///< an equilibrium near the one at hand; else the rest is 0
  double change_mm = 0.0;        ///< of the landmarks' places (without any: of the cells'), rms, measured stiffness
  double missed_mm = 0.0;        ///< what the first order missed of it, rms
  double at_retractor_mm = 0.0;  ///< difference, in full
  double first_order_mm = 0.0;   ///< the same, to first order
};

/// How sure a retraction is.
struct Uncertainty {
  bool known = false;
  std::string why;  ///< where it is not
  Spread spread;
  std::vector<SourceWords> words;  ///< of spread.sources
  std::vector<Check> checks;
  std::optional<double> missedShare;  ///< Σ missed² over Σ change² of the checks, root; empty where none has an answer
  /// Of the difference at the retractor by the measured liver's stiffness; without a comparison of the bar's travel.
  std::optional<Leverage> leverage;
  std::optional<VesselTip> tip;  ///< where vessels end in the body
  /// Probability that the difference is 5 mm or more, on the model's grid, not a number outside the body; with a
  /// comparison.
  std::optional<image::ScalarVolume> beyond;
  int fields = 0, solves = 0, iterations = 0;
  Diagnostics diagnostics;
};

/// One sentence: the interval of the difference at the retractor, the probability of 5 mm, and the two sources that
/// drive it most. Without a comparison: how far off the vessels may be.
std::string inWords(const Spread& spread);

/// First order at the equilibrium, with its exact tangent: a linear solve for each random elastogram and each further
/// source; then draws of all of them. Full solves of a few draws say what the first order misses, which is added as a
/// source of its own. Not known where the tangent is not positive there. Throws Cancelled.
Uncertainty propagate(const Case& patient, const Options& options, std::uint64_t seed, const Progress& progress = {});

}  // namespace glisson::uncertainty
