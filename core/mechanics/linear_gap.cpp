// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/linear_gap.h"

#include <algorithm>
#include <memory>

#include "base/error.h"
#include "base/random.h"
#include "mechanics/detail/newton_tangent.h"
#include "mechanics/meshfree_solve.h"
#include "mechanics/multigrid.h"
#include "mechanics/supports.h"

namespace glisson::mechanics {
namespace {

constexpr int directSize = 3000;         ///< degrees of freedom that are factorised at once
constexpr int secondResort = 20000;      ///< likewise where the iteration does not converge
constexpr int iterationLimit = 150;      ///< of each of the two solves
constexpr double correctionGoal = 1e-2;  ///< the correction itself is an estimate
constexpr double signGoal = 1e-4;

/// The tangent at the linear answer and its two ways of being solved.
class TangentAt {
 public:
  explicit TangentAt(const LargeDeformationModel& model) : model_(model) {}

  void project(Eigen::VectorXd& v) const { v = model_.held().reshaped().select(0.0, v.array()).matrix(); }

  /// Correction and sign by Cholesky.
  void factorise(const Eigen::VectorXd& r, Eigen::VectorXd& x, LinearGap& gap) const {
    BlockFactor factor(model_.tangent(), model_.held());
    const bool definite = factor.factorise(model_.tangent());
    gap.stability = definite ? Stability::Stable : Stability::Unstable;
    if (definite) factor.solve(r, x);
    gap.computed = definite && x.allFinite();
  }

  /// Correction and sign by conjugate gradients; Unknown where they come to no end.
  void iterate(const Eigen::VectorXd& r, Eigen::VectorXd& x, LinearGap& gap, const Progress& progress) {
    Multigrid multigrid(model_.op(), MultigridOptions::forPoisson(model_.op().body().poisson));
    std::vector<double> in(model_.op().lattice().size()), out(in.size());
    const VectorMap A = [&](const Eigen::VectorXd& p, Eigen::VectorXd& q) {
      model_.tangent().apply(p, q);
      project(q);
    };
    const VectorMap M = [&](const Eigen::VectorXd& p, Eigen::VectorXd& q) {
      const NodalField nodal = p.reshaped(3, p.size() / 3);
      NodalField z;
      model_.op().toSlots(nodal, in.data());
      multigrid.cycle(in, out);
      model_.op().fromSlots(out.data(), z);
      q = z.reshaped();
    };
    // The preconditioner's answer to random forces is mostly made of the body's softest motions.
    Random random(23);
    Eigen::VectorXd noise(r.size()), smooth;
    for (Eigen::Index i = 0; i < noise.size(); ++i) noise[i] = random.uniform(-1, 1);
    project(noise);
    M(noise, smooth);
    smooth /= smooth.cwiseAbs().maxCoeff();
    Eigen::VectorXd ignored = Eigen::VectorXd::Zero(r.size());
    const SolveReport sign = conjugateGradients(A, M, smooth, ignored, iterationLimit, signGoal, progress);
    if (sign.status == SolveStatus::Indefinite) {
      gap.stability = Stability::Unstable;
      return;
    }
    const double scale = r.cwiseAbs().maxCoeff();
    x.setZero(r.size());
    if (scale > 0) {
      const SolveReport s = conjugateGradients(A, M, r / scale, x, iterationLimit, correctionGoal, progress);
      x *= scale;
      if (s.status == SolveStatus::Indefinite) gap.stability = Stability::Unstable;
      gap.computed = s.converged() && x.allFinite();
    } else {
      gap.computed = true;
    }
    if (gap.computed && sign.converged()) gap.stability = Stability::Stable;
  }

 private:
  const LargeDeformationModel& model_;
};

}  // namespace

LinearGap linearGap(const Problem& problem, const NodalField& u_m, const SolverOptions& options,
                    const Progress& progress) {
  LinearGap gap;
  const VoxelMesh mesh(problem.body);
  if (u_m.cols() != mesh.nodeCount())
    throw BadArgument("linearGap: a displacement of " + std::to_string(u_m.cols()) + " nodes for " +
                      std::to_string(mesh.nodeCount()));
  if (3 * mesh.nodeCount() > largeDeformationLimit) {
    gap.why = "the body has more than " + std::to_string(largeDeformationLimit) + " degrees of freedom";
    return gap;
  }
  if (!findUnsupported(mesh, problem.supports).empty()) {
    gap.why = "the body is not held";
    return gap;
  }
  progress.report(0, "what linear theory misses");
  LargeDeformationModel model(problem, LargeDeformationKind::Corotational, options.element);
  double energy_J = 0;
  Eigen::VectorXd force_N;
  if (!model.evaluate(u_m.reshaped(), Tangent::Exact, energy_J, force_N)) {
    gap.why = "a cell is turned inside out";
    return gap;
  }
  TangentAt tangent(model);
  const NodalField linear_N = model.op().applyFree(u_m) - model.op().springForce(u_m);
  Eigen::VectorXd r = linear_N.reshaped() - force_N;
  tangent.project(r);
  Eigen::VectorXd x;
  const int free = model.op().dofs() - model.op().fixedCount();
  if (free <= directSize) {
    tangent.factorise(r, x, gap);
  } else {
    tangent.iterate(r, x, gap, progress);
    if (gap.stability == Stability::Unknown && free <= secondResort) tangent.factorise(r, x, gap);
  }
  if (gap.stability == Stability::Unstable) gap.computed = false;
  if (gap.computed)
    gap.correction_m = x.reshaped(3, mesh.nodeCount());
  else
    gap.why = gap.stability == Stability::Unstable ? "the body is not stable in the linear answer"
                                                   : "the correction could not be solved for";
  progress.report(1, "what linear theory misses");
  return gap;
}

}  // namespace glisson::mechanics
