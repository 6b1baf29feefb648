// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/dynamics.h"

#include <Eigen/Geometry>
#include <cmath>

#include "base/error.h"
#include "mechanics/time_stepper.h"

namespace glisson::mechanics {
namespace {

[[noreturn]] void refuse(const std::string& what, double value) {
  throw BadInput("dynamics: " + what + ", not " + std::to_string(value));
}

void checkOptions(const DynamicOptions& o) {
  if (!(o.rayleighAlpha_1_s >= 0.0)) refuse("Rayleigh alpha must be 0 or more", o.rayleighAlpha_1_s);
  if (!(o.rayleighBeta_s >= 0.0)) refuse("Rayleigh beta must be 0 or more", o.rayleighBeta_s);
  if (!(o.ramp_s >= 0.0)) refuse("the ramp must be 0 or more seconds", o.ramp_s);
  if (!(o.spectralRadius >= 0.0 && o.spectralRadius <= 1.0))
    refuse("the spectral radius must be 0 to 1", o.spectralRadius);
}

int severity(SolveStatus status) {
  switch (status) {
    case SolveStatus::Converged: return 0;
    case SolveStatus::StoppedAtLimit: return 1;
    case SolveStatus::Indefinite: return 2;
    case SolveStatus::NotFinite: break;
  }
  return 3;
}

/// Keeps the report with the largest residual, the most severe status, and the sum of seconds.
void merge(SolveReport& worst, const SolveReport& step, bool first) {
  if (first) {
    worst = step;
    return;
  }
  const double seconds = worst.seconds + step.seconds;
  Diagnostics said = worst.diagnostics;
  said.add(step.diagnostics);
  const SolveStatus status = severity(step.status) > severity(worst.status) ? step.status : worst.status;
  if (!(step.residual <= worst.residual)) worst = step;
  worst.status = status;
  worst.seconds = seconds;
  worst.diagnostics = std::move(said);
}

Eigen::VectorXd flat(const NodalField& field) {
  return Eigen::Map<const Eigen::VectorXd>(field.data(), field.size());
}

NodalField nodal(const Eigen::VectorXd& x) {
  return Eigen::Map<const NodalField>(x.data(), 3, x.size() / 3);
}

}  // namespace

const char* nameOf(TimeScheme scheme) {
  switch (scheme) {
    case TimeScheme::Newmark: return "newmark";
    case TimeScheme::GeneralisedAlpha: return "generalised-alpha";
    case TimeScheme::ImplicitEuler: break;
  }
  return "implicit-euler";
}

TimeSteps timeSteps(double h_s, double end_s) {
  if (!(h_s > 0.0) || !std::isfinite(h_s)) refuse("the time step must be positive", h_s);
  if (!(end_s >= 0.0) || !std::isfinite(end_s)) refuse("the end time must be 0 or more", end_s);
  if (end_s / h_s > 1e9) refuse("at most 1e9 steps: use a larger time step", end_s / h_s);
  const double count = std::ceil(end_s / h_s - 1e-9);
  const bool divides = std::abs(count * h_s - end_s) <= 1e-9 * h_s;
  return {static_cast<int>(count), divides ? h_s : end_s / count};
}

Trajectory integrate(DynamicSystem& system, const Eigen::VectorXd& f, const Eigen::VectorXd& q0,
                     const Eigen::VectorXd& v0, const DynamicOptions& options, const Progress& progress) {
  checkOptions(options);
  const Eigen::Index n = system.size();
  if (f.size() != n || q0.size() != n || v0.size() != n)
    throw BadArgument("integrate: vectors of " + std::to_string(f.size()) + ", " + std::to_string(q0.size()) + ", " +
                      std::to_string(v0.size()) + " values for " + std::to_string(n) + " degrees of freedom");
  for (const Eigen::Index p : options.probes)
    if (p < 0 || p >= n) throw BadArgument("integrate: probe " + std::to_string(p) + " of " + std::to_string(n));
  const auto [steps, h] = timeSteps(options.h_s, options.end_s);
  Trajectory out;
  out.h_s = h;
  DynamicState state{0, 0.0, q0, v0, Eigen::VectorXd::Zero(n)};
  const double fNorm = f.norm();
  const auto loadAt = [&](double t) { return options.ramp_s > 0.0 ? std::min(1.0, t / options.ramp_s) : 1.0; };
  TimeStepper stepper(system, f, q0, v0, h, options, loadAt(0.0));
  const auto observe = [&](double factor) {
    const TimeStepper::Seen seen = stepper.see(factor);
    out.times_s.push_back(state.t_s);
    out.energies.push_back({seen.kinetic_J, seen.elastic_J, -factor * f.dot(state.q)});
    if (!options.probes.empty()) {
      Eigen::VectorXd at(static_cast<Eigen::Index>(options.probes.size()));
      for (Eigen::Index i = 0; i < at.size(); ++i) at[i] = state.q[options.probes[static_cast<std::size_t>(i)]];
      out.probes.push_back(std::move(at));
    }
    if (options.keepEvery > 0 && state.step % options.keepEvery == 0) out.kept.push_back(state);
    out.unbalance = fNorm > 0.0 ? seen.unbalance_N / fNorm : 0.0;
  };
  observe(loadAt(0.0));
  while (state.step < steps) {
    progress.report(static_cast<double>(state.step) / steps, "time stepping");
    const double factor = loadAt((state.step + 1) * h);
    const SolveReport report = stepper.step(loadAt(state.step * h), factor, state);
    merge(out.worst, report, out.steps == 0);
    if (report.status == SolveStatus::NotFinite) break;
    state.t_s = ++state.step * h;
    out.steps = state.step;
    observe(factor);
    if (factor == 1.0 && isAtRest(out.unbalance, h * state.v.norm(), state.q.norm(), options.stopWhenSteady)) {
      out.steady = true;
      break;
    }
    if (options.onStep && !options.onStep(state)) break;
  }
  if (out.steps == 0) out.worst.status = SolveStatus::Converged;
  out.last = std::move(state);
  progress.report(1.0, "time stepping");
  return out;
}

Solution solutionInMotion(const VoxelOperator& voxels, const NodalField& f_N, const NodalField& u_m,
                          const NodalField& v_m_s, const NodalField& a_m_s2, double alpha_1_s, double beta_s) {
  Solution s;
  s.u_m = u_m;
  const NodalField spring_N = voxels.springForce(u_m);
  const NodalField internal_N = voxels.applyFree(u_m);
  s.energy_J = 0.5 * u_m.cwiseProduct(internal_N - spring_N).sum();
  const NodalField imbalance_N = internal_N - f_N + voxels.applyMass(a_m_s2 + alpha_1_s * v_m_s) +
                                 beta_s * (voxels.applyFree(v_m_s) - voxels.springForce(v_m_s));
  s.reaction_N = reactionForces(voxels.fixed(), spring_N, imbalance_N);
  return s;
}

DynamicSolution solveDynamic(const Problem& problem, const DynamicOptions& dynamic, const SolverOptions& solver,
                             const Progress& progress) {
  const auto voxels = std::make_shared<const VoxelOperator>(problem.body, solver.element, problem.supports);
  const int nodes = voxels->mesh().nodeCount();
  const NodalField f_N = problem.f_N.size() > 0 ? problem.f_N : NodalField::Zero(3, nodes);
  if (f_N.cols() != nodes)
    throw BadArgument("solveDynamic: a load of " + std::to_string(f_N.cols()) + " columns for " +
                      std::to_string(nodes) + " nodes");
  if (!f_N.allFinite()) throw BadInput("the load has a value that is not finite");
  // Prescribed displacements are there from the start; the rest of the body follows.
  const NodalField& lift_m = voxels->prescribed_m();
  NodalField free_N = f_N - voxels->applyFree(lift_m) + voxels->springForce(lift_m);
  voxels->project(free_N);

  VoxelSystem system(voxels, solver);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(system.size());
  DynamicSolution out;
  out.trajectory = integrate(system, flat(free_N), zero, zero, dynamic, progress);
  const DynamicState& last = out.trajectory.last;
  out.solution = solutionInMotion(*voxels, f_N, nodal(last.q) + lift_m, nodal(last.v), nodal(last.a),
                                  dynamic.rayleighAlpha_1_s, dynamic.rayleighBeta_s);
  out.solution.report = out.trajectory.worst;
  return out;
}

DynamicSolution solveDynamic(const MeshfreeModel& model, const DynamicOptions& dynamic, const SolverOptions& solver,
                             const Progress& progress) {
  MatrixSystem system(model.K(), model.M(), solver, model.borders());
  if (model.voxels().fixedCount() == 0 && model.voxels().springs().empty()) {
    const VoxelMesh& mesh = model.voxels().mesh();
    Eigen::MatrixXd rigid(model.dofs(), 6);
    for (int c = 0; c < 6; ++c) {
      NodalField motion(3, mesh.nodeCount());
      for (int node = 0; node < mesh.nodeCount(); ++node) {
        const Eigen::Vector3d axis = Eigen::Vector3d::Unit(c % 3);
        motion.col(node) = c < 3 ? axis : Eigen::Vector3d(axis.cross(mesh.position_m(node)));
      }
      rigid.col(c) = model.nearest(motion);
    }
    system.setFreeModes(rigid);
  }
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(system.size());
  DynamicSolution out;
  out.trajectory = integrate(system, model.load(model.load_N()), zero, zero, dynamic, progress);
  const DynamicState& last = out.trajectory.last;
  const VoxelOperator& voxels = model.voxels();
  const NodalField v = model.expandRate(last.v);
  const NodalField inertia_N = voxels.applyMass(model.expandRate(last.a) + dynamic.rayleighAlpha_1_s * v) +
                               dynamic.rayleighBeta_s * (voxels.applyFree(v) - voxels.springForce(v));
  out.solution = model.solution(last.q, model.load_N() - inertia_N);
  out.solution.report = out.trajectory.worst;
  return out;
}

}  // namespace glisson::mechanics
