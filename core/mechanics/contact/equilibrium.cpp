// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/contact/equilibrium.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "mechanics/contact/equilibrium_parts.h"
#include "mechanics/contact/newton.h"
#include "mechanics/hyperelastic.h"

namespace glisson::mechanics {
namespace {

using State = ContactEnergy::State;

constexpr double positiveBy = 8;  ///< moduli are shifted by this multiple, so that changes of either sign are bodies
constexpr double differenceStep_m =
    2e-6;                        ///< of bar and surface: 2e-5 is .1 % off, which contact makes 4 % of the answer
constexpr double lever_m = 0.1;  ///< a bar is turned by the step over this
constexpr int shareCount = 4;    ///< parts in which a change is made that is too much at once

Change partOf(const Change& change, double share) {
  Change c = change;
  for (double& v : c.logModuli) v *= share;
  for (double* v : {&c.poisson, &c.logSupports, &c.logSkin, &c.force_N, &c.outward_m}) *v *= share;
  c.barShift_m *= share;
  c.barTurn_rad *= share;
  return c;
}

}  // namespace

/// Newton's method for the changed problem from displacements and travel `from` away from here, or from `ahead`; the
/// displacements and travel from here to where it ends.
std::optional<std::vector<double>> Equilibrium::Parts::goTo(const Change& change, const std::vector<double>& from,
                                                            const std::vector<double>* ahead, double tolerance,
                                                            const Progress& progress, int& iterations) const {
  Assembled other(changed(problem, change), options);
  const std::size_t n = level().nodes();
  double touch_m = 0;  // by which the changed bar touches later than this one, moved as it is, would
  if (energy.hasBar()) {
    const RigidBar here = moved(energy.bar(), change.barShift_m, change.barTurn_rad, change.pivot_m);
    touch_m = (other.energy.bar().centre_m() - here.centre_m()).dot(here.hoist);
  }
  for (const std::vector<double>* start : {ahead, &from}) {
    if (start == nullptr) continue;
    State state = at;
    for (std::size_t i = 0; i < 3 * n; ++i) state.u[i] += (*start)[i];
    state.s += (travels() ? (*start)[3 * n] : 0) - touch_m;
    NewtonGoal goal{other.travels() ? problem.force_N : std::nullopt, tolerance};
    if (goal.force_N) goal.force_N = other.problem.force_N;
    const NewtonRun run = minimise(other.hierarchy, other.energy, state, goal, progress);
    iterations += run.iterations;
    if (!run.converged) continue;
    std::vector<double> d(level().size(), 0.0);
    for (std::size_t i = 0; i < 3 * n; ++i) d[i] = state.u[i] - at.u[i];
    d[3 * n] = state.s + touch_m - at.s;
    return d;
  }
  return {};
}

Equilibrium::Unbalance Equilibrium::Parts::byModuli(const std::vector<double>& relative) {
  const VoxelBody& body = problem.problem.body;
  if (relative.size() != body.E_Pa.size()) throw BadArgument("Equilibrium: one change for each cell");
  // Forces are linear in the moduli: those of E (8 + change) less those of 8 E.
  std::vector<double> E(relative.size());
  for (std::size_t c = 0; c < E.size(); ++c) E[c] = body.E_Pa[c] * (positiveBy + relative[c]);
  const double mu = lameMu(body.poisson), lambda = lameLambda(body.poisson);
  Unbalance out = zero();
  addCells(E, mu, lambda, 1, out);
  addCells(body.E_Pa, mu, lambda, -positiveBy, out);
  std::vector<double> more(relative.size());
  for (std::size_t c = 0; c < more.size(); ++c) more[c] = body.E_Pa[c] * relative[c];
  addBarrier(more, out);
  return free(std::move(out));
}

Equilibrium::Unbalance Equilibrium::Parts::byPoisson(bool shearKept) {
  const VoxelBody& body = problem.problem.body;
  const double nu = body.poisson, mu = lameMu(nu), lambda = lameLambda(nu);
  const double muBy = shearKept ? 0 : -0.5 / ((1 + nu) * (1 + nu));
  const double lambdaBy = shearKept ? 1 / ((1 + nu) * (1 - 2 * nu) * (1 - 2 * nu))
                                    : (1 + 2 * nu * nu) / std::pow((1 + nu) * (1 - 2 * nu), 2);
  Unbalance out = zero();
  addCells(body.E_Pa, mu + muBy, lambda + lambdaBy, 1, out);
  addCells(body.E_Pa, mu, lambda, -1, out);
  if (shearKept) {
    std::vector<double> more = body.E_Pa;
    for (double& E : more) E /= 1 + nu;
    addBarrier(more, out);
  }
  return free(std::move(out));
}

Equilibrium::Unbalance Equilibrium::Parts::bySupports() {
  const std::size_t n = level().nodes();
  Unbalance out = zero();
  std::vector<Eigen::Vector3d> tethers;
  energy.addHolding(at, out.data(), tethers);  // on the body: the negative of what they add to r
  for (double& f : out) f = -f;
  const std::vector<double>& u = at.u;
  for (const SolidLevel::SlotSpring& s : level().springs) {
    Eigen::Matrix3d k;
    k << s.k[0], s.k[1], s.k[2], s.k[1], s.k[3], s.k[4], s.k[2], s.k[4], s.k[5];
    const Eigen::Vector3d f = k * Eigen::Vector3d(u[s.slot], u[n + s.slot], u[2 * n + s.slot]);
    for (std::size_t c = 0; c < 3; ++c) out[c * n + s.slot] += f[static_cast<Eigen::Index>(c)];
  }
  return free(std::move(out));
}

Equilibrium::Unbalance Equilibrium::Parts::bySkin() {
  Unbalance out = zero();
  if (!problem.rind_Pa.empty()) {
    std::vector<double> E = problem.rind_Pa;
    for (std::size_t c = 0; c < E.size(); ++c)
      if (!(problem.problem.body.E_Pa[c] > 0)) E[c] = 0;
    addCells(E, lameMu(problem.rindPoisson), lameLambda(problem.rindPoisson), 1, out);
  }
  level().membrane.addForces(at.u.data(), level().nodes(), out.data());
  return free(std::move(out));
}

Equilibrium::Unbalance Equilibrium::Parts::byBar(const Eigen::Vector3d& shift_m, const Eigen::Vector3d& turn_rad,
                                                 const Eigen::Vector3d& pivot_m) {
  const RigidBar& own = energy.bar();
  const double size = std::max(shift_m.norm(), lever_m * turn_rad.norm());
  Unbalance out = zero();
  if (!(size > 0)) return out;
  const double step = differenceStep_m / size;
  for (const double side : {-1.0, 1.0})
    addContact(moved(own, side * step * shift_m, side * step * turn_rad, pivot_m), 0, side / (2 * step), out);
  return free(std::move(out));
}

Equilibrium::Unbalance Equilibrium::Parts::bySurface(const std::vector<double>& growth_Pa_m) {
  const double nu = problem.problem.body.poisson;
  Unbalance out = zero();
  if (!growth_Pa_m.empty()) {
    std::vector<double> E = growth_Pa_m;
    for (std::size_t c = 0; c < E.size(); ++c)
      if (!(problem.problem.body.E_Pa[c] > 0)) E[c] = 0;
    addCells(E, lameMu(nu), lameLambda(nu), 1, out);
    addBarrier(E, out);
  }
  if (energy.hasBar())
    for (const double side : {-1.0, 1.0})
      addContact(energy.bar(), side * differenceStep_m, side / (2 * differenceStep_m), out);
  return free(std::move(out));
}

Equilibrium::Equilibrium(const ContactProblem& problem, const ContactOptions& options, const NodalField& u_m,
                         double travel_m, const std::optional<Eigen::Vector3d>& barStart_m)
    : parts_(std::make_unique<Parts>(problem, options, u_m, travel_m, barStart_m)) {}
Equilibrium::~Equilibrium() = default;
Equilibrium::Equilibrium(Equilibrium&&) noexcept = default;

bool Equilibrium::usable() const {
  return parts_->usable;
}
double Equilibrium::residual() const {
  return parts_->residual;
}
const RigidBar& Equilibrium::bar() const {
  return parts_->energy.bar();
}

Equilibrium::Unbalance Equilibrium::by(const Change& c) const {
  Parts& p = *parts_;
  Unbalance out = p.zero();
  const auto add = [&](const Unbalance& u, double factor) {
    for (std::size_t i = 0; i < out.size(); ++i) out[i] += factor * u[i];
  };
  if (!c.logModuli.empty()) add(p.byModuli(c.logModuli), 1);
  if (c.poisson != 0) add(p.byPoisson(c.shearKept), c.poisson);
  if (c.logSupports != 0) add(p.bySupports(), c.logSupports);
  if (c.logSkin != 0) add(p.bySkin(), c.logSkin);
  if (c.outward_m != 0) add(p.bySurface(c.growth_Pa_m), c.outward_m);
  if (p.energy.hasBar()) add(p.byBar(c.barShift_m, c.barTurn_rad, c.pivot_m), 1);
  if (p.travels()) out.back() -= c.force_N;
  return out;
}

Equilibrium::Unbalance Equilibrium::left() const {
  ContactEnergy::Value value;
  if (!parts_->energy.evaluate(parts_->at, parts_->problem.force_N, parts_->travels(), value)) return parts_->zero();
  return parts_->free(std::move(value.gradient));
}

EquilibriumMotion Equilibrium::respond(const Unbalance& unbalance, double tolerance, int limit) {
  if (!parts_->usable) return {};
  std::vector<double> b(unbalance.size()), x;
  for (std::size_t i = 0; i < b.size(); ++i) b[i] = -unbalance[i];
  const TangentSolve solve = parts_->energy.hasPotential()
                                 ? parts_->hierarchy.solve(0, b, x, tolerance, limit, false)
                                 : parts_->hierarchy.solveUnsymmetric(0, b, x, tolerance, limit);
  EquilibriumMotion m = parts_->motionOf(x);
  m.found = solve.outcome == TangentOutcome::Converged;
  m.iterations = solve.iterations;
  return m;
}

EquilibriumMotion Equilibrium::afterwards(const Change& change, const EquilibriumMotion* guess, double tolerance,
                                          const Progress& progress) const {
  const std::size_t n = parts_->level().nodes();
  std::vector<double> ahead;
  if (guess != nullptr) {
    ahead = onNodeSlots(parts_->level(), parts_->mesh, guess->u_m);
    ahead.push_back(guess->travel_m);
  }
  int iterations = 0;
  std::optional<std::vector<double>> end =
      parts_->goTo(change, parts_->zero(), ahead.empty() ? nullptr : &ahead, tolerance, progress, iterations);
  if (!end) {
    std::vector<double> reached = parts_->zero();
    for (int part = 1; part <= shareCount; ++part) {
      // From one part to the next as straight on as the guess goes.
      std::vector<double> next = reached;
      for (std::size_t i = 0; !ahead.empty() && i < 3 * n + 1; ++i) next[i] += ahead[i] / shareCount;
      end = parts_->goTo(partOf(change, static_cast<double>(part) / shareCount), reached, &next,
                         part < shareCount ? std::max(1e-3, tolerance) : tolerance, progress, iterations);
      if (!end) break;
      reached = *end;
    }
  }
  EquilibriumMotion m;
  if (end) m = parts_->motionOf(*end);
  m.iterations = iterations;
  return m;
}

}  // namespace glisson::mechanics
