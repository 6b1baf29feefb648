#include "retraction/condensed_solve.h"

#include <algorithm>
#include <cmath>

#include "mechanics/condensed.h"
#include "mechanics/static_solve.h"

namespace glisson::retraction {
namespace {

/// Reactions and energy that belong to a displacement: what the supports must do for K u = f.
void completeSolution(const mechanics::VoxelOperator& voxels, const mechanics::NodalField& f_N,
                      mechanics::Solution& s) {
  const mechanics::NodalField internal_N = voxels.applyFree(s.u_m);
  const mechanics::NodalField spring_N = voxels.springForce(s.u_m);
  s.reaction_N = spring_N;
  for (int node = 0; node < voxels.mesh().nodeCount(); ++node)
    for (int axis = 0; axis < 3; ++axis)
      if (voxels.isFixed(node, axis))
        s.reaction_N(axis, node) += internal_N(axis, node) - spring_N(axis, node) - f_N(axis, node);
  s.energy_J = 0.5 * (s.u_m.cwiseProduct(internal_N).sum() - s.u_m.cwiseProduct(spring_N).sum());
}

mechanics::NodalField asField(const Eigen::VectorXd& u) {
  return Eigen::Map<const mechanics::NodalField>(u.data(), 3, u.size() / 3);
}

}  // namespace

CondensedAnswer solveCondensed(const mechanics::Problem& problem, const std::vector<mechanics::NodalField>& loads_N,
                               const Setup& setup, const Progress& progress) {
  mechanics::SolverOptions options = setup.solver;
  options.element = setup.model.element;
  mechanics::StaticSolver solver(problem.body, problem.supports, options, progress.part(0.0, 0.3));
  std::vector<mechanics::NodalField> inputs;
  for (const mechanics::NodalField& f : loads_N)
    if (f.cwiseAbs().maxCoeff() > 0.0) inputs.push_back(f);

  CondensedAnswer answer;
  const Eigen::Index nodes = solver.mesh().nodeCount();
  if (inputs.empty()) {
    answer.solution = solver.solve(problem.f_N);
    return answer;
  }
  const std::vector<mechanics::Landmark> everywhere = mechanics::everyNode(solver.mesh());
  const Eigen::VectorXd amount = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(inputs.size()));
  Eigen::VectorXd u_m = Eigen::VectorXd::Zero(3 * nodes);
  if (!setup.analysis.dynamic) {
    const mechanics::CondensedModel model(solver, inputs, everywhere, progress.part(0.3, 1.0));
    model.evaluate(amount, u_m);
    answer.solution.report = model.worst();
  } else {
    mechanics::CondensedDynamicOptions dynamic;
    dynamic.h_s = 1e-3 * setup.analysis.h_ms;
    dynamic.rayleighAlpha_1_s = setup.analysis.rayleigh[0];
    dynamic.rayleighBeta_s = setup.analysis.rayleigh[1];
    mechanics::CondensedDynamics model(solver, inputs, everywhere, dynamic, progress.part(0.3, 0.8));
    const auto steps = static_cast<int>(std::llround(setup.analysis.end_s / dynamic.h_s));
    Eigen::VectorXd before = u_m;
    for (int step = 0; step < steps; ++step) {
      model.step(amount);
      answer.steps = step + 1;
      if (setup.analysis.stopWhenSteady > 0.0) {
        model.evaluate(u_m);
        if ((u_m - before).norm() <= setup.analysis.stopWhenSteady * u_m.norm()) break;
        before = u_m;
      }
      if (step % 100 == 0) progress.part(0.8, 1.0).report(static_cast<double>(step) / steps, "time steps");
    }
    model.evaluate(u_m);
    answer.solution.report.status = mechanics::SolveStatus::Converged;
    answer.solution.report.tolerance = dynamic.tolerance;
    answer.solution.report.iterations = answer.steps;
  }
  answer.solution.u_m = asField(u_m);
  answer.solution.report.kind = "condensed";
  answer.solution.report.why =
      "asked for: " + std::to_string(inputs.size()) + " load column(s) of the full voxel model";
  completeSolution(solver.voxels(), problem.f_N, answer.solution);
  return answer;
}

}  // namespace glisson::retraction
