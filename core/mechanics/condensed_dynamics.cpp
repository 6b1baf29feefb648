#include <Eigen/Dense>
#include <cmath>
#include <memory>

#include "base/error.h"
#include "mechanics/condensed.h"
#include "mechanics/dynamics.h"

namespace glisson::mechanics {
namespace {

Eigen::VectorXd flat(const NodalField& field) {
  return Eigen::Map<const Eigen::VectorXd>(field.data(), field.size());
}

/// Adds x to an M-orthonormal basis (twice Gram-Schmidt); false where x lies in its span already.
bool extend(const DynamicSystem& system, std::vector<Eigen::VectorXd>& basis, Eigen::VectorXd x) {
  Eigen::VectorXd Mx(x.size());
  system.applyM(x, Mx);
  const double before = std::sqrt(x.dot(Mx));
  if (!(before > 0.0)) return false;
  x /= before;
  for (int pass = 0; pass < 3; ++pass) {
    system.applyM(x, Mx);
    for (const Eigen::VectorXd& b : basis) x -= b.dot(Mx) * b;
    system.applyM(x, Mx);
    const double norm = std::sqrt(x.dot(Mx));
    if (!(norm > 1e-10)) return false;
    // After one pass, a vector that keeps its length is orthogonal to working accuracy.
    x /= norm;
    if (pass > 0 && norm > 0.9) break;
  }
  basis.push_back(std::move(x));
  return true;
}

}  // namespace

CondensedDynamics::CondensedDynamics(StaticSolver& solver, const std::vector<NodalField>& inputs,
                                     const std::vector<Landmark>& landmarks, const CondensedDynamicOptions& options,
                                     const Progress& progress)
    : options_(options) {
  const double h = options.h_s, alpha = options.rayleighAlpha_1_s, beta = options.rayleighBeta_s;
  if (!(h > 0.0) || !std::isfinite(h))
    throw BadInput("condensed dynamics: the time step must be positive, not " + std::to_string(h));
  if (options.vectors < 2)
    throw BadInput("condensed dynamics: " + std::to_string(options.vectors) + " vectors per input; use 2 or more");
  if (!(alpha >= 0.0 && beta >= 0.0)) throw BadInput("condensed dynamics: Rayleigh damping must not be negative");
  if (!solver.voxels().prescribed_m().isZero(0.0))
    throw BadInput(
        "condensation: the supports prescribe displacements that are not zero; fix those nodes at 0 and give "
        "the motion as a tool input");
  // The operator outlives this constructor's use of it: the solver is the caller's.
  const std::shared_ptr<const VoxelOperator> voxels(&solver.voxels(), [](const VoxelOperator*) {});
  SolverOptions cg;
  cg.tolerance = options.tolerance;
  VoxelSystem system(voxels, cg);
  system.prepare(1.0 + h * alpha, h * (h + beta));

  std::vector<Eigen::VectorXd> basis;
  const auto total = static_cast<double>(inputs.size()) * options.vectors;
  double done = 0.0;
  const auto require = [](const SolveReport& report, std::size_t input, int vector) {
    if (!report.converged())
      throw SolverFailed("condensed dynamics: vector " + std::to_string(vector) + " of tool input " +
                             std::to_string(input) + " ended with " + describe(report.status),
                         report.iterations, report.residual, report.tolerance);
  };
  for (std::size_t j = 0; j < inputs.size(); ++j) {
    Eigen::VectorXd b = flat(inputs[j]);
    for (int k = 0; k + 1 < options.vectors; ++k) {
      progress.report(++done / total, "condensing the dynamics");
      const Solution s = solver.solve(Eigen::Map<const NodalField>(b.data(), 3, b.size() / 3));
      require(s.report, j, k);
      const Eigen::VectorXd x = flat(s.u_m);
      const double size = x.norm();
      if (!(size > 0.0) || !extend(system, basis, x)) break;
      // The next moment of the response about rest, from the orthogonal part: the same span, and no loss of digits.
      system.applyM(basis.back(), b);
    }
    NodalField f_N = inputs[j];
    voxels->project(f_N);
    Eigen::VectorXd x = Eigen::VectorXd::Zero(b.size());
    require(system.solve(flat(f_N), x), j, options.vectors - 1);
    extend(system, basis, std::move(x));
  }
  const auto n = static_cast<Eigen::Index>(basis.size());
  K_.resize(n, n);
  F_.resize(n, static_cast<Eigen::Index>(inputs.size()));
  L_.resize(3 * static_cast<Eigen::Index>(landmarks.size()), n);
  Eigen::VectorXd Kb(voxels->dofs());
  for (Eigen::Index j = 0; j < n; ++j) {
    const Eigen::VectorXd& b = basis[static_cast<std::size_t>(j)];
    system.applyK(b, Kb);
    for (Eigen::Index i = 0; i < n; ++i) K_(i, j) = basis[static_cast<std::size_t>(i)].dot(Kb);
    for (std::size_t i = 0; i < inputs.size(); ++i) F_(j, static_cast<Eigen::Index>(i)) = b.dot(flat(inputs[i]));
    for (std::size_t l = 0; l < landmarks.size(); ++l) {
      if (landmarks[l].nodes.size() != landmarks[l].weights.size())
        throw BadArgument("condensation: a landmark's nodes and weights differ in number");
      Eigen::Vector3d u = Eigen::Vector3d::Zero();
      for (std::size_t i = 0; i < landmarks[l].nodes.size(); ++i) {
        const int node = landmarks[l].nodes[i];
        if (node < 0 || node >= voxels->mesh().nodeCount())
          throw BadArgument("condensation: landmark at node " + std::to_string(node));
        u += landmarks[l].weights[i] * b.segment<3>(3 * node);
      }
      L_.block<3, 1>(3 * static_cast<Eigen::Index>(l), j) = u;
    }
  }
  K_ = (0.5 * (K_ + K_.transpose())).eval();
  const Eigen::MatrixXd A = (1.0 + h * alpha) * Eigen::MatrixXd::Identity(n, n) + h * (h + beta) * K_;
  const Eigen::LLT<Eigen::MatrixXd> factor(A);
  if (n > 0 && factor.info() != Eigen::Success)
    throw SolverFailed("condensed dynamics: the reduced matrix of the step is not positive definite", 0, 1.0, 0.0);
  inverse_ = factor.solve(Eigen::MatrixXd::Identity(n, n));
  reset();
  progress.report(1.0, "condensing the dynamics");
}

void CondensedDynamics::reset() {
  q_ = Eigen::VectorXd::Zero(K_.rows());
  v_ = q_;
  t_s_ = 0.0;
}

void CondensedDynamics::step(const Eigen::VectorXd& amount) {
  if (amount.size() != inputs())
    throw BadArgument("condensed dynamics: " + std::to_string(amount.size()) + " amounts for " +
                      std::to_string(inputs()) + " inputs");
  const double h = options_.h_s, alpha = options_.rayleighAlpha_1_s, beta = options_.rayleighBeta_s;
  const Eigen::VectorXd b = h * (F_ * amount - K_ * (q_ + (h + beta) * v_) - alpha * v_);
  v_ += inverse_ * b;
  q_ += h * v_;
  t_s_ += h;
}

}  // namespace glisson::mechanics
