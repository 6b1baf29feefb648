// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/progress.h"
#include "mechanics/meshfree.h"
#include "mechanics/problem.h"
#include "mechanics/tet_solve.h"

namespace glisson::study {

/// What one method makes of a problem, and how long each part takes.
struct Measured {
  int dofs = 0;
  int frames = 0;        ///< mesh-free only
  double build_s = 0.0;  ///< making the model: hierarchy or factor, shape functions, matrices, response
  double solve_s = 0.0;  ///< one more load on it
  double step_ms = std::numeric_limits<double>::quiet_NaN();  ///< one implicit Euler step of 1 ms; NaN: not measured
  mechanics::NodalField u_m;                                  ///< at the nodes of the voxel mesh
  bool converged = true;
  int iterations = 0;
  std::string note;  ///< how the solve ended where it did not converge
};

/// steps: implicit Euler steps to measure, 0 for none. All throw as the solvers do.
Measured measureVoxels(const mechanics::Problem& problem, const mechanics::SolverOptions& solver, int steps,
                       const Progress& progress);
Measured measureFrames(const mechanics::Problem& problem, const mechanics::MeshfreeOptions& options,
                       const mechanics::SolverOptions& solver, int steps, const Progress& progress);
/// tets: onTetrahedra(problem), with consistent loads; they have no time steps.
Measured measureTets(const mechanics::Problem& problem, const mechanics::TetProblem& tets, const Progress& progress);
/// build: one full solve per load; solve: the product with the response of every node; dofs: those of the full model.
Measured measureCondensed(const mechanics::Problem& problem, const std::vector<mechanics::NodalField>& loads_N,
                          int steps, const Progress& progress);

/// The quickest of up to three runs of what takes less than 50 ms: the first one pays for cold caches.
template <typename Run>
Measured quickest(const Run& run) {
  Measured best = run();
  for (int i = 0; i < 2 && best.build_s + best.solve_s < 0.05; ++i) {
    Measured again = run();
    if (again.build_s + again.solve_s < best.build_s + best.solve_s) best = std::move(again);
  }
  return best;
}

/// "stopped at the iteration limit after 200 iterations, residual 0.027"; empty where converged.
std::string ending(const mechanics::SolveReport& report);

}  // namespace glisson::study
