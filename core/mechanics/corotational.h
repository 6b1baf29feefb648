// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>

#include "mechanics/hex_element.h"

namespace glisson::mechanics {

using HexCorners = Eigen::Matrix<double, 3, 8>;  ///< a vector per corner, corners as in VoxelMesh
using HexVector = Eigen::Matrix<double, 24, 1>;  ///< corner 0 x, y, z, corner 1 x, ...

/// Elastic energy (J), its gradient by the corner displacements (the internal force, N) and its second derivative (the
/// tangent, N/m, symmetric).
struct HexResponse {
  double energy_J = 0.0;
  HexVector force_N = HexVector::Zero();
  HexMatrix tangent_N_m = HexMatrix::Zero();  ///< untouched where not asked for
};

/// Which tangent of an element is computed.
enum class Tangent {
  None,
  Exact,    ///< second derivative of the energy
  Positive  ///< made positive semi-definite, for iterates far from equilibrium
};

/// Rotation of F = R U minus the identity, exact to rounding however small: Z = R − I, by Newton's iteration
/// [higham1986computing] written for the difference. Nothing where det F ≤ 0.
std::optional<Eigen::Matrix3d> rotationLessIdentity(const Eigen::Matrix3d& H);

/// Box element that turns with the material: R from the polar decomposition of the deformation gradient at the
/// element's centre, energy ½ E dᵀ K₀ d of the displacement d = Rᵀ x − X seen in the turned frame. Exact for rigid
/// motions of any size and for small strain at any rotation; strains themselves stay small-strain.
class CorotationalHex {
 public:
  /// K0: stiffness for E = 1 Pa of a box of edges h_m.
  CorotationalHex(const HexMatrix& K0, const Eigen::Vector3d& h_m);
  /// u_m: corner displacements. False where the element is turned inside out (det F ≤ 0 at its centre).
  bool evaluate(double E_Pa, const HexCorners& u_m, Tangent tangent, HexResponse& response) const;

 private:
  HexMatrix K0_;
  Eigen::Matrix<double, 8, 3> G_;  ///< gradients of the shape functions at the centre, 1/m
  HexCorners X_;                   ///< corners relative to the centre, m
};

}  // namespace glisson::mechanics
