// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <limits>
#include <sstream>
#include <utility>

#include "mechanics/contact/contact_solver.h"

namespace glisson::mechanics {
namespace {

using State = ContactSolver::State;

constexpr double farthest_m = 0.2;  ///< of travel
/// Where the body snaps and no short step is possible, longer ones may lead to where it bears the bar again.
constexpr std::array<double, 2> leap_m = {3e-3, 6e-3};
constexpr double base_m = 2e-3;  ///< of travel, that a leap is predicted from
constexpr int closer = 8;        ///< parts of the two steps beside the largest force
constexpr double closeTolerance = 1e-4;
constexpr double fallen = 0.98;  ///< of the largest force, where no step is possible: the bar slips

struct Path {
  ContactSolver& solver;
  State& state;
  bool first;
  double goal_N, end_m;
  double step = ContactSolver::firstStep_m, last_N = 0, best_N = 0, bestAt_m = 0;
  State before, reached;
  bool has = false;  ///< `reached` bears the force; the path goes on to its proof
  bool extrapolate = false, indefinite = false;
  std::size_t leaps = 0, steps = 0;

  Path(ContactSolver& s, State& at, PathKind kind)
      : solver(s),
        state(at),
        first(kind == PathKind::First),
        goal_N(s.problem().force_N ? (first ? s.options().proof : 1.0) * *s.problem().force_N : 0),
        end_m(s.problem().travel_m ? *s.problem().travel_m : std::numeric_limits<double>::infinity()),
        last_N(s.barForce(at)),
        best_N(last_N),
        bestAt_m(at.s),
        before(at) {
    if (first) solver.out().path.push_back({state.s, last_N});
  }

  /// Between the steps beside the largest force, in short steps to a close answer: the largest force of those is what
  /// is borne. True where that is the force asked for after all.
  bool bearsCloser() {
    const std::vector<State>& trail = solver.trail();
    const auto top = std::find_if(trail.begin(), trail.end(), [&](const State& s) { return s.s >= bestAt_m - 1e-9; });
    if (!solver.problem().force_N || trail.empty() || top == trail.begin()) return false;
    State last = *(top - 1), at = last;
    const double end = top + 1 < trail.end() ? (top + 1)->s : state.s, part = (end - last.s) / closer;
    double close_N = 0, closeAt_m = 0;
    for (int i = 0; i < closer; ++i) {
      State trial = at;
      for (std::size_t d = 0; i > 1 && d < trial.u.size(); ++d) trial.u[d] += at.u[d] - last.u[d];
      trial.s = at.s + (i == 0 ? 0 : part);
      if (!solver.energy().passes(at, trial) || !solver.converge(trial, {}, closeTolerance, 40).converged) break;
      last = std::exchange(at, std::move(trial));
      const double force_N = solver.barForce(at);
      if (force_N > close_N) {
        close_N = force_N;
        closeAt_m = at.s;
      }
      if (force_N < *solver.problem().force_N) continue;
      state = std::move(at);
      solver.endTrailAt(state.s);
      return true;
    }
    if (close_N > 0) {
      best_N = close_N;
      bestAt_m = closeAt_m;
    }
    return false;
  }

  bool ended(ContactOutcome outcome, bool exceeded) {
    ContactSolution& out = solver.out();
    out.outcome = outcome;
    // What finer cells bear counts, if they do not bear what was asked for.
    if (best_N > out.capacity_N || (!first && outcome != ContactOutcome::Reached)) {
      out.capacity_N = best_N;
      out.capacity_m = bestAt_m;
    }
    out.capacityExceeded = exceeded;
    return outcome == ContactOutcome::Reached;
  }

  /// What the next state is predicted from, beside the last one.
  const State& base() const {
    if (leaps == 0) return before;
    for (auto earlier = solver.trail().rbegin(); earlier != solver.trail().rend(); ++earlier)
      if (earlier->s <= state.s - base_m) return *earlier;
    return before;
  }

  State predicted() const {
    double target = state.s + step;
    if (target > end_m - 1e-9) target = end_m;
    State trial = state;
    const State& from = base();
    const double factor = extrapolate && state.s > from.s ? (target - state.s) / (state.s - from.s) : 0;
    for (std::size_t i = 0; factor > 0 && i < trial.u.size(); ++i) trial.u[i] += factor * (state.u[i] - from.u[i]);
    trial.s = target;
    return trial;
  }

  bool converges(State& trial, NewtonRun& run) {
    ContactEnergy::Value value;
    if (!solver.energy().evaluate(trial, {}, false, value) || !solver.energy().passes(state, trial)) return false;
    run = solver.converge(trial, {}, ContactSolver::pathTolerance, 40);
    indefinite = indefinite || run.indefinite;
    return run.converged;
  }

  /// After a step that failed: a verdict, or a shorter step.
  std::optional<bool> shorten() {
    if (leaps == 0) {
      step *= 0.6;
      if (step < 1.5e-3) extrapolate = false;
      if (step >= ContactSolver::shortestStep_m) return {};
    }
    if (!has && !solver.cuts() && steps > 0 && leaps < leap_m.size()) {
      step = leap_m[leaps++];
      extrapolate = true;
      return {};
    }
    if (first && !has && !solver.cuts() && bearsCloser()) return ended(ContactOutcome::Reached, false);
    // Where not even the first step was possible, nothing is known of what the place bears; nor where the coarse cells
    // bore more, and the force has not fallen on these.
    const bool gave = steps > 0 && !solver.cuts() && ((first && indefinite) || last_N < fallen * best_N);
    return ended(has                  ? ContactOutcome::Reached
                 : best_N > 0 && gave ? ContactOutcome::Slips
                                      : ContactOutcome::Stopped,
                 !has && gave);
  }

  void arrive(State&& trial) {
    const double force_N = solver.barForce(trial);
    if (!has) solver.leaveBehind(state);
    before = std::move(state);
    state = std::move(trial);
    extrapolate = true;
    if (leaps > 0) step = ContactSolver::firstStep_m;
    leaps = 0;
    ContactSolution& out = solver.out();
    if (first) out.path.push_back({state.s, force_N});
    solver.met(force_N, state);
    ++steps;
    out.largestDrop_N = std::max(out.largestDrop_N, last_N - force_N);
    last_N = force_N;
    std::ostringstream what;
    what.precision(3);
    what << "bar at " << 1e3 * state.s << " mm, " << force_N << " N";
    const double done = goal_N > 0 ? force_N / goal_N : state.s / solver.problem().travel_m.value_or(0.1);
    solver.progress().report(0.05 + 0.6 * std::min(1.0, done), what.str());
    if (force_N > best_N) {
      best_N = force_N;
      bestAt_m = state.s;
    }
  }

  /// At an equilibrium: whether the path ends here.
  std::optional<bool> verdict() {
    if (state.s >= end_m - 1e-9) return ended(ContactOutcome::Reached, last_N < ContactSolver::slipFall * best_N);
    if (!solver.problem().force_N) return {};
    if (!has && last_N >= *solver.problem().force_N) {
      has = true;
      reached = state;
    }
    if (last_N >= goal_N) {
      state = std::move(reached);
      return ended(ContactOutcome::Reached, false);
    }
    if (last_N < ContactSolver::slipFall * best_N || state.s > bestAt_m + ContactSolver::slipTravel_m) {
      if (has)
        state = std::move(reached);
      else if (first && bearsCloser())
        return ended(ContactOutcome::Reached, false);
      return ended(ContactOutcome::Slips, true);
    }
    return {};
  }
};

}  // namespace

bool followPath(ContactSolver& solver, State& state, PathKind kind) {
  Path path(solver, state, kind);
  while (state.s < farthest_m) {
    State trial = path.predicted();
    NewtonRun run;
    if (!path.converges(trial, run)) {
      if (const auto end = path.shorten()) return *end;
      continue;
    }
    path.arrive(std::move(trial));
    if (const auto end = path.verdict()) return *end;
    path.step = run.iterations <= 8 ? std::min(1.3 * path.step, ContactSolver::longestStep_m) : path.step;
    path.indefinite = false;
  }
  return path.ended(path.best_N > 0 ? ContactOutcome::Slips : ContactOutcome::Stopped, path.best_N > 0);
}

}  // namespace glisson::mechanics
