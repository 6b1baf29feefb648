// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/contact/contact_solve.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/error.h"
#include "mechanics/contact/contact_setup.h"
#include "mechanics/contact/contact_solver.h"
#include "mechanics/supports.h"

namespace glisson::mechanics {
namespace {

constexpr int mostOnFinest = 500;  ///< iterations there, once the path is done
constexpr double settled = 1e-4;   ///< of a state that is told of a bar that did not get there
constexpr int mostToSettle = 30;
constexpr std::size_t mostBehind = 2;  ///< states before it that are tried

/// A bed holds a body that lies on it, and tethers one that hangs on them, for the question whether anything holds it.
void requireHeld(const ContactProblem& problem) {
  const VoxelMesh mesh(problem.problem.body);
  Supports supports = problem.problem.supports;
  const auto hold = [&](const Eigen::Vector3d& p_m, const Eigen::Matrix3d& k_N_m) {
    if (const auto cell = carrierCell(mesh, p_m))
      supports.springs.push_back({mesh.nodeAt(cell->x(), cell->y(), cell->z()), k_N_m});
  };
  const Eigen::Matrix3d every = Eigen::Matrix3d::Identity();
  for (const BedSample& b : problem.bed) {
    const Eigen::Matrix3d along = b.outward * b.outward.transpose();
    hold(b.p_m, b.k_N_m * along + b.tangential_N_m * (every - along));
  }
  for (const Tether& t : problem.tethers) hold(t.p_m, t.k_N_m * every);
  requireSupported(mesh, supports);
}

/// Whether something resists when the whole body moves along d: what only presses or pulls may not.
bool resists(const ContactProblem& problem, const Eigen::Vector3d& d) {
  constexpr double least = 1e-3;  // of a unit
  const Supports& supports = problem.problem.supports;
  return std::any_of(supports.fixations.begin(), supports.fixations.end(),
                     [&](const Fixation& f) {
                       for (std::size_t c = 0; c < 3; ++c)
                         if (f.axis[c] && std::abs(d[static_cast<Eigen::Index>(c)]) > least) return true;
                       return false;
                     }) ||
         std::any_of(supports.springs.begin(), supports.springs.end(),
                     [&](const Spring& s) { return d.dot(s.k_N_m * d) > least * least * s.k_N_m.trace(); }) ||
         std::any_of(problem.bed.begin(), problem.bed.end(),
                     [&](const BedSample& b) {
                       const double along = d.dot(b.outward);
                       return along > least || b.tangential_N_m * (1 - along * along) > least * least * b.k_N_m;
                     }) ||
         // A tether that is stretched turns into the way of any motion but one towards its anchor.
         std::any_of(problem.tethers.begin(), problem.tethers.end(),
                     [&](const Tether& t) { return t.twoSided || d.dot((t.p_m - t.anchor_m).normalized()) > -least; });
}

/// A bar that hoists a body off everything that only presses meets no resistance.
void requireResistance(const ContactProblem& problem) {
  if (problem.bar && !resists(problem, problem.bar->hoist))
    throw BadInput(
        "nothing resists the bar: along its hoist the body moves away from supports that act one way only (springs "
        "that only press, ligaments); add supports that act against the hoist, or hoist the other way");
}

}  // namespace

ContactSolver::ContactSolver(const ContactProblem& problem, const ContactOptions& options, const Progress& progress)
    : problem_(problem),
      options_(options),
      progress_(progress),
      hierarchy_(finestLevel(problem)),
      energy_(hierarchy_, carriedSurface(hierarchy_, problem, kept_), problem, options),
      loads_(loadsOnLevels(hierarchy_, problem)),
      met_(hierarchy_.levels()) {}

NewtonRun ContactSolver::converge(State& state, std::optional<double> force_N, double tolerance, int limit) {
  const bool finest = energy_.top() == 0;
  if (finest && energy_.top() < pathLevel(hierarchy_, problem_) && spent_ > mostOnFinest) return {};
  const double start_m = state.s;
  NewtonRun run = minimise(hierarchy_, energy_, state, {force_N, tolerance, limit}, progress_);
  out_.newton += run.iterations;
  if (finest) spent_ += run.iterations;
  out_.inner += run.inner;
  lastResidual_ = run.residual;
  if (run.converged)
    cuts_ = energy_.cuts(state);
  else if (run.iterations > 0 && problem_.bar)
    lostTo_ = lostFrom(start_m, state, force_N.has_value());
  run.converged = run.converged && !cuts_;
  return run;
}

/// What a state that is no equilibrium shows of where the body was going, with the bar at `travel_m` at first: the bar
/// through the surface, cells inside out, off the bar; or nothing (Stopped).
ContactOutcome ContactSolver::lostFrom(double travel_m, const State& state, bool travels) const {
  if (energy_.cuts(state) || energy_.deep(state)) return ContactOutcome::Cuts;
  if (hierarchy_.level(energy_.top()).smallestVolumeRatio(state.u.data()) <= 0) return ContactOutcome::Folds;
  const bool away =
      travels ? state.s > travel_m + slipTravel_m : barForce(state) < slipFall * met_[energy_.top()].force_N;
  return away ? ContactOutcome::Slips : ContactOutcome::Stopped;
}

void ContactSolver::endTrailAt(double travel_m) {
  while (!trail_.empty() && trail_.back().s >= travel_m) trail_.pop_back();
}

double ContactSolver::barForce(const State& state) const {
  ContactEnergy::Value value;
  energy_.evaluate(state, {}, false, value);
  return value.barForce_N;
}

bool ContactSolver::slips(double capacity_N, double travel_m) {
  out_.outcome = ContactOutcome::Slips;
  out_.capacity_N = capacity_N;
  out_.capacity_m = travel_m;
  out_.capacityExceeded = true;
  return false;
}

/// The force from the end of the path, or from the nearest state before it that is an equilibrium on these cells too.
bool ContactSolver::meetForceFromTrail(State& state, double tolerance, NewtonRun& run) {
  const ContactOutcome before = out_.outcome;
  for (std::size_t back = 0; back <= std::min<std::size_t>(trail_.size(), 2); ++back) {
    State start = back == 0 ? state : trail_[trail_.size() - back];
    if (meetForce(*this, start, tolerance, run)) {
      state = std::move(start);
      return true;
    }
    if (out_.outcome != before) {
      state = std::move(start);
      return false;
    }
  }
  return false;
}

/// The path once more, on the present cells, from the nearest state before its end that is an equilibrium on them.
bool ContactSolver::followAgain(State& state, double tolerance, NewtonRun& run) {
  for (std::vector<State> behind = std::move(trail_); !behind.empty();) {
    State start = std::move(behind.back());
    behind.pop_back();
    run = converge(start, {}, pathTolerance, 60);
    if (!run.converged) continue;
    trail_ = std::move(behind);
    const bool reached = followPath(*this, start, PathKind::Again);
    state = std::move(start);
    if (!reached) return false;
    if (problem_.force_N) return meetForce(*this, state, tolerance, run);
    run = converge(state, {}, tolerance, 80);
    return run.converged;
  }
  return false;
}

/// From the end of the path to the answer on the finest cells.
bool ContactSolver::finish(State& state) {
  for (std::size_t l = energy_.top();; --l) {
    if (l < energy_.top()) {
      state.u = hierarchy_.prolonged(l, state.u);
      if (trail_.size() > 4) trail_.erase(trail_.begin(), trail_.end() - 4);
      for (State& earlier : trail_) earlier.u = hierarchy_.prolonged(l, earlier.u);
      useLevel(l);
    }
    const bool lastLevel = l == 0 || options_.pathOnly;
    const double tolerance = lastLevel ? options_.tolerance : std::max(1e-3, options_.tolerance);
    State trial = state;
    NewtonRun run = converge(trial, problem_.force_N, tolerance, 80);
    if (run.converged && trial.s > state.s + slipTravel_m) run.converged = false;
    if (run.converged) {
      state = std::move(trial);
    } else {
      // The coarse cells bore more than these do, or the force hardly rises with travel.
      out_.outcome = ContactOutcome::Stopped;
      const bool met = problem_.force_N && meetForceFromTrail(state, tolerance, run);
      if (!met && (out_.outcome != ContactOutcome::Stopped || !followAgain(state, tolerance, run))) {
        out_.solution.report.residual = run.residual;
        return false;
      }
      out_.outcome = ContactOutcome::Reached;
    }
    out_.solution.report.residual = run.residual;
    if (lastLevel) return true;
  }
}

/// Loads with the bar, if there is one, where it is: in full, else in smaller parts.
bool ContactSolver::loadInSteps(State& state, double tolerance) {
  const std::size_t level = energy_.top();
  double reached = 0, step = 1;
  while (reached < 1) {
    const double target = std::min(1.0, reached + step);
    std::vector<double> part = loads_[level];
    for (double& f : part) f *= target;
    energy_.setLoads(level, part);
    energy_.setPressureShare(target);
    State trial = state;
    const NewtonRun run = converge(trial, {}, target < 1 ? std::max(1e-3, tolerance) : tolerance, target < 1 ? 30 : 60);
    out_.solution.report.residual = run.residual;
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

/// Loads act from the beginning: they come first, with the bar away, which then comes to the body as they leave it.
bool ContactSolver::moveBar(State& state) {
  constexpr double away_m = 0.1;
  if (!problem_.pressures.empty() || !loads_[energy_.top()].empty()) {
    state.s = -away_m;
    const bool borne = loadInSteps(state, pathTolerance);
    state.s = 0;
    if (!borne) {
      out_.outcome = ContactOutcome::LoadsNotBorne;
      return false;
    }
    energy_.bringToForce(state);
  }
  return followPath(*this, state, PathKind::First) && finish(state);
}

/// What the body did beyond the last state: cells inside out, the bar through the surface, else where the last search
/// without an equilibrium was on its way to.
ContactOutcome ContactSolver::beyond(const State& last) const {
  if (hierarchy_.level(energy_.top()).smallestVolumeRatio(last.u.data()) <= 0) return ContactOutcome::Folds;
  return cuts_ || energy_.deep(last) ? ContactOutcome::Cuts : lostTo_;
}

/// The state on the finest cells. Of a bar that did not get there an equilibrium is told, where there is one near by:
/// with the travel of the state, or of one of the last before it.
void ContactSolver::toldOnFinest(State& state, bool good) {
  while (trail_.size() > mostBehind) trail_.erase(trail_.begin());
  while (energy_.top() > 0) {
    const std::size_t l = energy_.top() - 1;
    state.u = hierarchy_.prolonged(l, state.u);
    for (State& earlier : trail_) earlier.u = hierarchy_.prolonged(l, earlier.u);
    useLevel(l);
  }
  if (good || !problem_.bar || out_.outcome == ContactOutcome::LoadsNotBorne) return;
  const ContactOutcome lost = beyond(state);
  const double residual = lastResidual_;
  spent_ = 0;
  trail_.push_back(state);
  // The largest force that these cells bore is what is to be seen, unless it was passed.
  if (best_ && lost != ContactOutcome::Slips && best_->s > state.s) trail_.push_back(std::move(*best_));
  for (; !trail_.empty(); trail_.pop_back()) {
    if (!converge(trail_.back(), {}, settled, mostToSettle).converged) continue;
    state = std::move(trail_.back());
    break;
  }
  lostTo_ = lost;
  lastResidual_ = residual;
}

ContactSolution ContactSolver::solve() {
  const auto start = std::chrono::steady_clock::now();
  State state;
  useLevel(pathLevel(hierarchy_, problem_));
  state.u = energy_.top() == 0 ? prescribedOnFinest(hierarchy_.level(0), problem_)
                               : std::vector<double>(3 * hierarchy_.level(energy_.top()).nodes(), 0.0);
  bool good = false;
  if (problem_.bar) {
    good = moveBar(state);
  } else {
    good = loadInSteps(state, options_.tolerance);
    out_.outcome = good ? ContactOutcome::Reached : ContactOutcome::LoadsNotBorne;
  }
  if (options_.pathOnly)
    lostTo_ = beyond(state);
  else
    toldOnFinest(state, good);
  describe(hierarchy_, energy_, problem_, kept_, state, out_);
  if (!good && out_.outcome == ContactOutcome::Reached) out_.outcome = ContactOutcome::Stopped;
  if (out_.outcome == ContactOutcome::Stopped && problem_.bar) {
    out_.outcome = lostTo_;
    // States of the path are loose: no more is said to be borne than the state that is told bears.
    const bool beforeItsEnd = problem_.travel_m && out_.outcome == ContactOutcome::Slips;
    if (out_.outcome != ContactOutcome::Stopped && !beforeItsEnd && met_[0].force_N > 0) {
      const double told_N = out_.force_N.dot(out_.bar.hoist);
      const bool least = told_N < met_[0].force_N;
      out_.capacity_N = least ? told_N : met_[0].force_N;
      out_.capacity_m = least ? out_.travel_m : met_[0].travel_m;
    }
    out_.capacityExceeded = out_.capacityExceeded || out_.outcome != ContactOutcome::Stopped;
  }
  SolveReport& report = out_.solution.report;
  report.kind = energy_.hasPotential() ? "newton-multigrid-pcg" : "newton-multigrid-gmres";
  report.status = good ? SolveStatus::Converged : SolveStatus::StoppedAtLimit;
  if (!good) report.residual = lastResidual_;
  report.iterations = out_.newton;
  report.tolerance = options_.tolerance;
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return std::move(out_);
}

ContactSolution solveContact(const ContactProblem& problem, const ContactOptions& options, const Progress& progress) {
  if (problem.bar && problem.force_N.has_value() == problem.travel_m.has_value())
    throw BadArgument("solveContact: give either the force or the travel of the bar");
  requireHeld(problem);
  requireResistance(problem);
  return ContactSolver(problem, options, progress).solve();
}

}  // namespace glisson::mechanics
