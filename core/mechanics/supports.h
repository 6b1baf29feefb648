// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "mechanics/problem.h"

namespace glisson::mechanics {

/// Prescribed displacements, degree of freedom by degree of freedom.
struct DirichletData {
  Eigen::Array<bool, 3, Eigen::Dynamic> constrained;  ///< 3 × nodes
  NodalField value_m;                                 ///< 3 × nodes; 0 where not constrained
};

/// Throws BadInput where a fixation names a node outside the mesh, a value is not finite, or two fixations of one
/// degree of freedom disagree.
DirichletData readDirichlet(const std::vector<Fixation>& fixations, int nodes);

/// Throws BadInput where a spring names a node outside the mesh or is not finite and symmetric positive semi-definite
/// (to 1e-10 of its largest entry).
void requireGoodSprings(const std::vector<Spring>& springs, int nodes);

/// Force of the supports on the body, N: that of the springs, and at constrained degrees of freedom what balances the
/// node. imbalance_N: forces of the cells less the load, inertia added where the body moves; no springs in it.
NodalField reactionForces(const Eigen::Array<bool, 3, Eigen::Dynamic>& constrained, const NodalField& spring_N,
                          const NodalField& imbalance_N);

/// Support of a piece of a body against its six rigid motions: Σ Jᵀ s J over its supported nodes, J the translations
/// and rotations at x, s the node's stiffness. Unitless where x and s are.
using SupportMatrix = Eigen::Matrix<double, 6, 6>;
void addSupport(SupportMatrix& S, const Eigen::Vector3d& x, const Eigen::Matrix3d& s);
/// Rigid motions that nothing resists: eigenvalues below 1e-8 of the largest; 6 without any support.
int freeModesOf(const SupportMatrix& S);

/// Face-connected components of a body. Cells that share only an edge or a corner belong to different components: such
/// a joint is a hinge, a mechanism, and carries nothing.
struct Components {
  std::vector<int> ofCell;         ///< component per filled cell; 0 is the largest, ties by first cell
  std::vector<std::size_t> cells;  ///< filled cells per component
  int count() const { return static_cast<int>(cells.size()); }
};
Components findComponents(const VoxelMesh& mesh);

/// Rigid support of a component, unitless: translations and rotations about its centre, a rotation measured by the
/// motion at its half diagonal; fixed axes and the stiffest spring count 1.
SupportMatrix supportMatrix(const VoxelMesh& mesh, const Supports& supports, const Components& components,
                            int component);

/// A component whose supports leave it free to move as a rigid body.
struct FreeComponent {
  int component = 0;
  std::size_t cells = 0;
  double volume_m3 = 0.0;
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();  ///< mean of its cell centres, the body's axes
  Eigen::Vector3i firstCell = Eigen::Vector3i::Zero();
  int freeModes = 6;    ///< freeModesOf its support matrix
  bool hinged = false;  ///< touches another component along an edge or at a corner only
};
std::vector<FreeComponent> findUnsupported(const VoxelMesh& mesh, const Supports& supports);

/// Throws BadInput where findUnsupported finds something: names each component (mL, place), the number of its free
/// rigid modes, and what to do.
void requireSupported(const VoxelMesh& mesh, const Supports& supports);

/// The body without the given components; `dropped_m3`, where given, is the volume removed. Throws BadInput where
/// nothing would remain. Node numbers change: build supports and loads again.
VoxelBody dropComponents(const VoxelBody& body, const VoxelMesh& mesh, const std::vector<FreeComponent>& free,
                         double* dropped_m3 = nullptr);

}  // namespace glisson::mechanics
