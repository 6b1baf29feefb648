// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>

#include "mechanics/problem.h"

namespace glisson::mechanics {

/// Matrix of a box element: 8 corners, x, y, z each.
using HexMatrix = Eigen::Matrix<double, 24, 24>;

/// Isotropic elasticity for unit Young's modulus; strain order xx yy zz xy yz zx, engineering shear. poisson in (−1,
/// 0.5).
Eigen::Matrix<double, 6, 6> elasticity(double poisson);

/// Strain-displacement matrix of the trilinear box element at xi ∈ [−1, 1]³, 1/m: strain (6, order as above) =
/// B u, u = (corner 0 x, y, z, corner 1 x, ...), corners as in VoxelMesh.
Eigen::Matrix<double, 6, 24> hexStrain(const Eigen::Vector3d& h_m, const Eigen::Vector3d& xi);

/// Gradients of the eight trilinear shape functions at xi, 8 × 3, 1/m.
Eigen::Matrix<double, 8, 3> hexGradients(const Eigen::Vector3d& h_m, const Eigen::Vector3d& xi);

/// Values of the eight trilinear shape functions at xi; sum 1.
Eigen::Matrix<double, 8, 1> hexShape(const Eigen::Vector3d& xi);

/// Stiffness K₀ of a box of edges h_m for E = 1 Pa, N/m (so that K_e = E_e K₀). Symmetric to the last bit, positive
/// semi-definite with exactly the six rigid zero modes; 2×2×2 Gauss points, exact for a box.
///   H8           plain trilinear;
///   BBar         the volumetric strain replaced by its mean over the element [hughes1980generalization];
///   Incompatible nine modes 1 − ξ² per axis and component, condensed; they leave constant strain alone, so the patch
///                test holds for boxes [wilson1973incompatible, taylor1976nonconforming].
/// Throws BadArgument unless h_m > 0 and poisson in (−1, 0.5).
HexMatrix hexStiffness(HexElement element, double poisson, const Eigen::Vector3d& h_m);

/// Consistent mass of a box for unit density, 8 × 8 (the same for each component), m³; entries sum to the volume.
Eigen::Matrix<double, 8, 8> hexMass(const Eigen::Vector3d& h_m);

/// A box has three mirror planes; Walsh functions over its corners therefore split K₀ into eight 3×3 blocks.
/// blocks[p](c, d) = 1/64 Σ_{a,b} (−1)^{|a ∧ m_c| + |b ∧ m_d|} K₀(3a + c, 3b + d), m_c = p ⊕ 2^c, so that
/// K₀(3a + c, 3b + d) = Σ over p of (−1)^{...} blocks[p](c, d). Ten times fewer operations than the dense product.
/// The entries of translations are
/// exactly 0. Throws BadArgument where K₀ lacks the symmetry (entries outside the blocks above 1e-12 of the largest).
std::array<Eigen::Matrix3d, 8> walshBlocks(const HexMatrix& K0);
/// The same for a mass matrix such as hexMass, which is diagonal over Walsh functions: values[m] = 1/64 Σ_{a,b}
/// (−1)^{|a ∧ m| + |b ∧ m|} M₀(a, b).
std::array<double, 8> walshValues(const Eigen::Matrix<double, 8, 8>& M0);

}  // namespace glisson::mechanics
