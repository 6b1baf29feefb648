#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mechanics/contact/contact_solve.h"
#include "retraction/body.h"

namespace glisson::retraction {

/// The scene's retractor, where it is to be a rigid bar. Throws BadInput where the scene asks for rigid contact and for
/// something that does not offer it.
std::optional<Retractor> rigidBarOf(const Setup& setup);

/// The scene as a contact problem: cells weighted with their covered fraction, the smooth surface's samples, springs and
/// capsule on it, the bar behind its place. A box, and a model without smooth body, is its cells.
struct ContactScene {
  mechanics::ContactProblem problem;
  Eigen::Vector3i layers = Eigen::Vector3i::Zero();  ///< of cells added before the model's grid
  std::vector<Eigen::Vector3d> sample_mm;            ///< of the surface, LPS
};
ContactScene contactScene(const Body& body, const Model& model, const Setup& setup, const MechanicsScene& scene,
                          const Retractor& bar);

/// An answer on the nodes of the model's own cells, and what bar and liver do to each other.
struct RigidContactAnswer {
  mechanics::Solution solution;
  RigidContact contact;
  int dofs = 0;
};
RigidContactAnswer solveRigidContact(const Body& body, const Model& model, const Setup& setup,
                                     const MechanicsScene& scene, const Retractor& bar, const Progress& progress);

}  // namespace glisson::retraction
