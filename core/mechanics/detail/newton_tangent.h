// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "base/progress.h"
#include "mechanics/block_matrix.h"
#include "mechanics/corotational.h"
#include "mechanics/hyperelastic.h"
#include "mechanics/multigrid.h"
#include "mechanics/newton_solve.h"
#include "mechanics/voxel_operator.h"

namespace glisson::mechanics {

/// Energy, internal force and tangent of a voxel body under large deformation, springs included. Vectors are nodal
/// fields column by column (3 node + axis).
class LargeDeformationModel {
 public:
  LargeDeformationModel(const Problem& problem, LargeDeformationKind kind, HexElement element);

  const VoxelOperator& op() const { return op_; }
  const Eigen::Array<bool, 3, Eigen::Dynamic>& held() const { return op_.fixed(); }
  /// Energy (J) and its gradient (N) at u; with a tangent, its matrix is assembled. False where a cell is inside out.
  bool evaluate(const Eigen::VectorXd& u, Tangent tangent, double& energy_J, Eigen::VectorXd& force_N);
  const BlockMatrix& tangent() const { return *tangent_; }

 private:
  VoxelOperator op_;
  LargeDeformationKind kind_;
  CorotationalHex corotational_;
  NeoHookeanHex neoHookean_;
  Eigen::MatrixXi elements_;  ///< 8 × cells
  Eigen::VectorXd E_;
  std::unique_ptr<BlockMatrix> tangent_;
  std::vector<HexResponse> batch_;
};

/// Solves with the tangents of a model, one after the other.
class TangentSolver {
 public:
  /// Throws BadInput where Factorised is asked for beyond StaticSolver::factorisedLimit.
  TangentSolver(const LargeDeformationModel& model, const SolverOptions& options);
  ~TangentSolver();
  /// x = K⁻¹ b on the free unknowns for the model's present tangent. False where it is not positive definite, or the
  /// inner iteration came nowhere near.
  bool solve(const Eigen::VectorXd& b, Eigen::VectorXd& x, const Progress& progress);
  const std::string& kind() const { return kind_; }
  int innerIterations() const { return innerIterations_; }

 private:
  /// As solve; converged: the inner iteration did.
  bool iterate(const Eigen::VectorXd& b, Eigen::VectorXd& x, bool& converged, const Progress& progress);
  bool solveDirectly(const Eigen::VectorXd& b, Eigen::VectorXd& x);

  const LargeDeformationModel& model_;
  SolverOptions options_;
  bool mayFactorise_ = false;  ///< Auto, and small enough, should the multigrid not converge
  std::string kind_;
  std::unique_ptr<BlockFactor> factor_;
  std::unique_ptr<Multigrid> multigrid_;
  int innerIterations_ = 0;
};

}  // namespace glisson::mechanics
