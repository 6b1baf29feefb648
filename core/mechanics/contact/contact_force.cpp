// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "mechanics/contact/contact_solver.h"

namespace glisson::mechanics {
namespace {

using State = ContactSolver::State;

constexpr int meetingTries = 40;  ///< travels tried for one force
constexpr double snap = 0.01;     ///< of the force, by which it jumps where the body snaps

struct Meeting {
  /// An equilibrium on one side of the force.
  struct Side {
    State state;
    double off_N = 0;  ///< force less goal
  };
  ContactSolver& solver;
  State& state;
  double tolerance, goal_N;
  NewtonRun& run;
  std::optional<Side> below, above;
  State trial;
  double step = ContactSolver::firstStep_m, best_N = 0, bestAt_m = 0;
  bool tight = false, walkedBack = false;
  int freely = 2;

  Meeting(ContactSolver& s, State& at, double tol, NewtonRun& r)
      : solver(s), state(at), tolerance(tol), goal_N(*s.problem().force_N), run(r), trial(at), bestAt_m(at.s) {}

  /// On the way a loose answer is enough. Once the force has been passed it has to be the answer itself.
  bool converges() {
    State next = trial;
    run = solver.energy().passes(state, next)
              ? solver.converge(next, {}, tight ? tolerance : ContactSolver::pathTolerance, 60)
              : NewtonRun{};
    if (run.converged) state = std::move(next);
    return run.converged;
  }

  /// After a travel without an answer: a verdict, or closer to where it last went well.
  std::optional<bool> closer() {
    if (std::abs(trial.s - state.s) < ContactSolver::shortestStep_m) return false;
    const double s = 0.5 * (trial.s + state.s);
    trial = state;
    trial.s = s;
    step = std::max(ContactSolver::shortestStep_m, 0.5 * step);
    return {};
  }

  /// Between two sides: done, hopeless, or the next trial.
  std::optional<bool> between(int tries) {
    const Side &a = *below, &b = *above;
    const bool close = std::abs(b.state.s - a.state.s) < 0.1 * ContactSolver::shortestStep_m;
    if (close && b.off_N - a.off_N > snap * goal_N && !walkedBack) {
      // The body snaps between the two: from there on its new place is followed back to the force.
      walkedBack = true;
      below.reset();
      trial = state = b.state;
      trial.s -= step = ContactSolver::shortestStep_m;
      return {};
    }
    if (std::abs(b.state.s - a.state.s) < 1e-9) return false;
    if (freely > 0 && std::abs(b.state.s - a.state.s) < ContactSolver::firstStep_m) {
      // So close the force itself can be given: that converges faster, if it stays near the two.
      --freely;
      State free = std::abs(a.off_N) < b.off_N ? a.state : b.state;
      run = solver.converge(free, goal_N, tolerance, 60);
      if (run.converged && std::abs(free.s - 0.5 * (a.state.s + b.state.s)) < ContactSolver::slipTravel_m) {
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
    if (!solver.energy().evaluate(trial, {}, false, value)) {
      const double s = trial.s;
      trial = state;
      trial.s = s;
    }
    return {};
  }

  /// At an equilibrium: done, slipped, or the next trial.
  std::optional<bool> judge(int tries) {
    const double off_N = solver.barForce(state) - goal_N;
    // Past the goal a state is loosely converged only: what is borne is known below it.
    if (off_N < 0 && off_N + goal_N > best_N) best_N = off_N + goal_N, bestAt_m = state.s;
    solver.met(off_N + goal_N, state);
    if (tight && std::abs(off_N) <= tolerance * goal_N) return true;
    if (!tight && (off_N < 0 ? above : below)) {
      tight = true;
      below.reset();
      above.reset();
      trial = state;
      step = std::min(step, ContactSolver::firstStep_m);
      return {};
    }
    (off_N < 0 ? below : above) = Side{state, off_N};
    if (below && above) return between(tries);
    if (below &&
        (off_N + goal_N < ContactSolver::slipFall * best_N || state.s > bestAt_m + ContactSolver::slipTravel_m))
      return solver.slips(best_N, bestAt_m);
    trial = state;
    trial.s += below ? step : -step;
    step = std::min(1.3 * step, ContactSolver::longestStep_m);
    return {};
  }
};

}  // namespace

bool meetForce(ContactSolver& solver, State& state, double tolerance, NewtonRun& run) {
  Meeting meeting(solver, state, tolerance, run);
  for (int tries = 0; tries < meetingTries; ++tries)
    if (const auto end = meeting.converges() ? meeting.judge(tries) : meeting.closer()) return *end;
  return false;
}

}  // namespace glisson::mechanics
