// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/detail/methods.h"

#include <algorithm>
#include <memory>
#include <sstream>

#include "mechanics/condensed.h"
#include "mechanics/dynamics.h"
#include "mechanics/static_solve.h"
#include "study/detail/timing.h"

namespace glisson::study {

std::string ending(const mechanics::SolveReport& r) {
  if (r.converged()) return {};
  std::ostringstream t;
  t.precision(2);
  t << mechanics::describe(r.status) << " after " << r.iterations << " iterations, residual " << r.residual;
  return t.str();
}

Measured measureVoxels(const mechanics::Problem& problem, const mechanics::SolverOptions& solver, int steps,
                       const Progress& progress) {
  Measured m;
  const Stopwatch build;
  mechanics::StaticSolver s(problem.body, problem.supports, solver, progress);
  m.build_s = build.seconds();
  // Hierarchy or factor are made in the first solve: a second one shows what the solve alone takes.
  const Stopwatch both;
  mechanics::Solution answer = s.solve(problem.f_N, progress);
  const double first_s = both.seconds();
  const Stopwatch again;
  s.solve(problem.f_N, progress);
  m.solve_s = std::min(again.seconds(), first_s);
  m.build_s += first_s - m.solve_s;
  m.dofs = s.voxels().dofs();
  m.converged = answer.report.converged();
  m.iterations = answer.report.iterations;
  m.note = ending(answer.report);
  m.u_m = std::move(answer.u_m);
  if (steps > 0) {
    const auto operation =
        std::make_shared<const mechanics::VoxelOperator>(problem.body, solver.element, problem.supports);
    mechanics::NodalField load = problem.f_N;
    operation->project(load);
    mechanics::VoxelSystem system(operation);
    m.step_ms = stepTime_ms(system, load.reshaped(), steps, progress);
  }
  return m;
}

Measured measureFrames(const mechanics::Problem& problem, const mechanics::MeshfreeOptions& options,
                       const mechanics::SolverOptions& solver, int steps, const Progress& progress) {
  Measured m;
  const Stopwatch build;
  const mechanics::MeshfreeModel model(problem, options, solver.element, progress);
  m.build_s = build.seconds();
  const Stopwatch watch;
  mechanics::Solution answer = model.solveStatic(solver, progress);
  m.solve_s = watch.seconds();
  m.dofs = model.dofs();
  m.frames = model.frames();
  m.converged = answer.report.converged();
  m.iterations = answer.report.iterations;
  m.note = ending(answer.report);
  m.u_m = std::move(answer.u_m);
  if (steps > 0) {
    mechanics::MatrixSystem system(model.K(), model.M(), solver, model.borders());
    m.step_ms = stepTime_ms(system, model.load(problem.f_N), steps, progress);
  }
  return m;
}

Measured measureTets(const mechanics::Problem& problem, const mechanics::TetProblem& tets, const Progress& progress) {
  Measured m;
  const Stopwatch watch;
  mechanics::Solution answer = mechanics::solveTets(problem, tets, {}, progress);
  const double total_s = watch.seconds();
  m.solve_s = std::min(answer.report.seconds, total_s);
  m.build_s = total_s - m.solve_s;
  m.dofs = 3 * tets.mesh.nodeCount();
  m.converged = answer.report.converged();
  m.iterations = answer.report.iterations;
  m.note = ending(answer.report);
  m.u_m = std::move(answer.u_m);
  return m;
}

Measured measureCondensed(const mechanics::Problem& problem, const std::vector<mechanics::NodalField>& loads_N,
                          int steps, const Progress& progress) {
  Measured m;
  const Stopwatch build;
  mechanics::StaticSolver solver(problem.body, problem.supports, {}, progress);
  std::vector<mechanics::NodalField> inputs;
  for (const mechanics::NodalField& f : loads_N)
    if (f.size() > 0 && f.cwiseAbs().maxCoeff() > 0.0) inputs.push_back(f);
  const std::vector<mechanics::Landmark> everywhere = mechanics::everyNode(solver.mesh());
  const mechanics::CondensedModel model(solver, inputs, everywhere, progress);
  m.build_s = build.seconds();
  const Eigen::VectorXd amount = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(inputs.size()));
  Eigen::VectorXd u_m(3 * solver.mesh().nodeCount());
  constexpr int repeats = 100;  // one product is too short for the clock
  const Stopwatch online;
  for (int i = 0; i < repeats; ++i) model.evaluate(amount, u_m);
  m.solve_s = online.seconds() / repeats;
  m.dofs = solver.voxels().dofs();
  m.converged = model.worst().converged();
  m.u_m = u_m.reshaped(3, solver.mesh().nodeCount());
  if (steps > 0) {
    mechanics::CondensedDynamics moving(solver, inputs, everywhere, {}, progress);
    const Stopwatch watch;
    for (int i = 0; i < steps; ++i) {
      moving.step(amount);
      moving.evaluate(u_m);
    }
    m.step_ms = 1e3 * watch.seconds() / steps;
  }
  return m;
}

}  // namespace glisson::study
