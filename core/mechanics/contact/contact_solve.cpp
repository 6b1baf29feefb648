#include "mechanics/contact/contact_solve.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <sstream>

#include "base/error.h"
#include "mechanics/contact/contact_energy.h"
#include "mechanics/contact/contact_setup.h"
#include "mechanics/contact/follower_loads.h"
#include "mechanics/contact/newton.h"
#include "mechanics/supports.h"

namespace glisson::mechanics {
namespace {

constexpr double firstStep_m = 4e-3, longestStep_m = 6e-3, shortestStep_m = 1e-4;
constexpr double pathTolerance = 1e-2;
constexpr double farthest_m = 0.2;      ///< of travel
constexpr double slipFall = 0.75;       ///< of the largest force: the bar slips
constexpr double fallen = 0.98;         ///< of the largest force, where no step is possible: the bar slips
constexpr double slipTravel_m = 12e-3;  ///< past the largest force without reaching it again
constexpr int meetingTries = 40;        ///< travels tried for one force
constexpr int mostOnFinest = 300;        ///< iterations there, once the path is done

using State = ContactEnergy::State;

struct Solver {
  const ContactProblem& problem;
  const ContactOptions& options;
  const Progress& progress;
  SolidHierarchy hierarchy;
  std::vector<std::size_t> kept;  ///< samples that cells carry
  ContactEnergy energy;
  ContactSolution out;
  std::vector<std::vector<double>> loads;  ///< per level
  double metOnFinest = 0;                  ///< largest force that an equilibrium on the finest cells bore
  int spent = 0;                           ///< iterations on the finest cells
  std::vector<State> trail;                ///< of the path up to its end, of the level that is worked on

  Solver(const ContactProblem& p, const ContactOptions& o, const Progress& pr)
      : problem(p),
        options(o),
        progress(pr),
        hierarchy(finestLevel(p)),
        energy(hierarchy, carriedSurface(hierarchy, p, kept), p, o),
        loads(loadsOnLevels(hierarchy, p)) {}

  void useLevel(std::size_t l) { energy.setLoads(l, loads[l]); }
  NewtonRun converge(State& state, std::optional<double> force_N, double tolerance, int limit) {
    if (energy.top() == 0 && energy.top() < pathLevel(hierarchy, problem) && spent > mostOnFinest) return {};
    const NewtonRun run = minimise(hierarchy, energy, state, {force_N, tolerance, limit}, progress);
    out.newton += run.iterations;
    if (energy.top() == 0) spent += run.iterations;
    out.inner += run.inner;
    return run;
  }
  double barForce(const State& state) const {
    ContactEnergy::Value value;
    energy.evaluate(state, {}, false, value);
    return value.barForce_N;
  }
  bool follow(State& state);
  bool slips(double capacity_N);
  bool meetForce(State& state, double tolerance, NewtonRun& run);
  bool meetForceFromTrail(State& state, double tolerance, NewtonRun& run);
  bool finish(State& state);
  bool loadInSteps(State& state);
};

/// Travel in steps from `state` until force or travel is reached (true), or the force falls or no step is possible.
bool Solver::follow(State& state) {
  const double goal_N = problem.force_N ? options.proof * *problem.force_N : 0;
  double step = firstStep_m, last = barForce(state);
  double best = last, bestAt = state.s;
  State before = state, reached;
  bool has = false, extrapolate = false, indefinite = false;
  const double before_m = 0.5 * options.zone_m;  // travel counts from the first force
  const double end_m = problem.travel_m ? *problem.travel_m - before_m : std::numeric_limits<double>::infinity();
  out.path.push_back({state.s + before_m, last});
  const auto ended = [&](ContactOutcome outcome, bool exceeded) {
    out.outcome = outcome;
    out.capacity_N = std::max(out.capacity_N, best);
    out.capacityExceeded = exceeded;
    return outcome == ContactOutcome::Reached;
  };
  while (state.s < farthest_m) {
    double target = state.s + step;
    if (target > end_m - 1e-9) target = end_m;
    State trial = state;
    const double factor = extrapolate && state.s > before.s ? (target - state.s) / (state.s - before.s) : 0;
    for (std::size_t i = 0; factor > 0 && i < trial.u.size(); ++i) trial.u[i] += factor * (state.u[i] - before.u[i]);
    trial.s = target;
    ContactEnergy::Value value;
    bool good = energy.evaluate(trial, {}, false, value) && energy.passes(state, trial);
    NewtonRun run;
    if (good) {
      run = converge(trial, {}, pathTolerance, 40);
      good = run.converged;
      indefinite = indefinite || run.indefinite;
    }
    if (!good) {
      step *= 0.6;
      if (step < 1.5e-3) extrapolate = false;
      if (step < shortestStep_m)
        return ended(has              ? ContactOutcome::Reached
                     : best > 0 && (indefinite || last < fallen * best) ? ContactOutcome::Slips
                                                                        : ContactOutcome::Stopped,
                     !has && (indefinite || last < fallen * best));
      continue;
    }
    const double force = barForce(trial);
    if (!has) trail.push_back(state);
    before = std::move(state);
    state = std::move(trial);
    extrapolate = true;
    out.path.push_back({state.s + before_m, force});
    out.largestDrop_N = std::max(out.largestDrop_N, last - force);
    last = force;
    std::ostringstream what;
    what.precision(3);
    what << "bar at " << 1e3 * (state.s + before_m) << " mm, " << force << " N";
    progress.report(0.05 + 0.6 * std::min(1.0, goal_N > 0 ? force / goal_N : state.s / problem.travel_m.value_or(0.1)),
                    what.str());
    if (force > best) {
      best = force;
      bestAt = state.s;
    }
    if (state.s >= end_m - 1e-9) return ended(ContactOutcome::Reached, force < slipFall * best);
    if (problem.force_N) {
      if (!has && force >= *problem.force_N) {
        has = true;
        reached = state;
      }
      if (force >= goal_N) {
        state = std::move(reached);
        return ended(ContactOutcome::Reached, false);
      }
      if (force < slipFall * best || state.s > bestAt + slipTravel_m) {
        if (has) state = std::move(reached);
        return ended(ContactOutcome::Slips, true);
      }
    }
    step = run.iterations <= 8 ? std::min(1.3 * step, longestStep_m) : step;
    indefinite = false;
  }
  return ended(best > 0 ? ContactOutcome::Slips : ContactOutcome::Stopped, best > 0);
}

/// The travel at which the bar bears the force, with the travel prescribed: that stays well posed where the force hardly
/// rises any more, and where it falls. False where no step is possible or the force has fallen for good.
bool Solver::meetForce(State& state, double tolerance, NewtonRun& run) {
  const double goal = *problem.force_N;
  struct Side {
    State state;
    double off_N = 0;  ///< force less goal
  };
  std::optional<Side> below, above;
  State trial = state;
  double step = firstStep_m, best = 0, bestAt = state.s;
  bool indefinite = false, tight = false;
  int freely = 2;
  for (int tries = 0; tries < meetingTries; ++tries) {
    // On the way a loose answer is enough. Once the force has been passed it has to be the answer itself.
    State next = trial;
    run = energy.passes(state, next) ? converge(next, {}, tight ? tolerance : pathTolerance, 60) : NewtonRun{};
    indefinite = indefinite || run.indefinite;
    if (!run.converged) {
      // Closer to where it last went well. The body gives way and the force has nowhere to rise: the bar slips.
      if (std::abs(trial.s - state.s) < shortestStep_m) return indefinite && below && !above && slips(best);
      const double closer = 0.5 * (trial.s + state.s);
      trial = state;
      trial.s = closer;
      step = std::max(shortestStep_m, 0.5 * step);
      continue;
    }
    state = std::move(next);
    const double off = barForce(state) - goal;
    if (off + goal > best) best = off + goal, bestAt = state.s;
    if (energy.top() == 0) metOnFinest = std::max(metOnFinest, off + goal);
    if (tight && std::abs(off) <= tolerance * goal) return true;
    indefinite = false;
    if (!tight && (off < 0 ? above : below)) {
      tight = true;
      below.reset();
      above.reset();
      trial = state;
      step = std::min(step, firstStep_m);
      continue;
    }
    (off < 0 ? below : above) = Side{state, off};
    if (below && above) {
      const Side &a = *below, &b = *above;
      if (std::abs(b.state.s - a.state.s) < 1e-9) return false;
      if (freely > 0 && std::abs(b.state.s - a.state.s) < firstStep_m) {
        // So close the force itself can be given: that converges faster, if it stays near the two.
        --freely;
        State free = std::abs(a.off_N) < b.off_N ? a.state : b.state;
        run = converge(free, goal, tolerance, 60);
        if (run.converged && std::abs(free.s - 0.5 * (a.state.s + b.state.s)) < slipTravel_m) {
          state = std::move(free);
          return true;
        }
      }
      // Secant, kept away from both ends.
      double t = a.off_N / (a.off_N - b.off_N);
      if (tries % 4 == 3) t = 0.5;
      t = std::clamp(t, 0.02, 0.98);
      trial = std::abs(a.off_N) < b.off_N ? a.state : b.state;
      for (std::size_t i = 0; i < trial.u.size(); ++i) trial.u[i] = (1 - t) * a.state.u[i] + t * b.state.u[i];
      trial.s = (1 - t) * a.state.s + t * b.state.s;
      ContactEnergy::Value value;
      if (!energy.evaluate(trial, {}, false, value)) {
        const double s = trial.s;
        trial = state;
        trial.s = s;
      }
      continue;
    }
    if (below && (off + goal < slipFall * best || state.s > bestAt + slipTravel_m)) return slips(best);
    trial = state;
    trial.s += below ? step : -step;
    step = std::min(1.3 * step, longestStep_m);
  }
  return false;
}

bool Solver::slips(double capacity_N) {
  out.outcome = ContactOutcome::Slips;
  out.capacity_N = capacity_N;
  out.capacityExceeded = true;
  return false;
}

/// The force from the end of the path, or from the nearest state before it that is an equilibrium on these cells too.
bool Solver::meetForceFromTrail(State& state, double tolerance, NewtonRun& run) {
  const ContactOutcome before = out.outcome;
  for (std::size_t back = 0; back <= std::min<std::size_t>(trail.size(), 2); ++back) {
    State start = back == 0 ? state : trail[trail.size() - back];
    if (meetForce(start, tolerance, run)) {
      state = std::move(start);
      return true;
    }
    if (out.outcome != before) {
      state = std::move(start);
      return false;
    }
  }
  return false;
}

/// From the end of the path to the answer on the finest cells.
bool Solver::finish(State& state) {
  for (std::size_t l = energy.top();; --l) {
    if (l < energy.top()) {
      state.u = hierarchy.prolonged(l, state.u);
      if (trail.size() > 4) trail.erase(trail.begin(), trail.end() - 4);
      for (State& earlier : trail) earlier.u = hierarchy.prolonged(l, earlier.u);
      useLevel(l);
    }
    const bool lastLevel = l == 0 || options.pathOnly;
    const double tolerance = lastLevel ? options.tolerance : std::max(1e-3, options.tolerance);
    State trial = state;
    NewtonRun run = converge(trial, problem.force_N, tolerance, 80);
    if (run.converged && trial.s > state.s + slipTravel_m) run.converged = false;
    if (run.converged) {
      state = std::move(trial);
    } else {
      // The coarse cells bore more than these do, or the force hardly rises with travel.
      out.outcome = ContactOutcome::Stopped;
      if (!problem.force_N || !meetForceFromTrail(state, tolerance, run)) {
        out.solution.report.residual = run.residual;
        return false;
      }
      out.outcome = ContactOutcome::Reached;
    }
    out.solution.report.residual = run.residual;
    if (lastLevel) return true;
  }
}

/// Dead loads without a bar: in full, else in smaller parts.
bool Solver::loadInSteps(State& state) {
  double reached = 0, step = 1;
  const std::vector<double> whole = loads[0];
  while (reached < 1) {
    const double target = std::min(1.0, reached + step);
    std::vector<double> part = whole;
    for (double& f : part) f *= target;
    energy.setLoads(0, part);
    energy.setPressureShare(target);
    State trial = state;
    const NewtonRun run = converge(trial, {}, target < 1 ? std::max(1e-3, options.tolerance) : options.tolerance, 60);
    out.solution.report.residual = run.residual;
    if (run.converged) {
      state = std::move(trial);
      reached = target;
      if (run.iterations < 12) step *= 2;
      continue;
    }
    step *= 0.5;
    if (step < 1.0 / 64) return false;
  }
  return true;
}

/// A bed holds a body that lies on it, for the question whether anything holds it.
void requireHeld(const ContactProblem& problem) {
  const VoxelMesh mesh(problem.problem.body);
  Supports supports = problem.problem.supports;
  for (const BedSample& b : problem.bed)
    if (const auto cell = carrierCell(mesh, b.p_m))
      supports.springs.push_back({mesh.nodeAt(cell->x(), cell->y(), cell->z()), b.k_N_m * Eigen::Matrix3d::Identity()});
  requireSupported(mesh, supports);
}

ContactSolution solveOnce(const ContactProblem& problem, const ContactOptions& options, const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  Solver solver(problem, options, progress);
  State state;
  solver.useLevel(pathLevel(solver.hierarchy, problem));
  state.u = solver.energy.top() == 0 ? prescribedOnFinest(solver.hierarchy.level(0), problem)
                                     : std::vector<double>(3 * solver.hierarchy.level(solver.energy.top()).nodes(), 0.0);
  bool good = false;
  if (problem.bar) {
    state.s = -0.5 * options.zone_m;
    good = solver.follow(state);
    if (good) good = solver.finish(state);
  } else {
    good = solver.loadInSteps(state);
    solver.out.outcome = good ? ContactOutcome::Reached : ContactOutcome::Stopped;
  }
  // What was reached is told on the finest cells.
  while (solver.energy.top() > 0 && !options.pathOnly) {
    const std::size_t l = solver.energy.top() - 1;
    state.u = solver.hierarchy.prolonged(l, state.u);
    solver.useLevel(l);
  }
  describe(solver.hierarchy, solver.energy, problem, solver.kept, state, solver.out);
  // Cells that turn inside out before the force is borne: the body gives way under the bar.
  if (solver.out.outcome == ContactOutcome::Stopped && problem.bar && problem.force_N && solver.out.smallestJ <= 0 &&
      solver.metOnFinest > 0 && solver.metOnFinest < *problem.force_N)
    solver.slips(solver.metOnFinest);
  SolveReport& report = solver.out.solution.report;
  report.kind = "newton-multigrid-pcg";
  report.status = good ? SolveStatus::Converged : SolveStatus::StoppedAtLimit;
  report.iterations = solver.out.newton;
  report.tolerance = options.tolerance;
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return std::move(solver.out);
}

/// Pressures on faces whose rim moves have no potential: they act as dead loads that are turned after each solve, with
/// Aitken's relaxation, until they no longer change.
ContactSolution solveTurning(const ContactProblem& problem, const ContactOptions& options, const Progress& progress) {
  constexpr int most = 60;
  const VoxelMesh mesh(problem.problem.body);
  ContactProblem dead = problem;
  dead.pressures.clear();
  NodalField base = problem.problem.f_N;
  if (base.cols() == 0) base = NodalField::Zero(3, mesh.nodeCount());
  NodalField forces = followerForces(mesh, problem.pressures, NodalField::Zero(3, mesh.nodeCount())), before;
  double relaxation = 1;
  ContactSolution s;
  for (int turn = 0; turn < most; ++turn) {
    dead.problem.f_N = base + forces;
    s = solveOnce(dead, options, progress.part(static_cast<double>(turn) / most, (turn + 1.0) / most));
    if (!s.solution.report.converged()) return s;
    const NodalField change = followerForces(mesh, problem.pressures, s.solution.u_m) - forces;
    if (change.norm() <= std::max(options.tolerance, 1e-6) * forces.norm()) return s;
    if (turn > 0) {
      const NodalField bend = change - before;
      relaxation = std::clamp(-relaxation * before.cwiseProduct(bend).sum() / bend.squaredNorm(), 0.1, 2.0);
    }
    forces += relaxation * change;
    before = change;
  }
  s.outcome = ContactOutcome::Stopped;
  s.solution.report.status = SolveStatus::StoppedAtLimit;
  return s;
}

}  // namespace

ContactSolution solveContact(const ContactProblem& problem, const ContactOptions& options, const Progress& progress) {
  if (problem.bar && problem.force_N.has_value() == problem.travel_m.has_value())
    throw BadArgument("solveContact: give either the force or the travel of the bar");
  requireHeld(problem);
  const bool turning = !problem.pressures.empty() &&
                       !haveClosedOrHeldRim(VoxelMesh(problem.problem.body), problem.pressures,
                                            problem.problem.supports.fixations);
  return turning ? solveTurning(problem, options, progress) : solveOnce(problem, options, progress);
}

}  // namespace glisson::mechanics
