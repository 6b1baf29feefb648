// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mechanics/factorisation.h"
#include "mechanics/krylov.h"
#include "mechanics/multigrid.h"
#include "mechanics/solution_history.h"
#include "mechanics/voxel_operator.h"

namespace glisson::mechanics {

/// Solves (m M + k K) x = b of a voxel body, the matrix of an implicit time step, for one right side after another, on
/// row storage. The choice of solvers is VoxelSystem's. What Auto iterates on without a tolerance asked for it solves
/// to 100 times the usual one, which leaves the end of a motion within about the usual one; a tolerance asked for is
/// kept (SolverOptions::keepsTolerance). Iterations start from the combination of the last solutions that is nearest to
/// the answer (SolutionHistory). Multigrid, and what Auto chooses, iterate in float on the true residual in double, and
/// go over to double where float no longer halves it. A residual at the rounding of double precision has converged, as
/// StaticSolver has it.
class StepSolver {
 public:
  StepSolver(std::shared_ptr<const VoxelOperator> voxels, const SolverOptions& options);

  /// m > 0, k ≥ 0. Throws BadInput where a factor is asked for and the body is too large, SolverFailed where there is
  /// none.
  void prepare(double m, double k);
  /// b, x: 3 nodeSlots() values; b becomes 0 at fixed degrees of freedom. x: the start on entry where it has b's size
  /// and no system was solved since prepare, the solution on return. The report's residual is ‖b − A x‖ / ‖b‖.
  SolveReport solve(std::vector<double>& b, std::vector<double>& x);

 private:
  struct Run;

  void choose();
  double expectedIterations() const;
  void makeFactor();
  void makeMultigrid();
  NodalField diagonal() const;  ///< of m M + k K
  Preconditioning jacobi() const;
  template <class T>
  PreconditioningOf<T> blockJacobi() const;

  double residual(const Run& run);
  void begin(Run& run);
  void remember(const Run& run);
  void refineInFloat(Run& run, const PreconditioningOf<float>& M, int limit, bool flexible);
  template <class Z>
  void iterateInDouble(Run& run, const PreconditioningOf<double, Z>& M, int limit, bool flexible);
  bool acceptRounding(Run& run) const;
  void byMultigrid(Run& run);
  void byFactor(Run& run);

  std::shared_ptr<const VoxelOperator> voxels_;
  SolverOptions options_;
  double m_ = 1, k_ = 1;
  LatticeOperator<double> A_;
  LatticeOperator<float> A32_;  ///< where the solver iterates in float
  Preconditioning M_;
  PreconditioningOf<float> M32_;
  std::unique_ptr<Multigrid> multigrid_;
  std::unique_ptr<Factorisation> factor_;
  std::string kind_, why_;
  SolutionHistory history_;
  std::vector<double> r_, d_;
  std::vector<double> start_, first_;  ///< x and b − A x at the start
};

}  // namespace glisson::mechanics
