// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "base/progress.h"
#include "mechanics/contact/contact_solve.h"

namespace glisson::mechanics {

/// What one frame may cost, and when a state counts as at rest.
struct TrackerOptions {
  int newton = 2;               ///< linearisations a frame
  int inner = 4;                ///< iterations with each
  double tolerance = 1e-4;      ///< on ‖gradient‖ / load
  double longestMove_m = 2e-3;  ///< of the bar in one frame; no more than the barrier's guard
  double waitsFrom_m = 0.3e-3;  ///< distance from equilibrium from which the bar waits for the body
  int mostDofs = 40000;         ///< of the cells that are followed, where coarser ones can still follow the bar
};

/// A state on the way of the hand.
struct TrackedState {
  Eigen::Vector3d moved_m = Eigen::Vector3d::Zero();  ///< of the bar from its first force, grid axes
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero();  ///< of the bar on the body
  double remaining_m = 0;  ///< estimate of the largest distance of a node from the equilibrium under this bar
  bool atRest = true;      ///< in equilibrium to the tolerance
  bool cuts = false;       ///< the bar cuts into the surface, whose cells it has drawn apart: no state to go by
  int newton = 0, inner = 0;
};

/// A hyperelastic body that follows a rigid, frictionless bar in the hand, frame by frame: the bar is moved by a short
/// way, then a bounded number of Newton steps goes on from the state before, extrapolated. On the coarse cells that
/// solveContact follows its path on. While the bar stays, further frames converge.
class ContactTracker {
 public:
  /// problem: with a bar; its force and travel are not looked at. points_m: places whose displacement is watched, grid
  /// axes; each is carried by the nearest cell. Throws BadInput as solveContact, BadArgument (no bar), SolverFailed (no
  /// equilibrium under the dead loads alone), Cancelled.
  ContactTracker(const ContactProblem& problem, const std::vector<Eigen::Vector3d>& points_m,
                 const TrackerOptions& options = {}, const Progress& progress = {});
  ~ContactTracker();
  ContactTracker(ContactTracker&&) noexcept;

  /// One frame towards the bar's place `target_m` (displacement from its first force, grid axes, m).
  const TrackedState& moveTowards(const Eigen::Vector3d& target_m);
  const TrackedState& state() const;
  /// Displacement of the watched points, 3 × points, m, grid axes.
  void displacements(Eigen::Matrix3Xd& u_m) const;
  /// The bar where it meets the first force.
  const RigidBar& bar() const;
  int dofs() const;
  double cell_m() const;  ///< longest edge of the cells that are followed

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace glisson::mechanics
