#pragma once

#include <functional>
#include <vector>

#include "base/progress.h"
#include "mechanics/lattice_operator.h"
#include "mechanics/problem.h"

namespace glisson::mechanics {

/// Arrays of LatticeOperator<double>::size() values; sums are made in fixed chunks (same bits with any threads).
double dot(const std::vector<double>& a, const std::vector<double>& b);
double norm(const std::vector<double>& a);

/// z = M⁻¹ r; z is 0 where r belongs to a fixed degree of freedom or to no node.
using Preconditioning = std::function<void(const std::vector<double>& r, std::vector<double>& z)>;

struct KrylovOptions {
  int limit = 1000;
  double tolerance = 1e-8;  ///< on ‖b − A x‖ / ‖b‖, recomputed in double before it is believed
  bool flexible = false;    ///< Polak-Ribière β: for a preconditioner that is only nearly linear (float)
  bool energyToo = false;  ///< also asks √(rᵀM⁻¹r / bᵀM⁻¹b) ≤ tolerance: bounds the error where contrast is strong
};

struct KrylovResult {
  SolveStatus status = SolveStatus::StoppedAtLimit;
  int iterations = 0;
  double residual = 0.0;  ///< true, ‖b − A x‖ / ‖b‖
};

/// Preconditioned conjugate gradients for A x = b from x = 0, b ≠ 0 and 0 at fixed degrees of freedom. Restarts from
/// the true residual where the recursion has drifted from it. Ends with Indefinite where pᵀA p ≤ 0 and with NotFinite
/// where a number is not finite.
KrylovResult conjugateGradients(const LatticeOperator<double>& A, const std::vector<double>& b, std::vector<double>& x,
                                const Preconditioning& M, const KrylovOptions& options, const Progress& progress);

}  // namespace glisson::mechanics
