// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/progress.h"
#include "mechanics/kernel.h"
#include "mechanics/meshfree_clamp.h"
#include "mechanics/meshfree_solve.h"
#include "mechanics/problem.h"
#include "mechanics/voxel_operator.h"

namespace glisson::mechanics {

/// Frames of a mesh-free model and their shape functions.
struct MeshfreeOptions {
  int frames = 200;  ///< fewer are used, with a note, where the voxels are too coarse for so many
  Kernel kernel = Kernel::Wendland;
  int order = 1;       ///< 1: affine, 12 degrees of freedom a frame; 2: quadratic, 30; Mls: of the basis, 3 either way
  double alpha = 0.0;  ///< support radius over spacing; 0 = the kernel's own
  std::uint64_t seed = 1;
  int lloydIterations = 25;
  std::vector<double> density;  ///< wish for frames, one positive value per filled cell; empty = uniform
  Eigen::Matrix3Xd sites_m;     ///< where the frames are to sit (sitesAt); empty: `frames` of them are placed by Lloyd
};

/// The mesh-free model: u(x) = lift(x) + d(x) ∘ Σᵢ wᵢ(x) Σ_b P_b((x − xᵢ)/hᵢ) q_ib. Its displacements are a subspace of
/// the voxel FEM's, and its matrices the exact projection of the voxel FEM's (springs included), so its energy error is
/// one-sided: ½ fᵀu never exceeds that of the voxel FEM where no displacement is prescribed.
/// Fixations (any single axis, any prescribed value) enter through the distance clamp d and the lift, with both
/// kernels: the published method names no rule for fixed regions, and one common rule leaves the kernel as the only
/// difference.
class MeshfreeModel {
 public:
  /// Throws BadInput as VoxelOperator, placeSites, FrameBasis and distanceClamp do, and where the fixations leave no
  /// degree of freedom. Needs leastNodesOf(kernel, order) voxel nodes a frame; fewer frames are used otherwise: see
  /// notes().
  explicit MeshfreeModel(const Problem& problem, const MeshfreeOptions& options = {},
                         HexElement element = HexElement::Incompatible, const Progress& progress = {});

  int dofs() const { return static_cast<int>(K_.rows()); }
  int frames() const { return basis_.frames(); }
  const Eigen::SparseMatrix<double>& K() const { return K_; }  ///< N/m, symmetric, springs included
  const Eigen::SparseMatrix<double>& M() const { return M_; }  ///< kg, symmetric positive definite
  /// Φᵀ D f for nodal forces f (N): generalised forces, dofs() values.
  Eigen::VectorXd reduce(const NodalField& f_N) const;
  /// Generalised load of nodal forces: reduce(f − K lift).
  Eigen::VectorXd load(const NodalField& f_N) const;
  /// Displacements (m) at the voxel nodes for generalised displacements q (m).
  NodalField expand(const Eigen::VectorXd& q) const;
  /// The same without the lift: for velocities and increments.
  NodalField expandRate(const Eigen::VectorXd& v) const;
  /// Generalised displacements nearest to a nodal field in the mass norm. Throws SolverFailed where M has no factor.
  Eigen::VectorXd nearest(const NodalField& u_m) const;

  /// K q = load(f), f the problem's own load or another one. Auto: dense Cholesky with refinement up to 10,000 degrees
  /// of freedom, block-Jacobi CG above. Cg with options.iterations = 200 and no preconditioner is the published solver:
  /// what it leaves is in the report. The residual is that of the reduced system. reaction_N holds the forces that the
  /// clamp transmits, lumped to the nearest fixed nodes by virtual work: with the loads they balance exactly.
  /// Throws BadInput for Multigrid, and where the supports leave rigid motions free (requireSupported).
  Solution solveStatic(const SolverOptions& options = {}, const Progress& progress = {}) const;
  Solution solveStatic(const NodalField& f_N, const SolverOptions& options = {}, const Progress& progress = {}) const;
  /// Nodal solution for given q: displacement, reactions to the load f, energy.
  Solution solution(const Eigen::VectorXd& q, const NodalField& f_N) const;

  const NodalField& load_N() const { return f_N_; }
  const VoxelOperator& voxels() const { return *voxels_; }
  const FrameBasis& basis() const { return basis_; }
  const Clamp& clamp() const { return clamp_; }
  /// First degree of freedom of each frame, and dofs() at the end.
  const std::vector<int>& borders() const { return borders_; }
  /// What was changed against the options, and why.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  std::shared_ptr<const VoxelOperator> voxels_;
  FrameBasis basis_;
  Clamp clamp_;
  std::vector<int> number_;
  std::vector<int> borders_;
  Eigen::SparseMatrix<double> K_, M_;
  Supports supports_;
  NodalField f_N_;
  NodalField Klift_N_;
  std::vector<std::string> notes_;
};

}  // namespace glisson::mechanics
