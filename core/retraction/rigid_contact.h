// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mechanics/contact/contact_solve.h"
#include "retraction/body.h"
#include "retraction/pose.h"

namespace glisson::retraction {

/// What of a scene does not offer a rigid bar: its model (other than voxel hexahedra), time steps, the condensed
/// solver, corotational kinematics.
enum class RigidRefusal { Model, TimeSteps, Condensed, Corotational };

/// The first of them that the setup has; nothing where a rigid bar is offered.
std::optional<RigidRefusal> rigidRefusal(const Setup& setup);

/// The scene's retractor, where it is to be a rigid bar. Throws BadInput where the scene asks for rigid contact and for
/// something that does not offer it (rigidRefusal).
std::optional<Retractor> rigidBarOf(const Setup& setup);
/// Whether it is to be one, offered or not.
bool wantsRigidBar(const Setup& setup);

/// The scene as a contact problem: cells weighted with their covered fraction, the smooth surface's samples, springs
/// and capsule on it, the bar behind its place. A box, and a model without smooth body, is its cells.
struct ContactScene {
  mechanics::ContactProblem problem;
  Eigen::Vector3i layers = Eigen::Vector3i::Zero();  ///< of cells added before the model's grid
  std::vector<Eigen::Vector3d> sample_mm;            ///< of the surface, LPS
};
ContactScene contactScene(const Body& body, const Model& model, const Setup& setup, const MechanicsScene& scene,
                          const Retractor& bar);

/// A displacement of the nodes of the cut cells on the nodes of the model's own; a node that no cut cell has takes that
/// of the nearest which is.
mechanics::NodalField onModelNodes(const Body& body, const ContactScene& scene, const mechanics::NodalField& u_m);

/// Where the bar lies: as the scene says, or the first place on the lower right lobe that both stiffnesses bear by the
/// mechanics of coarse cells, to 1.1 of the force.
struct PlacedBar {
  Retractor bar;             ///< at_mm and axis set
  std::optional<Pose> pose;  ///< empty on a box
  /// A place that was tried for the bar.
  struct Tried {
    double height_mm = 0.0;  ///< above the lowest point of the right lobe
    double borne = 0.0;      ///< share of the force that the weaker of both livers bears, 1.1 at most
  };
  std::vector<Tried> tried;  ///< places tried, in order; empty if the scene gave one
  bool bears = true;         ///< false: no place tried bears the force; bar is the best of them
};
/// other: the same body with the second stiffness, or null. Throws BadInput if geometry offers no place, or the scene's
/// point is not on a surface that looks against the hoist.
PlacedBar placeBar(const Model& model, const Model* other, const Setup& setup, const Progress& progress);

/// The scene without a rigid bar, in large deformation on its own cells.
mechanics::ContactProblem withoutBar(const Body& body, const Setup& setup, const MechanicsScene& scene);

/// True where the scene is solved by mechanics::solveContact: pressures may follow their faces, springs press only.
/// With automatic kinematics: where a bar is rigid, or where a support acts one way only and large deformation is
/// offered.
bool inLargeDeformation(const Setup& setup);

/// A support that acts one way only, which linear theory does not have: a ligament, or a spring that only presses.
bool isOneSided(const SupportSpec& support);

/// An answer on the nodes of the model's own cells.
struct LargeDeformationAnswer {
  mechanics::Solution solution;
  Eigen::Vector3d following_N = Eigen::Vector3d::Zero();  ///< sum of the loads that follow their faces, LPS
  std::vector<LigamentPull> ligaments;
  Diagnostics diagnostics;
  bool loadsBorne = true;  ///< false: no equilibrium under the loads, however small their steps
};
LargeDeformationAnswer solveWithoutBar(const Body& body, const Setup& setup, const MechanicsScene& scene,
                                       double tolerance, const Progress& progress);

/// The same with a bar, and what bar and liver do to each other.
struct RigidContactAnswer : LargeDeformationAnswer {
  RigidContact contact;
  int dofs = 0;
};
RigidContactAnswer solveRigidContact(const Body& body, const Model& model, const Setup& setup,
                                     const MechanicsScene& scene, const Retractor& bar, const Progress& progress);

}  // namespace glisson::retraction
