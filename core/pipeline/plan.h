// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "pipeline/scene.h"

namespace glisson::pipeline {

/// One step that a scene needs, or leaves out, and why.
struct PlanStep {
  std::string step;  ///< "read-mri", "rasterise-roi", "assemble-mass", ...
  bool needed = false;
  std::string why;
  double seconds = 0.0;  ///< predicted by plan(), measured after run()
  double peak_MB = 0.0;
};

/// Every step the software knows, in order, each needed or left out with its reason.
std::vector<PlanStep> plan(const Scene& scene);

/// What makes one doubt a scene before anything is solved, and which of its settings go unused.
Diagnostics toldOf(const Scene& scene);

}  // namespace glisson::pipeline
