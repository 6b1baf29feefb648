// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "base/progress.h"
#include "mechanics/contact/cell_kernel.h"
#include "mechanics/contact/membrane.h"
#include "mechanics/contact/rigid_bar.h"
#include "mechanics/problem.h"

namespace glisson::mechanics {

/// A sample of the body's surface: place and outward normal at rest (grid axes, m), and the area it stands for.
struct SurfaceSample {
  Eigen::Vector3d p_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double area_m2 = 0;
};

/// A face under a load that follows it, per deformed area: corners in turn, anticlockwise seen from outside, at rest
/// (grid axes, m).
struct FollowerFace {
  std::array<Eigen::Vector3d, 4> corner_m;
  double pressure_Pa = 0;  ///< positive pushes against the outward normal
  /// In the plane of the face at rest, Pa; its direction goes with the line of material along it.
  Eigen::Vector3d shear_Pa = Eigen::Vector3d::Zero();
};

/// A place of the surface on a bed that presses and does not pull: force −k max(0, u·outward) outward, and across it
/// −k' u whether it presses or not.
struct BedSample {
  Eigen::Vector3d p_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d outward = Eigen::Vector3d::Zero();
  double k_N_m = 0;
  double tangential_N_m = 0;  ///< k'
};

/// A fibre from a place of the surface to a place that does not move: it pulls by k times what it is longer than
/// `length_m`, and pushes where it is shorter only if it is two-sided.
struct Tether {
  Eigen::Vector3d p_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d anchor_m = Eigen::Vector3d::Zero();
  double length_m = 0;
  double k_N_m = 0;
  bool twoSided = false;
};

/// A body under large deformation, and the rigid bar that is moved against it.
struct ContactProblem {
  Problem problem;  ///< E of a cell that the surface cuts: modulus times covered fraction; f_N: dead loads
  SolidLaw law = SolidLaw::Polynomial;
  std::vector<SurfaceSample> surface;
  std::optional<Skin> skin;     ///< on the whole surface
  std::vector<double> rind_Pa;  ///< per cell, x fastest: further Young's modulus of the surface's cells, or empty
  double rindPoisson = 0.3;
  std::vector<FollowerFace> pressures;  ///< that follow their faces
  std::vector<BedSample> bed;
  std::vector<Tether> tethers;
  std::optional<RigidBar> bar;     ///< from anywhere behind its first touch; travel counts from the first force
  std::optional<double> force_N;   ///< on the bar along its hoist; or
  std::optional<double> travel_m;  ///< of the bar
};

/// Accuracy and extent of a contact solve.
struct ContactOptions {
  double tolerance = 1e-6;  ///< on ‖gradient‖ / load
  double zone_m = 1e-3;  ///< width of the barrier, a fifth of the bar's radius at most; half of it lies inside the body
  double proof = 1.0;    ///< the path is followed to this multiple of the force before the answer is given
  bool pathOnly = false;  ///< stop on the cells that the path is followed on
};

/// How a contact solve ended.
enum class ContactOutcome {
  Reached,  ///< the force or the travel asked for
  Slips,    ///< the force falls with travel below what was asked for: no equilibrium beyond capacity_N
  Folds,    ///< the surface beside the bar folds, cells turn inside out: beyond capacity_N nothing is known
  Cuts,     ///< the bar has drawn the surface apart and cut into it: the cells are too coarse, or the force too large
  LoadsNotBorne,  ///< no equilibrium under the loads, with the bar where it touches
  Stopped         ///< no convergence, no reason found
};

/// A point of the path: force on the bar at a travel.
struct PathStep {
  double travel_m = 0, force_N = 0;
};

/// The answer to a contact problem, or the last equilibrium before it ended otherwise.
struct ContactSolution {
  Solution solution;  ///< of the last equilibrium reached; energy_J: of body, capsule, springs, bed and tethers
  ContactOutcome outcome = ContactOutcome::Stopped;
  /// Of the bar from its first force on the body as the other loads leave it: half the barrier's width before they
  /// touch.
  double travel_m = 0;
  double touch_m = 0;                                   ///< that half
  double capacity_N = 0;                                ///< largest force met on the path
  double capacity_m = 0;                                ///< travel at which it was met, on the cells that it was met on
  bool capacityExceeded = false;                        ///< the force fell after it, or nothing was found beyond it
  std::vector<PathStep> path;                           ///< on the path's cells, then the answer
  double largestDrop_N = 0;                             ///< of the force from one step to the next
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero();    ///< of the bar on the body
  Eigen::Vector3d moment_Nm = Eigen::Vector3d::Zero();  ///< about the bar's centre
  double area_m2 = 0, footprint_m2 = 0;  ///< of the surface in contact, deformed: as it is, and seen along the hoist
  double pressureMax_Pa = 0, penetrationMax_m = 0;
  std::vector<double> pressure_Pa;                        ///< per surface sample
  Eigen::Matrix3Xd surface_u_m;                           ///< displacement of each surface sample
  Eigen::Vector3d following_N = Eigen::Vector3d::Zero();  ///< sum of the loads that follow their faces, as they end
  std::vector<Eigen::Vector3d> tether_N;                  ///< of each tether on the body
  double smallestJ = 1;
  int newton = 0, inner = 0;  ///< iterations, path included
  RigidBar bar;               ///< its centre line at travel 0
};

/// Equilibrium of a hyperelastic body held by springs and clamps and pushed by a rigid, frictionless bar, by Newton's
/// method on the potential energy: exact tangent, conjugate gradients with a multigrid rebuilt at each step, line
/// search on the energy. Contact is a logarithmic barrier in the gap of each surface sample, whose exact second
/// derivative is used. The bar is first moved step by step on coarse cells, until the force or the travel is reached or
/// the force falls; then the end of that path is converged on the body's own cells. Without a bar the loads are applied
/// in full, in smaller steps where that fails. Loads that follow their faces and have no potential make the tangent
/// unsymmetric: then GMRES takes the place of conjugate gradients, and the work along a step that of the energy. The
/// same bits with any number of threads. Throws BadInput (no sample of the surface can be met by the bar; a body that
/// nothing holds), Cancelled.
ContactSolution solveContact(const ContactProblem& problem, const ContactOptions& options = {},
                             const Progress& progress = {});

}  // namespace glisson::mechanics
