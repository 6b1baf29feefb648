// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mechanics/voxel_operator.h"

namespace glisson::mechanics {

/// Smoother and coarsest level of the multigrid.
struct MultigridOptions {
  int degree = 5;             ///< of the Chebyshev smoother, before and after each coarse correction
  double smoothed = 24;       ///< the smoother acts on eigenvalues of D⁻¹K in [λmax / smoothed, λmax]
  bool boundByCells = false;  ///< λmax from single cells, which always holds, not from iteration (spectral_bound.h)
  static constexpr int longest = 40;  ///< degree
  int coarsestDofs = 1500;            ///< factorised at or below this size

  /// Near incompressible bodies take longer polynomials over a wider range: half the iterations for the same products.
  static MultigridOptions forPoisson(double poisson);
};

/// The matrix that a hierarchy approximates: stiffness · K + mass · M, M the body's consistent mass matrix (kg). The
/// matrix of an implicit time step has both.
struct MultigridMatrix {
  double stiffness = 1;  ///< positive
  double mass = 0;       ///< 0 or more
};

/// One V-cycle as a preconditioner, in float. Coarse levels take the mean of the moduli (empty = 0) and rebuild the
/// element; springs are restricted by row sums; only axes whose cells are shorter than 1.5 × the shortest are halved,
/// so flat or long cells become cubes first. The coarsest level is factorised in double.
///   The cycle B is symmetric positive definite, but for rounding: on the coarsest level it is the inverse of such a
/// matrix; on every other one B = q̄(A) + (1 − M A)ᵀ P B_c Pᵀ (1 − A M), where M is the smoother and q̄ = M + Mᵀ − Mᵀ A M
/// is positive definite as soon as |1 − λ m(λ)| < 1 for every eigenvalue λ of D⁻¹ A, which the Chebyshev polynomial is
/// on (0, λmax]; so all that it takes is that λmax is not below the largest eigenvalue (spectral_bound.h). How well a
/// coarse matrix stands for the fine one plays no role in it.
class Multigrid {
 public:
  /// Throws SolverFailed where the coarsest level has no factor (a body that is not held, without mass).
  explicit Multigrid(const VoxelOperator& op, const MultigridOptions& options = {}, const MultigridMatrix& matrix = {});
  ~Multigrid();
  Multigrid(Multigrid&&) noexcept;
  Multigrid& operator=(Multigrid&&) noexcept;

  /// z ≈ A⁻¹ r up to a constant factor, row storage, T = float or double; z is 0 at fixed degrees of freedom, and
  /// trades its memory where it has r's size. Same bits with any number of threads. Not for several threads at once.
  template <class T>
  void cycle(const std::vector<T>& r, std::vector<float>& z);
  void cycle(const std::vector<double>& r, std::vector<double>& z);

  /// Takes the bound that always holds on every level; false where it is taken already. For a solve that met pᵀ A p ≤ 0
  /// or rᵀ B r ≤ 0: the sharper bound fails in one body of ten thousand at worst.
  bool boundByCells();

  /// Makes the smoother's polynomial longer by a factor, up to MultigridOptions::longest, over a range that grows with
  /// its square: fewer iterations for the same number of products, where the coarse correction is poor. False where it
  /// is as long as it may be.
  bool lengthen(double factor);
  /// Of the smoother.
  int degree() const;

  int levels() const;
  /// "221 133 → 28 890 → ..." degrees of freedom per level.
  std::string describe() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace glisson::mechanics
