// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "mechanics/hex_element.h"
#include "mechanics/lattice_operator.h"

namespace glisson::mechanics {

/// K = L Lᵀ of a lattice operator over its active degrees of freedom: those of nodes that touch a filled cell and are
/// not fixed. Supernodal, one thread (the same bits on one machine whatever the thread count).
class Factorisation {
 public:
  /// K0 and M0: the element stiffness and mass that A.blocks was made from; M0 matters where A.rho is given. Throws
  /// SolverFailed where the matrix is not positive definite or memory runs out.
  Factorisation(const LatticeOperator<double>& A, const HexMatrix& K0,
                const Eigen::Matrix<double, 8, 8>& M0 = Eigen::Matrix<double, 8, 8>::Zero());
  ~Factorisation();
  Factorisation(Factorisation&&) noexcept;
  Factorisation& operator=(Factorisation&&) noexcept;

  /// x = K⁻¹ b on row storage; 0 at inactive slots. Not for several threads at once.
  void solve(const double* b, double* x);
  int dofs() const;
  /// Bytes of the factor.
  double bytes() const;

  /// Expected bytes of the factor of a compact body, from its degrees of freedom (nested dissection, ∝ n^{4/3}).
  static double expectedBytes(double dofs);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace glisson::mechanics
