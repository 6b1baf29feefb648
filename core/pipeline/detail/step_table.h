// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>

#include "base/progress.h"
#include "pipeline/detail/step_id.h"

namespace glisson::pipeline::detail {

struct Forecast;
struct RunState;

/// What one step is expected to take, told from the scene alone.
struct Estimate {
  bool needed = false;
  std::string why;  ///< why it is needed, or why it is left out
  double seconds = 0.0;
  double peak_MB = 0.0;
};

/// One step: what plan() says of it and what run() does for it.
struct Step {
  StepId id;
  const char* name;
  Estimate (*estimate)(const Forecast&);
  /// Done where the step is needed; null: other steps do it on their way.
  void (*work)(RunState&, const Progress&) = nullptr;
  /// Done whether or not the step is needed: leaves it out where the answers so far make it needless.
  void (*before)(RunState&) = nullptr;
  /// Done whether or not the step is needed: what follows from the answers so far.
  void (*after)(RunState&) = nullptr;
  bool writes = false;  ///< left alone where nothing is to be written
};

/// Every StepId once, in the order in which a run takes them.
std::span<const Step> stepTable();

}  // namespace glisson::pipeline::detail
