// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "base/progress.h"
#include "mechanics/problem.h"
#include "retraction/setup.h"

namespace glisson::retraction {

/// The answer of the condensed model.
struct CondensedAnswer {
  mechanics::Solution solution;
  int steps = 0;
  double reached_s = 0.0;
  bool steady = false;    ///< came to rest before end_s
  double error_mm = 0.0;  ///< motion: largest displacement that its few vectors miss of the full model, estimated
};

/// The scene answered through the condensed response of the full voxel model: one column per load, made once, then one
/// small dense product (static), or implicit Euler in 8 Krylov vectors per load (dynamic, from rest). Static answers
/// are those of the full solve to its tolerance. The motion ends at rest as the full solver defines it, or at end_s;
/// its reactions include inertia and damping; its report is Converged where all vectors are and every number is finite,
/// and its residual is that of the full equations of motion at the end. error_mm: K⁻¹ of what these equations leave, at
/// the end of the first step and of four more spread over the motion: the response of what the vectors lack, as far as
/// it is quicker than they are. loads_N: one nodal field per load of the scene. Throws SolverFailed naming the load
/// where a column does not converge; BadInput where a support prescribes a displacement other than zero.
CondensedAnswer solveCondensed(const mechanics::Problem& problem, const std::vector<mechanics::NodalField>& loads_N,
                               const Setup& setup, const Progress& progress);

}  // namespace glisson::retraction
