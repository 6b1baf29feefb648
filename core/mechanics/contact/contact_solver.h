// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "mechanics/contact/contact_energy.h"
#include "mechanics/contact/newton.h"

namespace glisson::mechanics {

/// A contact problem on its way to the answer: what solveContact() is made of.
class ContactSolver {
 public:
  using State = ContactEnergy::State;

  static constexpr double firstStep_m = 4e-3, longestStep_m = 6e-3, shortestStep_m = 1e-4;
  static constexpr double pathTolerance = 1e-2;
  static constexpr double slipFall = 0.75;       ///< of the largest force: the bar slips
  static constexpr double slipTravel_m = 12e-3;  ///< past the largest force without reaching it again

  ContactSolver(const ContactProblem& problem, const ContactOptions& options, const Progress& progress);
  /// The answer, or what was reached.
  ContactSolution solve();

  const ContactProblem& problem() const { return problem_; }
  const ContactOptions& options() const { return options_; }
  const Progress& progress() const { return progress_; }
  const ContactEnergy& energy() const { return energy_; }
  ContactSolution& out() { return out_; }
  NewtonRun converge(State& state, std::optional<double> force_N, double tolerance, int limit);
  double barForce(const State& state) const;
  /// The state is the last but one of the path.
  void leaveBehind(const State& state) { trail_.push_back(state); }
  /// A force that an equilibrium bore on the present cells, and the travel there.
  void met(double force_N, const State& state) {
    Met& m = met_[energy_.top()];
    if (!(force_N > m.force_N)) return;
    m = {force_N, state.s};
    if (energy_.top() == 0) best_ = state;
  }
  /// Whether the last state that was found was refused, as the bar cut into the surface there.
  bool cuts() const { return cuts_; }
  const std::vector<State>& trail() const { return trail_; }
  /// The path has turned out to end here: states further on are not behind it.
  void endTrailAt(double travel_m);
  /// Notes what the place bears at most; false.
  bool slips(double capacity_N, double travel_m);

 private:
  void useLevel(std::size_t l) { energy_.setLoads(l, loads_[l]); }
  ContactOutcome lostFrom(double travel_m, const State& state, bool travels) const;
  ContactOutcome beyond(const State& last) const;
  bool moveBar(State& state);
  void toldOnFinest(State& state, bool good);
  bool meetForceFromTrail(State& state, double tolerance, NewtonRun& run);
  bool followAgain(State& state, double tolerance, NewtonRun& run);
  bool finish(State& state);
  bool loadInSteps(State& state, double tolerance);

  const ContactProblem& problem_;
  const ContactOptions& options_;
  const Progress& progress_;
  SolidHierarchy hierarchy_;
  std::vector<std::size_t> kept_;  ///< samples that cells carry
  ContactEnergy energy_;
  ContactSolution out_;
  std::vector<std::vector<double>> loads_;  ///< per level
  struct Met {
    double force_N = 0, travel_m = 0;
  };
  std::vector<Met> met_;                             ///< largest force that an equilibrium bore, per level
  std::optional<State> best_;                        ///< that equilibrium on the finest cells
  bool cuts_ = false;                                ///< the last state that was found
  ContactOutcome lostTo_ = ContactOutcome::Stopped;  ///< what the last run without an equilibrium was on its way to
  int spent_ = 0;                                    ///< iterations on the finest cells
  double lastResidual_ = 0;                          ///< of the last equilibrium tried
  std::vector<State> trail_;                         ///< of the path up to its end, of the level that is worked on
};

/// Which of its passes a path is followed in.
enum class PathKind {
  First,  ///< on the coarse cells: it is told, and proved beyond the force
  Again   ///< on finer ones, which bore less
};

/// Travel in steps from `state` until force or travel is reached (true), or the force falls or no step is possible.
/// Writes outcome and capacity of solver.out(), and its path where this is the first time.
bool followPath(ContactSolver& solver, ContactSolver::State& state, PathKind kind);

/// The travel at which the bar bears the force, with the travel prescribed: that stays well posed where the force
/// hardly rises any more, and where it falls. False where no step is possible or the force has fallen for good (only
/// then solver.out() says that the bar slips).
bool meetForce(ContactSolver& solver, ContactSolver::State& state, double tolerance, NewtonRun& run);

}  // namespace glisson::mechanics
