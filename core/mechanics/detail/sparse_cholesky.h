// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <cstdint>
#include <memory>

namespace glisson::mechanics {

/// Lower triangle of a symmetric matrix by columns, compressed, rows ascending in each. The index is CHOLMOD's long
/// one: factors have more entries than int counts.
using LowerTriangle = Eigen::SparseMatrix<double, Eigen::ColMajor, std::int64_t>;

/// A = L Lᵀ of a sparse symmetric positive definite matrix: CHOLMOD, supernodal, BLAS on one thread (the same bits on
/// one machine whatever the thread count). The symbolic part is made once, for a pattern. Without rows it does nothing.
class SparseCholesky {
 public:
  /// Analyses the pattern of A; its values do not matter. Throws SolverFailed where memory runs out.
  explicit SparseCholesky(const LowerTriangle& A);
  ~SparseCholesky();
  SparseCholesky(SparseCholesky&&) noexcept;
  SparseCholesky& operator=(SparseCholesky&&) noexcept;

  /// False where A is not positive definite. A has the pattern that was analysed. Throws SolverFailed where memory runs
  /// out.
  bool factorise(const LowerTriangle& A);
  /// x = A⁻¹ b, rows() values each; they may be the same array. Precondition: factorise has returned true. Not for
  /// several threads at once. Throws SolverFailed where memory runs out.
  void solve(const double* b, double* x);

  Eigen::Index rows() const;
  /// Bytes of the factor.
  double bytes() const;
  /// Expected bytes of the factor of a compact body with so many degrees of freedom (nested dissection, ∝ n^{4/3}).
  static double expectedBytes(double dofs);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace glisson::mechanics
