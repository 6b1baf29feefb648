// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "mechanics/hex_element.h"
#include "mechanics/lattice_operator.h"

namespace glisson::mechanics {

/// Upper bounds of the largest eigenvalue λ of D⁻¹ A, A = P (Σ (E_e K₀ + rho_e M₀) + springs) P of a LatticeOperator
/// and D its diagonal, without unit. The Chebyshev smoother of the multigrid is contracting below such a bound only.

/// Bound that depends on the element alone (formulation, Poisson's ratio, shape of the cell): the largest eigenvalue μ
/// of D₀⁻¹ K₀ of one cell, at least 3, and at least 27/8, that of a box's consistent mass, where there is mass.
///   Proof: K₀ ≤ μ D₀ on one cell, so xᵀ A x = Σ E_e x_eᵀ K₀ x_e + ... ≤ μ Σ E_e x_eᵀ D₀ x_e + ... = μ xᵀ D x for any
/// moduli E_e ≥ 0; a positive semi-definite 3 × 3 spring k satisfies k ≤ 3 diag(k); fixing degrees of freedom restricts
/// x. One stiff cell in a soft body reaches it; in a uniform body it is 1.6 times λ (incompatible modes, ν .45) to 3
/// times (plain hexahedra, ν .499).
double boundOverCells(const HexMatrix& K0, bool withMass);

/// Sharper bound from k steps of the Lanczos method on D^{-1/2} A D^{-1/2}, ξ / 0.87 with its largest Ritz value ξ.
///   The probability over random starts that ξ < (1 − ε) λ is at most 1.648 √n exp(−√ε (2k − 1)) for n unknowns
/// whatever the spectrum [kuczynski1992estimating]; k is chosen to make that 1e-4 for ε = 0.13 (18 to 26).
/// The start is fixed, so that the same body gives the same bits. inverseDiagonal: 1 / D, 0 at fixed degrees of freedom
/// and slots without a node; work arrays have A.size() values.
double boundByIteration(const LatticeOperator<float>& A, const std::vector<float>& inverseDiagonal,
                        std::vector<float>& work1, std::vector<float>& work2, std::vector<float>& work3);

}  // namespace glisson::mechanics
