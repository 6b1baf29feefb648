#pragma once

#include <vector>

#include "base/progress.h"
#include "mechanics/problem.h"
#include "retraction/setup.h"

namespace glisson::retraction {

struct CondensedAnswer {
  mechanics::Solution solution;
  int steps = 0;
};

/// The scene answered through the condensed response of the full voxel model: one column per load, made once, then one
/// small dense product (static), or implicit Euler in 8 Krylov vectors per load (dynamic, from rest). Static answers
/// are those of the full solve to its tolerance. loads_N: one nodal field per load of the scene. Throws SolverFailed
/// naming the load where a column does not converge; BadInput where a support prescribes a displacement other than
/// zero.
CondensedAnswer solveCondensed(const mechanics::Problem& problem, const std::vector<mechanics::NodalField>& loads_N,
                               const Setup& setup, const Progress& progress);

}  // namespace glisson::retraction
