// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <functional>
#include <type_traits>
#include <vector>

#include "base/progress.h"
#include "mechanics/lattice_operator.h"
#include "mechanics/problem.h"

namespace glisson::mechanics {

/// Arrays of LatticeOperator<T>::size() values, T = float or double; sums are made in double and in fixed chunks (same
/// bits with any threads).
template <class T, class Z>
double dot(const std::vector<T>& a, const std::vector<Z>& b);
template <class T>
double norm(const std::vector<T>& a);

/// z = M⁻¹ r; z is 0 where r belongs to a fixed degree of freedom or to no node. z may be in float where r is in
/// double.
template <class T, class Z = T>
using PreconditioningOf = std::function<void(const std::vector<T>& r, std::vector<Z>& z)>;
using Preconditioning = PreconditioningOf<double>;

/// y = A x on nodal or reduced unknowns; y has the right size already.
using VectorMap = std::function<void(const Eigen::VectorXd& x, Eigen::VectorXd& y)>;

/// When conjugate gradients stop.
struct KrylovOptions {
  int limit = 1000;
  double tolerance = 1e-8;  ///< on ‖b − A x‖ / ‖b‖, recomputed in T before it is believed
  bool flexible = false;    ///< Polak-Ribière β: for a preconditioner that is only nearly linear (float)
  bool recursive = false;   ///< believes the recursion: for corrections whose caller recomputes the residual
  /// Asked every few iterations with the number that the rate since the last change would take in all; true says that M
  /// has changed, and the solve goes on from where it is.
  std::function<bool(int expected)> slow;
  bool warm = false;   ///< starts from the x that is given, not from 0
  bool quiet = false;  ///< asks progress for cancellation alone: an inner solve of a larger job
  bool energyToo = false;  ///< also asks √(rᵀM⁻¹r / bᵀM⁻¹b) ≤ tolerance: bounds the error where contrast is strong
};

/// How conjugate gradients ended.
struct KrylovResult {
  SolveStatus status = SolveStatus::StoppedAtLimit;
  int iterations = 0;
  double residual = 0.0;  ///< true, ‖b − A x‖ / ‖b‖
};

/// Preconditioned conjugate gradients for A x = b, A symmetric positive definite, b 0 at fixed degrees of freedom; b =
/// 0 gives 0. Restarts from the true residual where the recursion has drifted from it, for as long as that halves it.
/// Ends with Indefinite where pᵀA p ≤ 0 or rᵀM⁻¹r ≤ 0 and with NotFinite where a number is not finite; x is then the
/// last iterate.
template <class T, class Z = T>
KrylovResult conjugateGradients(const LatticeOperator<T>& A, const std::vector<T>& b, std::vector<T>& x,
                                const std::type_identity_t<PreconditioningOf<T, Z>>& M, const KrylovOptions& options,
                                const Progress& progress);
/// The same method on Eigen's vectors, whose sums keep Eigen's order. An empty M preconditions by nothing.
KrylovResult conjugateGradients(const VectorMap& A, const VectorMap& M, const Eigen::VectorXd& b, Eigen::VectorXd& x,
                                const KrylovOptions& options, const Progress& progress);

}  // namespace glisson::mechanics
