// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mechanics/tet_mesh.h"

namespace glisson::mechanics {

/// A quadrature point of a tetrahedron.
struct TetPoint {
  Eigen::VectorXd N;                           ///< shape functions, 4 or 10
  Eigen::Matrix<double, Eigen::Dynamic, 3> G;  ///< their gradients, 1/m
  double volume_m3 = 0.0;                      ///< weight
};

/// One point for T4, four for T10 (exact for straight edges). Throws BadInput naming the tetrahedron where it is flat
/// or inverted: Jacobian below 1e-9 of the cube of its longest edge.
std::vector<TetPoint> tetPoints(const TetMesh& mesh, int tet);

/// Gradients of the shape functions at (ξ, η, ζ), 4 or 10 × 3, 1/m.
Eigen::Matrix<double, Eigen::Dynamic, 3> tetGradients(const TetMesh& mesh, int tet, const Eigen::Vector3d& xi);

/// Stiffness of a tetrahedron, 12 × 12 or 30 × 30, N/m: symmetric, positive semi-definite, six zero modes.
Eigen::MatrixXd tetStiffness(const TetMesh& mesh, int tet, double poisson);

/// Stress (xx yy zz xy yz zx, Pa) of a displacement at (ξ, η, ζ) of a tetrahedron.
Eigen::Matrix<double, 6, 1> tetStress_Pa(const TetMesh& mesh, int tet, double poisson, const NodalField& u_m,
                                         const Eigen::Vector3d& xi);

}  // namespace glisson::mechanics
