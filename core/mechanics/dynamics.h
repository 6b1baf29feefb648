// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <functional>
#include <memory>
#include <vector>

#include "base/progress.h"
#include "mechanics/meshfree.h"
#include "mechanics/meshfree_solve.h"
#include "mechanics/problem.h"
#include "mechanics/time_scheme.h"
#include "mechanics/voxel_operator.h"

namespace glisson::mechanics {

/// M q̈ + C q̇ + K q = f with M, K symmetric, M positive definite, K positive semi-definite.
class DynamicSystem {
 public:
  virtual ~DynamicSystem() = default;
  virtual Eigen::Index size() const = 0;
  virtual void applyK(const Eigen::VectorXd& x, Eigen::VectorXd& y) const = 0;  ///< N for m
  virtual void applyM(const Eigen::VectorXd& x, Eigen::VectorXd& y) const = 0;  ///< kg
  /// Makes ready to solve (m M + k K) x = b, m > 0, k ≥ 0; called once for many solves. Throws SolverFailed where that
  /// matrix has no factor.
  virtual void prepare(double m, double k) = 0;
  /// x: the start on entry where its size fits, the solution on return.
  virtual SolveReport solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const = 0;
  /// Motions r without any energy, K r = 0, as columns with rᵀ M r = 1 and orthogonal in M: the rigid motions of a body
  /// that nothing holds. None by default.
  virtual Eigen::MatrixXd freeModes() const { return {}; }
};

/// The columns made M-orthonormal (Gram-Schmidt, repeated), those that depend on earlier ones left out.
Eigen::MatrixXd massOrthonormal(const DynamicSystem& system, const Eigen::MatrixXd& vectors);

/// Stored matrices: a mesh-free model, or any small system. SolverOptions::kind Auto and Factorised: dense Cholesky,
/// made once in prepare; Cg: conjugate gradients from the last solution (iterations = 200 without preconditioner: as
/// published).
class MatrixSystem : public DynamicSystem {
 public:
  /// borders: diagonal blocks for Preconditioner::BlockJacobi; empty = blocks of 3.
  MatrixSystem(Eigen::SparseMatrix<double> K_N_m, Eigen::SparseMatrix<double> M_kg, const SolverOptions& options = {},
               std::vector<int> borders = {});
  Eigen::Index size() const override { return K_.rows(); }
  void applyK(const Eigen::VectorXd& x, Eigen::VectorXd& y) const override;
  void applyM(const Eigen::VectorXd& x, Eigen::VectorXd& y) const override;
  void prepare(double m, double k) override;
  SolveReport solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const override;
  /// Declares motions without energy (columns, any length). Throws BadArgument where one has K r ≠ 0 (1e-8 of the size
  /// that rounding could explain).
  void setFreeModes(const Eigen::MatrixXd& modes);
  Eigen::MatrixXd freeModes() const override { return freeModes_; }

 private:
  Eigen::MatrixXd freeModes_;
  Eigen::SparseMatrix<double> K_, M_, A_;
  SolverOptions options_;
  std::vector<int> borders_;
  std::unique_ptr<DenseCholesky> factor_;
  VectorMap preconditioner_;
};

/// The full voxel FEM, vectors are nodal fields column by column (3 × node + axis), 0 at fixed degrees of freedom.
/// SolverOptions::kind: Cg with its preconditioner, Multigrid (of the step's own matrix) and Cg in it, Factorised up to
/// StaticSolver::factorisedLimit, all from the best combination of the last solutions; Auto factorises small bodies,
/// else takes block-Jacobi CG where the step is short enough for the mass to rule, Multigrid where it is not, and says
/// why. Forces at fixed degrees of freedom are left out. Its free modes are the six rigid motions where nothing holds
/// it.
class VoxelSystem : public DynamicSystem {
 public:
  explicit VoxelSystem(std::shared_ptr<const VoxelOperator> voxels, const SolverOptions& options = {});
  ~VoxelSystem() override;
  Eigen::Index size() const override;
  void applyK(const Eigen::VectorXd& x, Eigen::VectorXd& y) const override;
  void applyM(const Eigen::VectorXd& x, Eigen::VectorXd& y) const override;
  void prepare(double m, double k) override;
  SolveReport solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const override;
  Eigen::MatrixXd freeModes() const override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Equal steps from 0 to end_s exactly: as many as steps of h_s reach it, so of the length asked for where that divides
/// the time, and a little shorter where it does not.
struct TimeSteps {
  int count = 0;
  double h_s = 0.0;
};
/// Throws BadInput for h_s ≤ 0, end_s < 0, values that are not finite, more than 1e9 steps.
TimeSteps timeSteps(double h_s, double end_s);

/// State of motion at the end of a time step.
struct DynamicState {
  int step = 0;
  double t_s = 0.0;
  Eigen::VectorXd q, v, a;  ///< m, m/s, m/s² (a by implicit Euler: change of v over the last step / h)
};

/// Time scheme, steps, damping and load of a motion.
struct DynamicOptions {
  TimeScheme scheme = TimeScheme::ImplicitEuler;
  double spectralRadius = 0.8;  ///< generalised alpha: what a step leaves of the fastest motions, 0 to 1
  double h_s = 1e-3;            ///< time step at most; timeSteps has the length taken
  double end_s = 2.0;
  double rayleighAlpha_1_s = 0.0;  ///< C = α M + β K
  double rayleighBeta_s = 0.0;
  double ramp_s = 0.0;                              ///< the load grows linearly over this time; 0 = at once
  double stopWhenSteady = 0.0;                      ///< stop where isAtRest, the load being full; 0 = never
  int keepEvery = 0;                                ///< keep every n-th state; 0 = none
  std::vector<Eigen::Index> probes;                 ///< entries of q recorded at every step
  std::function<bool(const DynamicState&)> onStep;  ///< after every step; false stops
};

/// What "at rest" means for every solver: ‖f − K q‖ ≤ tolerance ‖f‖ and ‖h v‖ ≤ tolerance ‖q‖. Neither alone will do:
/// the velocity vanishes at every turning point, the unbalance whenever the motion passes its equilibrium.
inline bool isAtRest(double unbalance, double hvNorm, double qNorm, double tolerance) {
  return tolerance > 0.0 && unbalance <= tolerance && hvNorm <= tolerance * qNorm;
}

/// Energies at one time.
struct StepEnergy {
  double kinetic_J = 0.0, elastic_J = 0.0;
  double load_J = 0.0;  ///< potential of the load, −fᵀq
  double total_J() const { return kinetic_J + elastic_J + load_J; }
};

/// A motion as integrated.
struct Trajectory {
  DynamicState last;
  std::vector<double> times_s;          ///< 0 and the end of every step
  std::vector<StepEnergy> energies;     ///< one per time
  std::vector<Eigen::VectorXd> probes;  ///< one per time, empty without probes
  std::vector<DynamicState> kept;
  int steps = 0;
  double h_s = 0.0;  ///< length of a step as taken
  bool steady = false;
  double unbalance = 0.0;  ///< ‖f − K q‖ / ‖f‖ of the last state (0 where f = 0)
  SolveReport worst;       ///< of the step with the largest residual; its status is the worst of all steps
};

/// Implicit Euler [baraff1998large] with the complete right-hand side, C = αM + βK:
///   (M + hC + h²K) v₊ = M v + h (f − K q),  q₊ = q + h v₊ (that is, M Δv = h (f − K q₊ − C v₊));
/// kinetic + elastic energy + load potential never grows under a constant load.
/// Newmark and generalised alpha: M a + C v + K q = f with a at t₊ − α_m h, the rest at t₊ − α_f h (t₊ the end of the
/// step; both 0 by Newmark), v₊ = v + h((1−γ) a + γ a₊), q₊ = q + h v + h²((½−β) a + β a₊), γ = ½ − α_m + α_f,
/// β = ¼(1 − α_m + α_f)²; α_m = (2ρ − 1)/(ρ + 1), α_f = ρ/(ρ + 1). The first a is that of the load and the state given.
/// Free modes R of the system are split off, as K R = 0 lets them be: v = R s + v_e, s by the same scheme without K,
/// and the rest v_e, q_e is kept M-orthogonal to R. So linear and angular momentum (of the reference shape) are kept to
/// rounding whatever the solver's tolerance, and elastic forces do not lose digits to the distance travelled.
/// Throws BadInput for h_s ≤ 0, end_s < 0, negative damping, a spectral radius beyond 0 to 1, more than 1e9 steps; a
/// step that does not converge is told in worst, and one with values that are not finite ends the run there.
Trajectory integrate(DynamicSystem& system, const Eigen::VectorXd& f, const Eigen::VectorXd& q0,
                     const Eigen::VectorXd& v0, const DynamicOptions& options, const Progress& progress = {});

/// The solution that belongs to a state of motion of a body under the load f_N: reactions with inertia and damping
/// (C = αM + βK), elastic energy; its report is left empty.
Solution solutionInMotion(const VoxelOperator& voxels, const NodalField& f_N, const NodalField& u_m,
                          const NodalField& v_m_s, const NodalField& a_m_s2, double alpha_1_s, double beta_s);

/// From rest. The solution is the last state: reactions include inertia and damping, energy_J is elastic, report is
/// that of the worst step.
struct DynamicSolution {
  Trajectory trajectory;
  Solution solution;
};
DynamicSolution solveDynamic(const Problem& problem, const DynamicOptions& dynamic, const SolverOptions& solver = {},
                             const Progress& progress = {});
DynamicSolution solveDynamic(const MeshfreeModel& model, const DynamicOptions& dynamic,
                             const SolverOptions& solver = {}, const Progress& progress = {});

}  // namespace glisson::mechanics
