// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/contact/newton.h"

#include <algorithm>
#include <cmath>

namespace glisson::mechanics {
namespace {

constexpr double largestStep_m = 0.010;
constexpr double forcing = 0.1;  ///< of the inner solve
constexpr int unsymmetricLimit = 120;
constexpr int mostUnsolved = 4;  ///< unsymmetric steps in turn that GMRES does not find: near a limit of the load
constexpr double armijo = 1e-4;
constexpr int halvings = 12;
constexpr double deeperOf = 0.25;    ///< of the barrier's width: what a step may lead a sample deeper beyond it
constexpr double atRounding = 1e-7;  ///< residual that counts as converged where no step helps

double normOf(const std::vector<double>& v) {
  double sum = 0;
  for (const double x : v) sum += x * x;
  return std::sqrt(sum);
}

double dotOf(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

struct Minimiser {
  SolidHierarchy& hierarchy;
  const ContactEnergy& energy;
  const NewtonGoal& goal;
  bool travels;
  ContactEnergy::Value now, next;
  std::vector<double> step;
  int unsolved = 0;

  double load() const {
    const double given = goal.force_N ? std::abs(*goal.force_N) : now.contact_N;
    return std::max({given, now.loads_N, 1e-12});
  }
  bool direction(bool positive, NewtonRun& run) {
    std::vector<double> b(now.gradient.size());
    for (std::size_t i = 0; i < b.size(); ++i) b[i] = -now.gradient[i];
    const bool symmetric = positive || energy.hasPotential();
    const TangentSolve solve = symmetric ? hierarchy.solve(energy.top(), b, step, forcing, goal.innerLimit, positive)
                                         : hierarchy.solveUnsymmetric(energy.top(), b, step, forcing,
                                                                      std::min(goal.innerLimit, unsymmetricLimit));
    run.inner += solve.iterations;
    if (!symmetric) unsolved = solve.outcome == TangentOutcome::Limit ? unsolved + 1 : 0;
    if (!positive) run.indefinite = solve.outcome == TangentOutcome::Indefinite;
    if (!travels) step.back() = 0;
    double largest = std::abs(step.back());
    for (std::size_t i = 0; i + 1 < step.size(); ++i) largest = std::max(largest, std::abs(step[i]));
    if (!std::isfinite(largest)) return false;
    if (largest > largestStep_m)
      for (double& v : step) v *= largestStep_m / largest;
    const bool falls = dotOf(now.gradient, step) < 0;
    if (!symmetric) run.indefinite = !falls;
    return falls;
  }
  bool search(ContactEnergy::State& state) {
    const double slope = dotOf(now.gradient, step), size = normOf(now.gradient);
    double scale = 1;
    for (int i = 0; i < halvings; ++i, scale *= 0.5) {
      ContactEnergy::State trial = state;
      for (std::size_t d = 0; d < trial.u.size(); ++d) trial.u[d] += scale * step[d];
      trial.s += scale * step.back();
      if (!energy.evaluate(trial, goal.force_N, travels, next)) continue;
      // Once on the wrong side of the bar a sample does not find back: steps end in the barrier's zone, or little
      // deeper than they began.
      const double zone_m = energy.barrier().width_m;
      if (next.deepest_m > std::max(zone_m, now.deepest_m + deeperOf * zone_m)) continue;
      // Where loads have no potential, what the unbalanced forces do on the way stands for its fall.
      const double fall =
          energy.hasPotential() ? now.potential - next.potential : -0.5 * scale * (slope + dotOf(next.gradient, step));
      const bool rounding = std::abs(fall) <= 1e-11 * (std::abs(now.potential) + std::abs(next.potential));
      if (!(fall >= -armijo * scale * slope) && !(rounding && normOf(next.gradient) < size)) continue;
      if (!energy.passes(state, trial)) continue;
      state = std::move(trial);
      std::swap(now, next);
      return true;
    }
    return false;
  }
};

}  // namespace

NewtonRun minimise(SolidHierarchy& hierarchy, const ContactEnergy& energy, ContactEnergy::State& state,
                   const NewtonGoal& goal, const Progress& progress) {
  NewtonRun run;
  Minimiser m{hierarchy, energy, goal, goal.force_N.has_value() && energy.hasBar(), {}, {}, {}, 0};
  if (!energy.evaluate(state, goal.force_N, m.travels, m.now)) return run;
  const Eigen::Vector3d hoist = energy.hasBar() ? energy.bar().hoist : Eigen::Vector3d::Zero();
  for (;; ++run.iterations) {
    progress.check();
    run.residual = normOf(m.now.gradient) / m.load();
    if (run.residual <= goal.tolerance) {
      run.converged = true;
      return run;
    }
    if (run.iterations == goal.limit || m.unsolved > mostUnsolved) return run;
    hierarchy.setFollowers(energy.followers(state));
    if (!hierarchy.linearise(energy.top(), energy.law(), state.u.data(), energy.stiffness(state), m.travels, hoist))
      return run;
    if (m.direction(false, run) && m.search(state)) continue;
    if (m.direction(true, run) && m.search(state)) continue;
    // No step lowers the potential any more: at the rounding of its sums.
    run.converged = run.residual <= std::max(goal.tolerance, atRounding);
    return run;
  }
}

}  // namespace glisson::mechanics
