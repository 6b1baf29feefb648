// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/progress.h"
#include "mechanics/problem.h"
#include "mechanics/static_solve.h"

namespace glisson::mechanics {

/// A point whose displacement is asked for: a weighted sum of node displacements.
struct Landmark {
  std::vector<int> nodes;
  std::vector<double> weights;  ///< unitless, as many as nodes; they add up to 1 for a point inside the body
};

/// The landmark at a point (m, the body's axes), by the trilinear shape functions of the filled cell that holds it.
/// Throws BadInput where no filled cell does.
Landmark landmarkAt(const VoxelMesh& mesh, const Eigen::Vector3d& p_m);
/// One landmark per node: the whole field.
std::vector<Landmark> everyNode(const VoxelMesh& mesh);

/// Static condensation of the voxel FEM: the problem is linear, so what m tool inputs do to n landmarks is a 3n × m
/// matrix C = L K⁻¹ F, made once offline, one solve per input at full resolution. Online, one small dense product.
class CondensedModel {
 public:
  /// inputs: nodal load fields (3 × nodeCount, N) of unit tool inputs; the load of the scene that does not change may
  /// be one of them. Solves with the solver's own options; prescribed displacements of its supports must be zero
  /// (BadInput: they would not superpose; give them as an input with prescribe). Throws SolverFailed naming the input
  /// where a solve does not converge.
  CondensedModel(StaticSolver& solver, std::vector<NodalField> inputs, const std::vector<Landmark>& landmarks,
                 const Progress& progress = {});

  int inputs() const { return static_cast<int>(C_.cols()); }
  int landmarks() const { return static_cast<int>(C_.rows() / 3); }
  /// m per unit of input, 3 landmarks × inputs; row 3 l + axis.
  const Eigen::MatrixXd& response() const { return C_; }
  /// Displacement of every landmark, m, 3 landmarks values (x, y, z of landmark 0, then 1 ...). No allocation where u
  /// has that size already.
  void evaluate(const Eigen::VectorXd& amount, Eigen::VectorXd& u_m) const { u_m.noalias() = C_ * amount; }
  /// Work conjugate of the inputs, fᵢᵀ K⁻¹ fⱼ: m × m, symmetric, J per unit².
  const Eigen::MatrixXd& toolCompliance() const { return Ctt_; }
  /// Amounts of the inputs that bring their own mean displacement to ū: f = C_tt⁻¹ ū. mean_m: one value per input, the
  /// displacement along the input averaged with the input's own forces as weights, fᵢᵀu / Σ|fᵢ| (m).
  /// Throws BadInput where inputs depend on each other.
  Eigen::VectorXd prescribe(const Eigen::VectorXd& mean_m) const;
  /// The solves that were made, worst first residual.
  const SolveReport& worst() const { return worst_; }

 private:
  Eigen::MatrixXd C_, Ctt_;
  Eigen::VectorXd forceSum_N_;
  SolveReport worst_;
};

/// Steps, damping and basis of a condensed model in motion.
struct CondensedDynamicOptions {
  double h_s = 1e-3;
  int vectors = 8;  ///< per input
  /// Steps of full implicit Euler after a sudden unit load of each input, whose best basis is taken; 0 = Krylov
  /// vectors, which cost no more than `vectors` solves. Any motion under changing amounts is a sum of such step
  /// responses, so the steps should reach until the motion has died down. Takes 8 bytes for each step and degree of
  /// freedom meanwhile.
  int training = 0;
  double rayleighAlpha_1_s = 0.0;
  double rayleighBeta_s = 0.0;
  double tolerance = 1e-10;  ///< of the solves that make the basis
};

/// Dynamics of the voxel FEM in a small subspace, M-orthonormal. For each input K⁻¹ f (so rest is exact) and
///   Krylov     (K⁻¹M) K⁻¹ f, (K⁻¹M)² K⁻¹ f ... and, for the first instants, (M + hC + h²K)⁻¹ f;
///   trained    the principal vectors, in the mass norm, of what is left of its step response.
/// What the tool excites beyond the vectors is lost; the README of this room has what that costs. One step is a product
/// with a dense matrix of size() rows.
class CondensedDynamics {
 public:
  /// h is fixed here. Throws as CondensedModel does; BadInput for h_s ≤ 0 or vectors < 2.
  CondensedDynamics(StaticSolver& solver, const std::vector<NodalField>& inputs, const std::vector<Landmark>& landmarks,
                    const CondensedDynamicOptions& options, const Progress& progress = {});
  int size() const { return static_cast<int>(K_.rows()); }
  int inputs() const { return static_cast<int>(F_.cols()); }
  void reset();
  /// One implicit Euler step under the inputs' amounts at its end.
  void step(const Eigen::VectorXd& amount);
  double time_s() const { return t_s_; }
  /// Displacement of every landmark, m.
  void evaluate(Eigen::VectorXd& u_m) const { u_m.noalias() = L_ * q_; }
  /// Velocity (m/s) and acceleration (m/s², change of velocity over the last step) of every landmark.
  void evaluateRates(Eigen::VectorXd& v_m_s, Eigen::VectorXd& a_m_s2) const;
  /// mechanics::isAtRest as far as these vectors show it: a necessary condition for that of the body.
  bool isAtRest(const Eigen::VectorXd& amount, double tolerance) const;
  /// ½ vᵀMv + ½ qᵀKq, J.
  double energy_J() const { return 0.5 * v_.squaredNorm() + 0.5 * q_.dot(K_ * q_); }

 private:
  CondensedDynamicOptions options_;
  Eigen::MatrixXd K_, F_, L_, inverse_;  ///< in the basis, where M is the identity
  Eigen::VectorXd q_, v_, a_;
  double t_s_ = 0.0;
};

}  // namespace glisson::mechanics
