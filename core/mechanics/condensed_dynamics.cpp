// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Dense>
#include <cmath>
#include <functional>
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

/// Adds the principal vectors, vectors − 1 at most, of the step response to f beyond the basis.
void train(VoxelSystem& system, const Eigen::VectorXd& f, const CondensedDynamicOptions& options, std::size_t input,
           std::vector<Eigen::VectorXd>& basis) {
  DynamicOptions dynamic;
  dynamic.h_s = options.h_s;
  dynamic.end_s = options.training * options.h_s;
  dynamic.rayleighAlpha_1_s = options.rayleighAlpha_1_s;
  dynamic.rayleighBeta_s = options.rayleighBeta_s;
  Eigen::MatrixXd S(f.size(), options.training);
  Eigen::VectorXd Mx(f.size());
  dynamic.onStep = [&](const DynamicState& state) {
    Eigen::VectorXd x = state.q;
    system.applyM(x, Mx);
    for (const Eigen::VectorXd& b : basis) x -= b.dot(Mx) * b;
    S.col(state.step - 1) = x;
    return true;
  };
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(f.size());
  const SolveReport worst = integrate(system, f, zero, zero, dynamic).worst;
  if (!worst.converged())
    throw SolverFailed("condensed dynamics: the step response to tool input " + std::to_string(input) + " ended with " +
                           describe(worst.status),
                       worst.iterations, worst.residual, worst.tolerance);
  Eigen::MatrixXd G(S.cols(), S.cols());
  for (Eigen::Index c = 0; c < S.cols(); ++c) {
    system.applyM(S.col(c), Mx);
    G.col(c) = S.transpose() * Mx;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(0.5 * (G + G.transpose()));
  const Eigen::VectorXd& size = eigen.eigenvalues();
  for (Eigen::Index k = 1; k < options.vectors && k <= S.cols(); ++k) {
    const Eigen::Index at = S.cols() - k;
    // Below this, the snapshots' own rounding.
    if (!(size[at] > 1e-15 * size[S.cols() - 1])) break;
    extend(system, basis, S * eigen.eigenvectors().col(at));
  }
}

void check(const CondensedDynamicOptions& options) {
  if (!(options.h_s > 0.0) || !std::isfinite(options.h_s))
    throw BadInput("condensed dynamics: the time step must be positive, not " + std::to_string(options.h_s));
  if (options.vectors < 2)
    throw BadInput("condensed dynamics: " + std::to_string(options.vectors) + " vectors per input; use 2 or more");
  if (options.training < 0) throw BadInput("condensed dynamics: a negative number of training steps");
  if (!(options.rayleighAlpha_1_s >= 0.0 && options.rayleighBeta_s >= 0.0))
    throw BadInput("condensed dynamics: Rayleigh damping must not be negative");
}

/// Vectors that the motion is condensed to: M-orthonormal, by moments of the response about rest, or trained.
class Basis {
 public:
  Basis(StaticSolver& solver, VoxelSystem& system, const CondensedDynamicOptions& options)
      : solver_(solver), system_(system), options_(options) {}

  /// Adds what the response to a tool input takes; tick is called before each vector.
  void add(const NodalField& input_N, std::size_t input, const std::function<void()>& tick) {
    Eigen::VectorXd b = flat(input_N);
    NodalField f_N = input_N;
    solver_.voxels().project(f_N);
    if (options_.training > 0) {
      extend(system_, vectors_, restUnder(b, input, 0));
      train(system_, flat(f_N), options_, input, vectors_);
      return;
    }
    for (int k = 0; k + 1 < options_.vectors; ++k) {
      tick();
      const Eigen::VectorXd x = restUnder(b, input, k);
      if (!(x.norm() > 0.0) || !extend(system_, vectors_, x)) break;
      // The next moment of the response about rest, from the orthogonal part: the same span, and no loss of digits.
      system_.applyM(vectors_.back(), b);
    }
    Eigen::VectorXd x = Eigen::VectorXd::Zero(b.size());
    require(system_.solve(flat(f_N), x), input, options_.vectors - 1);
    extend(system_, vectors_, std::move(x));
  }
  const std::vector<Eigen::VectorXd>& vectors() const { return vectors_; }

 private:
  static void require(const SolveReport& report, std::size_t input, int vector) {
    if (!report.converged())
      throw SolverFailed("condensed dynamics: vector " + std::to_string(vector) + " of tool input " +
                             std::to_string(input) + " ended with " + describe(report.status),
                         report.iterations, report.residual, report.tolerance);
  }
  Eigen::VectorXd restUnder(const Eigen::VectorXd& b, std::size_t input, int vector) {
    const Solution rest = solver_.solve(Eigen::Map<const NodalField>(b.data(), 3, b.size() / 3));
    require(rest.report, input, vector);
    return flat(rest.u_m);
  }

  StaticSolver& solver_;
  VoxelSystem& system_;
  const CondensedDynamicOptions& options_;
  std::vector<Eigen::VectorXd> vectors_;
};

/// Displacement of a landmark in the nodal field u.
Eigen::Vector3d displacementOf(const Landmark& landmark, const Eigen::VectorXd& u) {
  if (landmark.nodes.size() != landmark.weights.size())
    throw BadArgument("condensation: a landmark's nodes and weights differ in number");
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < landmark.nodes.size(); ++i) {
    const int node = landmark.nodes[i];
    if (node < 0 || 3 * node >= u.size()) throw BadArgument("condensation: landmark at node " + std::to_string(node));
    sum += landmark.weights[i] * u.segment<3>(3 * node);
  }
  return sum;
}

}  // namespace

CondensedDynamics::CondensedDynamics(StaticSolver& solver, const std::vector<NodalField>& inputs,
                                     const std::vector<Landmark>& landmarks, const CondensedDynamicOptions& options,
                                     const Progress& progress)
    : options_(options) {
  const double h = options.h_s, alpha = options.rayleighAlpha_1_s, beta = options.rayleighBeta_s;
  check(options);
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

  Basis basis(solver, system, options);
  const auto total = static_cast<double>(inputs.size()) * options.vectors;
  double done = 0.0;
  for (std::size_t j = 0; j < inputs.size(); ++j) {
    if (options.training > 0)
      progress.report(static_cast<double>(j) / static_cast<double>(inputs.size()), "condensing the dynamics");
    basis.add(inputs[j], j, [&] { progress.report(++done / total, "condensing the dynamics"); });
  }
  const auto n = static_cast<Eigen::Index>(basis.vectors().size());
  K_.resize(n, n);
  F_.resize(n, static_cast<Eigen::Index>(inputs.size()));
  L_.resize(3 * static_cast<Eigen::Index>(landmarks.size()), n);
  Eigen::VectorXd Kb(voxels->dofs());
  for (Eigen::Index j = 0; j < n; ++j) {
    const Eigen::VectorXd& b = basis.vectors()[static_cast<std::size_t>(j)];
    system.applyK(b, Kb);
    for (Eigen::Index i = 0; i < n; ++i) K_(i, j) = basis.vectors()[static_cast<std::size_t>(i)].dot(Kb);
    for (std::size_t i = 0; i < inputs.size(); ++i) F_(j, static_cast<Eigen::Index>(i)) = b.dot(flat(inputs[i]));
    for (std::size_t l = 0; l < landmarks.size(); ++l)
      L_.block<3, 1>(3 * static_cast<Eigen::Index>(l), j) = displacementOf(landmarks[l], b);
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
  v_ = a_ = q_;
  t_s_ = 0.0;
}

void CondensedDynamics::step(const Eigen::VectorXd& amount) {
  if (amount.size() != inputs())
    throw BadArgument("condensed dynamics: " + std::to_string(amount.size()) + " amounts for " +
                      std::to_string(inputs()) + " inputs");
  const double h = options_.h_s, alpha = options_.rayleighAlpha_1_s, beta = options_.rayleighBeta_s;
  const Eigen::VectorXd b = h * (F_ * amount - K_ * (q_ + (h + beta) * v_) - alpha * v_);
  const Eigen::VectorXd gain = inverse_ * b;
  v_ += gain;
  a_ = gain / h;
  q_ += h * v_;
  t_s_ += h;
}

void CondensedDynamics::evaluateRates(Eigen::VectorXd& v_m_s, Eigen::VectorXd& a_m_s2) const {
  v_m_s.noalias() = L_ * v_;
  a_m_s2.noalias() = L_ * a_;
}

bool CondensedDynamics::isAtRest(const Eigen::VectorXd& amount, double tolerance) const {
  const Eigen::VectorXd f = F_ * amount;
  const double size = f.norm();
  return mechanics::isAtRest(size > 0.0 ? (f - K_ * q_).norm() / size : 0.0, options_.h_s * v_.norm(), q_.norm(),
                             tolerance);
}

}  // namespace glisson::mechanics
