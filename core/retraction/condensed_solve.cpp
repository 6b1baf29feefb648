// SPDX-License-Identifier: GPL-3.0-or-later
#include "retraction/condensed_solve.h"

#include <algorithm>
#include <cmath>

#include "mechanics/condensed.h"
#include "mechanics/dynamics.h"
#include "mechanics/static_solve.h"

namespace glisson::retraction {
namespace {

using mechanics::NodalField;

constexpr double mToMm = 1e3;
/// The reduced test of rest is passed this much earlier than the full one, which costs a product with K.
constexpr double earlier = 3.0;
constexpr int errorSamples = 4;  ///< of a motion, beside its first step

NodalField asField(const Eigen::VectorXd& u) {
  return Eigen::Map<const NodalField>(u.data(), 3, u.size() / 3);
}

/// A condensed motion seen on the full model.
struct Motion {
  mechanics::StaticSolver& solver;
  const NodalField& f_N;
  mechanics::CondensedDynamics& model;
  const AnalysisSpec& analysis;
  Eigen::VectorXd u_m, v_m_s, a_m_s2;

  void read() {
    model.evaluate(u_m);
    model.evaluateRates(v_m_s, a_m_s2);
  }
  NodalField onFree(NodalField f) const {
    solver.voxels().project(f);
    return f;
  }
  /// f − K u, and that less M a + C v, N; of the state last read.
  NodalField unbalance_N() const { return onFree(f_N - solver.voxels().apply(asField(u_m))); }
  NodalField missing_N() const {
    const mechanics::VoxelOperator& op = solver.voxels();
    const NodalField v = asField(v_m_s);
    return onFree(unbalance_N() - op.applyMass(asField(a_m_s2) + analysis.rayleigh[0] * v) -
                  analysis.rayleigh[1] * op.apply(v));
  }
  bool atRest(double h_s) {
    const double full_N = onFree(f_N).norm();
    read();
    return mechanics::isAtRest(full_N > 0.0 ? unbalance_N().norm() / full_N : 0.0, h_s * v_m_s.norm(), u_m.norm(),
                               analysis.stopWhenSteady);
  }
  /// Largest displacement that the vectors miss at present.
  double error_mm() {
    read();
    return mToMm * solver.solve(missing_N()).u_m.colwise().norm().maxCoeff();
  }
};

void move(const mechanics::Problem& problem, mechanics::StaticSolver& solver, const std::vector<NodalField>& inputs,
          const Setup& setup, const Progress& progress, CondensedAnswer& answer) {
  const mechanics::TimeSteps plan = mechanics::timeSteps(1e-3 * setup.analysis.h_ms, setup.analysis.end_s);
  mechanics::CondensedDynamicOptions dynamic;
  dynamic.h_s = plan.h_s;
  dynamic.rayleighAlpha_1_s = setup.analysis.rayleigh[0];
  dynamic.rayleighBeta_s = setup.analysis.rayleigh[1];
  mechanics::CondensedDynamics model(solver, inputs, mechanics::everyNode(solver.mesh()), dynamic,
                                     progress.part(0.0, 0.7));
  const Eigen::VectorXd amount = Eigen::VectorXd::Ones(model.inputs());
  Motion motion{solver, problem.f_N, model, setup.analysis, {}, {}, {}};
  const Progress stepping = progress.part(0.7, 1.0);
  for (int step = 1; step <= plan.count && !answer.steady; ++step) {
    model.step(amount);
    answer.steps = step;
    answer.steady = model.isAtRest(amount, earlier * setup.analysis.stopWhenSteady) && motion.atRest(plan.h_s);
    const bool sampled = step == 1 || step % std::max(1, plan.count / errorSamples) == 0;
    if (sampled || answer.steady) answer.error_mm = std::max(answer.error_mm, motion.error_mm());
    if (step % 100 == 0) stepping.report(static_cast<double>(step) / plan.count, "time steps");
  }
  answer.reached_s = answer.steps * plan.h_s;
  motion.read();
  answer.solution =
      mechanics::solutionInMotion(solver.voxels(), problem.f_N, asField(motion.u_m), asField(motion.v_m_s),
                                  asField(motion.a_m_s2), setup.analysis.rayleigh[0], setup.analysis.rayleigh[1]);
  mechanics::SolveReport& report = answer.solution.report;
  const double full_N = motion.onFree(problem.f_N).norm();
  report.residual = answer.steps > 0 && full_N > 0.0 ? motion.missing_N().norm() / full_N : 0.0;
  report.status = std::isfinite(report.residual) && answer.solution.u_m.allFinite() ? mechanics::SolveStatus::Converged
                                                                                    : mechanics::SolveStatus::NotFinite;
  report.tolerance = dynamic.tolerance;
  report.iterations = answer.steps;
}

}  // namespace

CondensedAnswer solveCondensed(const mechanics::Problem& problem, const std::vector<NodalField>& loads_N,
                               const Setup& setup, const Progress& progress) {
  mechanics::SolverOptions options = setup.solver;
  options.element = setup.model.element;
  mechanics::StaticSolver solver(problem.body, problem.supports, options, progress.part(0.0, 0.3));
  std::vector<NodalField> inputs;
  for (const NodalField& f : loads_N)
    if (f.cwiseAbs().maxCoeff() > 0.0) inputs.push_back(f);

  CondensedAnswer answer;
  if (inputs.empty()) {
    answer.solution = solver.solve(problem.f_N);
    answer.steady = true;
    return answer;
  }
  if (setup.analysis.dynamic) {
    move(problem, solver, inputs, setup, progress.part(0.3, 1.0), answer);
  } else {
    const mechanics::CondensedModel model(solver, inputs, mechanics::everyNode(solver.mesh()), progress.part(0.3, 1.0));
    Eigen::VectorXd u_m;
    model.evaluate(Eigen::VectorXd::Ones(model.inputs()), u_m);
    const NodalField none = NodalField::Zero(3, solver.mesh().nodeCount());
    answer.solution = mechanics::solutionInMotion(solver.voxels(), problem.f_N, asField(u_m), none, none, 0.0, 0.0);
    answer.solution.report = model.worst();
    answer.steady = true;
  }
  answer.solution.report.kind = "condensed";
  answer.solution.report.why =
      "asked for: " + std::to_string(inputs.size()) + " load column(s) of the full voxel model";
  return answer;
}

}  // namespace glisson::retraction
