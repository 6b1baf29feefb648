// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "study/beam.h"

namespace glisson::study {

/// What a method makes of the beam.
struct BeamAnswer {
  std::string method, resolution;
  int dofs = 0;
  double build_s = 0.0, solve_s = 0.0, step_ms = 0.0;
  std::vector<double> axis_mm;
  bool converged = true;
  std::string note;
};

/// A method at one resolution. weight: expected share of the work, for progress.
struct BeamMethod {
  std::string name;
  double weight = 1.0;
  std::function<BeamAnswer(Root, const Progress&)> run;
};

/// Every method and resolution of the study.
std::vector<BeamMethod> beamMethods(const BeamOptions& options);

}  // namespace glisson::study
