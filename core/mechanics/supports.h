// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "mechanics/problem.h"

namespace glisson::mechanics {

/// Pieces of a body that hang together by cell faces. Cells that share only an edge or a corner belong to different
/// components: such a joint is a hinge, a mechanism, and carries nothing.
struct Components {
  std::vector<int> ofCell;         ///< component per filled cell; 0 is the largest, ties by first cell
  std::vector<std::size_t> cells;  ///< filled cells per component
  int count() const { return static_cast<int>(cells.size()); }
};
Components findComponents(const VoxelMesh& mesh);

/// Rigid support of a component as a 6 × 6 matrix Σ Jᵀ s J over its supported nodes, unitless: translations and
/// rotations about its centre, a rotation measured by the motion at its half diagonal; fixed axes and the stiffest
/// spring count 1.
Eigen::Matrix<double, 6, 6> supportMatrix(const VoxelMesh& mesh, const Supports& supports, const Components& components,
                                          int component);

/// A component whose supports leave it free to move as a rigid body.
struct FreeComponent {
  int component = 0;
  std::size_t cells = 0;
  double volume_m3 = 0.0;
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();  ///< mean of its cell centres, the body's axes
  Eigen::Vector3i firstCell = Eigen::Vector3i::Zero();
  int freeModes = 6;    ///< eigenvalues of the support matrix below 1e-8 of the largest; 6 without any support
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
