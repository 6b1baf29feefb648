// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "base/progress.h"
#include "mechanics/problem.h"
#include "mechanics/voxel_operator.h"

namespace glisson::mechanics {

/// Solves K u = f with prescribed displacements on one body for any number of loads; hierarchy or factorisation are
/// made once. Solvers, by SolverOptions::kind:
///   Cg          conjugate gradients; iterations = 200 and Preconditioner::None is the published method. A solve that
///               reaches its limit says StoppedAtLimit.
///   Factorised  supernodal Cholesky, refined; up to factorisedLimit degrees of freedom, beyond that BadInput with the
///               memory it would take.
///   Multigrid   geometric multigrid (float) inside conjugate gradients (double).
///   Auto        chooses from size, contrast and the number of loads so far (a small body is factorised when the ninth
///               comes) and says why in SolveReport::why; where the multigrid does not converge it falls back on
///               Factorised (when small enough), then on block-Jacobi conjugate gradients, and says
///               in SolveReport::diagnostics what that took.
/// The relative residual is ‖P(f − K u)‖ / ‖P(f − K ū)‖, ū the prescribed displacement extended by 0, P the free
/// degrees of freedom: without prescribed displacements ‖f − K u‖ / ‖f‖. f = 0 gives exactly u = 0. No absolute
/// thresholds. Storing u in double already leaves a residual of about ε ‖diag(K) u‖; where that floor lies above the
/// tolerance asked for, a solve that reaches it is Converged, SolveReport::tolerance is the floor, and SolveReport::why
/// says so.
class StaticSolver {
 public:
  static constexpr int factorisedLimit = 60000;  ///< degrees of freedom

  /// Throws BadInput as VoxelOperator does, and where a piece of the body is not held (requireSupported).
  StaticSolver(const VoxelBody& body, const Supports& supports, const SolverOptions& options = {},
               const Progress& progress = {});
  ~StaticSolver();
  StaticSolver(StaticSolver&&) noexcept;
  StaticSolver& operator=(StaticSolver&&) noexcept;

  const VoxelOperator& voxels() const;
  const VoxelMesh& mesh() const { return voxels().mesh(); }

  /// f_N: 3 × nodeCount. Throws BadInput where f is not finite, BadArgument on a wrong size, Cancelled; not converged
  /// is a status in the report. Not for several threads at once.
  Solution solve(const NodalField& f_N, const Progress& progress = {});

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// One solve of one problem.
Solution solveStatic(const Problem& problem, const SolverOptions& options = {}, const Progress& progress = {});

/// "converged", "stopped at the iteration limit", ...
std::string describe(SolveStatus status);

}  // namespace glisson::mechanics
