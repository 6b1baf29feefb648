// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"

namespace glisson::study {

/// One stiff or extreme scene: what was expected, and what the software did.
struct StabilityCase {
  std::string name;
  std::string expectation;
  std::string verdict;    ///< "pass", "fail", "refused as expected"
  int iterations = 0;     ///< of the solve that took most
  double residual = 0.0;  ///< largest true relative residual of its solves
  std::string detail;     ///< the numbers behind the verdict
  double seconds = 0.0;
};

/// Extent of the sweep.
struct StabilityOptions {
  bool quick = false;  ///< smaller grids, without the 1 M degrees of freedom
};

/// Runs every case, one after the other; a case that throws what it should not is a "fail" with the message and does
/// not end the sweep. Throws Cancelled only.
std::vector<StabilityCase> stabilitySweep(const StabilityOptions& options = {}, const Progress& progress = {});

/// No case failed.
bool allAsExpected(const std::vector<StabilityCase>& cases);

}  // namespace glisson::study
