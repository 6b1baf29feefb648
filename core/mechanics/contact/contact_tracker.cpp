// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/contact/contact_tracker.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "mechanics/contact/contact_energy.h"
#include "mechanics/contact/contact_setup.h"
#include "mechanics/contact/newton.h"

namespace glisson::mechanics {
namespace {

constexpr double straight = 0.7;  ///< cosine between two moves up to which the second is extrapolated from the first
constexpr int shorter = 3;        ///< halvings of a move that meets an infeasible state

using State = ContactEnergy::State;

}  // namespace

struct ContactTracker::Parts {
  SolidHierarchy hierarchy;
  std::vector<std::size_t> kept;
  ContactEnergy energy;
  TrackerOptions options;
  RigidBar rest;
  std::vector<CarriedPoint> points;  ///< watched, on the level that is followed
  State now, before;
  Eigen::Vector3d lastMove_m = Eigen::Vector3d::Zero();
  TrackedState told;
  int dofs = 0;
  std::vector<double> correction;

  Parts(const ContactProblem& p, const ContactOptions& contact, const TrackerOptions& o)
      : hierarchy(finestLevel(p)), energy(hierarchy, carriedSurface(hierarchy, p, kept), p, contact), options(o) {}

  const SolidLevel& level() const { return hierarchy.level(energy.top()); }
  int dofsOf(std::size_t l) const;
  void watch(const ContactProblem& problem, const std::vector<Eigen::Vector3d>& points_m);
  Eigen::Vector3d shiftBar(const Eigen::Vector3d& move_m);
  void settle();
};

int ContactTracker::Parts::dofsOf(std::size_t l) const {
  const std::vector<float>& active = hierarchy.level(l).active;
  return static_cast<int>(std::count_if(active.begin(), active.end(), [](float a) { return a > 0; }));
}

void ContactTracker::Parts::watch(const ContactProblem& problem, const std::vector<Eigen::Vector3d>& points_m) {
  const VoxelMesh mesh(problem.problem.body);
  for (const Eigen::Vector3d& p : points_m) {
    Eigen::Vector3i cell = nearestCell(mesh, p);
    for (std::size_t l = 0; l < energy.top(); ++l)
      for (int axis = 0; axis < 3; ++axis)
        if (hierarchy.level(l).halved[static_cast<std::size_t>(axis)]) cell[axis] /= 2;
    points.push_back(level().carry(cell, p));
  }
}

/// Moves the bar by as much of `move_m` as leaves a defined state, and the body with it where it went on straight.
/// Returns what was moved.
Eigen::Vector3d ContactTracker::Parts::shiftBar(const Eigen::Vector3d& move_m) {
  Eigen::Vector3d move = move_m;
  for (int tries = 0; tries <= shorter; ++tries, move *= 0.5) {
    energy.moveBar(move);
    ContactEnergy::Value value;
    const double length = lastMove_m.norm();
    if (length > 0 && move.dot(lastMove_m) > straight * move.norm() * length) {
      State trial = now;
      const double factor = move.norm() / length;
      for (std::size_t i = 0; i < trial.u.size(); ++i) trial.u[i] += factor * (now.u[i] - before.u[i]);
      if (energy.evaluate(trial, {}, false, value)) {
        before = std::exchange(now, std::move(trial));
        return move;
      }
    }
    if (energy.evaluate(now, {}, false, value)) {
      before = now;
      return move;
    }
    energy.moveBar(-move);
  }
  return Eigen::Vector3d::Zero();
}

/// Newton steps within the frame's budget, and what is left to do after them.
void ContactTracker::Parts::settle() {
  NewtonGoal goal;
  goal.tolerance = options.tolerance;
  goal.limit = options.newton;
  goal.innerLimit = options.inner;
  const NewtonRun run = minimise(hierarchy, energy, now, goal, {});
  told.newton = run.iterations;
  told.inner = run.inner;
  told.atRest = run.converged;
  ContactEnergy::Value value;
  if (!energy.evaluate(now, {}, false, value)) return;
  told.force_N = energy.force(now);
  told.cuts = energy.cuts(now);
  if (run.iterations == 0) {
    if (run.converged) told.remaining_m = std::min(told.remaining_m, options.tolerance * options.longestMove_m);
    return;
  }
  for (double& g : value.gradient) g = -g;
  hierarchy.solve(energy.top(), value.gradient, correction, 0.1, 1, true);
  double largest = 0;
  const std::size_t n = level().nodes();
  for (std::size_t i = 0; i < n; ++i)
    largest = std::max(
        largest, std::pow(correction[i], 2) + std::pow(correction[n + i], 2) + std::pow(correction[2 * n + i], 2));
  told.remaining_m = std::sqrt(largest);
}

ContactTracker::ContactTracker(const ContactProblem& problem, const std::vector<Eigen::Vector3d>& points_m,
                               const TrackerOptions& options, const Progress& progress) {
  if (!problem.bar) throw BadArgument("ContactTracker: there is no bar to follow");
  const ContactOptions contact;
  parts_ = std::make_unique<Parts>(problem, contact, options);
  Parts& p = *parts_;
  p.options.longestMove_m = std::min(options.longestMove_m, p.energy.barrier().guard_m);
  std::size_t l = pathLevel(p.hierarchy, problem);
  while (p.dofsOf(l) > options.mostDofs && l + 2 < p.hierarchy.levels()) ++l;
  p.energy.setLoads(l, loadsOnLevels(p.hierarchy, problem)[l]);
  p.dofs = p.dofsOf(l);
  p.watch(problem, points_m);
  p.now.u = l == 0 ? prescribedOnFinest(p.level(), problem) : std::vector<double>(3 * p.level().nodes(), 0.0);
  NewtonGoal goal;
  goal.tolerance = options.tolerance;
  // Loads come first, with the bar away, which then comes to the body as they leave it.
  constexpr double away_m = 0.1;
  p.now.s = -away_m;
  const NewtonRun run = minimise(p.hierarchy, p.energy, p.now, goal, progress);
  if (!run.converged)
    throw SolverFailed("the body finds no equilibrium under its loads before the retractor touches it; check its loads",
                       run.iterations, run.residual, goal.tolerance);
  p.now.s = 0;
  p.energy.bringToForce(p.now);
  p.rest = p.energy.bar();
  p.before = p.now;
}

ContactTracker::~ContactTracker() = default;
ContactTracker::ContactTracker(ContactTracker&&) noexcept = default;

const TrackedState& ContactTracker::moveTowards(const Eigen::Vector3d& target_m) {
  Parts& p = *parts_;
  Eigen::Vector3d move = target_m - p.told.moved_m;
  const double way = move.norm();
  if (way > p.options.longestMove_m) move *= p.options.longestMove_m / way;
  Eigen::Vector3d moved = Eigen::Vector3d::Zero();
  if (way > 1e-9 && p.told.remaining_m < p.options.waitsFrom_m) {
    moved = p.shiftBar(move);
    p.told.moved_m += moved;
  }
  if (!moved.isZero(0)) p.lastMove_m = moved;
  p.settle();
  if (way > 1e-9 && moved.isZero(0)) p.told.atRest = false;
  return p.told;
}

const TrackedState& ContactTracker::state() const {
  return parts_->told;
}
const RigidBar& ContactTracker::bar() const {
  return parts_->rest;
}
int ContactTracker::dofs() const {
  return parts_->dofs;
}
double ContactTracker::cell_m() const {
  return parts_->level().moduli.h_m.maxCoeff();
}

void ContactTracker::displacements(Eigen::Matrix3Xd& u_m) const {
  const Parts& p = *parts_;
  u_m.resize(3, static_cast<Eigen::Index>(p.points.size()));
  for (std::size_t i = 0; i < p.points.size(); ++i)
    u_m.col(static_cast<Eigen::Index>(i)) = p.points[i].at(p.now.u.data(), p.level().nodes());
}

}  // namespace glisson::mechanics
