// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>

#include "mechanics/corotational.h"

namespace glisson::mechanics {

/// Lamé's constants for E = 1 Pa.
constexpr double lameLambda(double poisson) {
  return poisson / ((1 + poisson) * (1 - 2 * poisson));
}
constexpr double lameMu(double poisson) {
  return 0.5 / (1 + poisson);
}

/// Box element of compressible neo-Hookean material, ψ = µ/2 (tr FᵀF − 3) − µ ln J + λ/2 (ln J)², with the dilatation
/// taken as its mean over the element [simo1985variational]: F̄ = (J̄/J)^{1/3} F at the 2×2×2 Gauss points, J̄ = v/V. It
/// has an energy (so the tangent is symmetric), does not lock as ν nears ½, and for small strain is the B-bar element.
/// The energy depends on two numbers per element, J̄ and S = Σ w tr(FᵀF) J^{−2/3}:
///   W = µ/2 (J̄^{2/3} S − 3V) + V (−µ ln J̄ + λ/2 (ln J̄)²).
/// Evaluated from the displacement gradient without cancellation: exact for strains of 1e-15 as for strains of 1.
class NeoHookeanHex {
 public:
  NeoHookeanHex(double poisson, const Eigen::Vector3d& h_m);
  /// u_m: corner displacements. False where det F ≤ 0 at a Gauss point. Tangent::Positive sets the
  /// element tangent's negative eigenvalues to 0.
  bool evaluate(double E_Pa, const HexCorners& u_m, Tangent tangent, HexResponse& response) const;

 private:
  double mu_, lambda_;  ///< for E = 1 Pa
  double volume_m3_;
  std::array<Eigen::Matrix<double, 8, 3>, 8> G_;  ///< gradients of the shape functions at the Gauss points, 1/m
};

}  // namespace glisson::mechanics
