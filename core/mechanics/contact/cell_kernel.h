// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace glisson::mechanics {

/// How the cells of a body answer to deformation; F the deformation gradient, J the mean of det F over the cell.
enum class SolidLaw {
  Polynomial,   ///< ψ = µ/2 (tr FᵀF − 3) − µ (J − 1) + (λ + µ)/2 (J − 1)², finite for any J
  Logarithmic,  ///< ψ = µ/2 (tr FᵀF − 3) − µ ln J + λ/2 (ln J)², J > 0
  Linear        ///< small strain, the tangent of both at rest
};

/// Trilinear cells in their seven non-constant Walsh modes: c_m = e_m + alpha_m Σ_a s_m(a) u_a (e_1..e_3 the unit
/// vectors, else 0), modes in the order ξ, η, ζ, ξη, ηζ, ζξ, ξηζ. With these scales
///   mean tr FᵀF = Σ w_m |c_m|²,  mean det F = [c1 c2 c3] + [c4 c2 c5] + [c6 c5 c3] + [c1 c4 c6] exactly.
/// Signs are those of the row kernels: s = (−1)^bit per axis of the mode.
struct CellModes {
  static constexpr std::array<int, 7> walsh = {1, 2, 4, 3, 6, 5, 7};  ///< bit 0 along x, 1 along y, 2 along z
  std::array<double, 7> alpha{};                                      ///< 1/m
  std::array<double, 7> w{};
  explicit CellModes(const Eigen::Vector3d& h_m);
  CellModes() = default;
};

/// One row of cells along x and the four node rows it touches, as RowTask has them.
template <class In, class Out>
struct CellRow {
  const In* in[4][3];
  Out* out[4][3];
  std::size_t n = 0;  ///< cells, a multiple of RowLattice::pad
};

/// The linearised cells: c_1..c_6 (18 values), p, p of the positive part, λ″, µ; all but c are multiplied by the cell's
/// filled volume (m³), so in N m. Stored sixteen cells at a time, value by value, so that a kernel reads one stream.
struct TangentArrays {
  static constexpr std::size_t p = 18, positive = 19, lambda = 20, mu = 21, count = 22;
  static constexpr std::size_t block = 16;  ///< RowLattice::pad
  static constexpr std::size_t at(std::size_t value, std::size_t cell) {
    return (cell / block * count + value) * block + cell % block;
  }
};

/// Energy (J) and nodal forces (N, added to row.out) of a row of cells at displacements row.in (m). mu, lambda: Lamé's
/// constants times filled volume, per cell; 0 = empty. good becomes false where the law is not defined (J ≤ 0).
double addCellForces(SolidLaw law, const CellModes& modes, const CellRow<double, double>& row, const double* mu,
                     const double* lambda, bool& good);

/// The tangent of a row of cells at displacements row.in; state: of the row's first cell.
void lineariseCells(SolidLaw law, const CellModes& modes, const CellRow<double, double>& row, const double* mu,
                    const double* lambda, float* state);

/// row.out += tangent · row.in. positive: its positive part, p clamped to ±µ/σ, σ the largest singular value of
/// [c1 c2 c3] (or a bound of it from above).
void addCellTangent(const CellModes& modes, const CellRow<float, float>& row, const float* state, bool positive);

/// Adds the 3 × 3 diagonal blocks of the tangent to six arrays (xx xy xz yy yz zz) of `nodes` values each: out[r]
/// points to the row's first node in the first array. p has no part in them.
void addCellDiagonal(const CellModes& modes, float* const out[4], std::size_t nodes, std::size_t n, const float* state);

/// Smallest mean det F over the filled cells of a row, starting from `smallest`.
double smallestVolumeRatio(const CellModes& modes, const CellRow<double, double>& row, const double* mu,
                           double smallest);

}  // namespace glisson::mechanics
