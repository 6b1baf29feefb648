// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <memory>
#include <vector>

#include "base/progress.h"
#include "mechanics/krylov.h"
#include "mechanics/problem.h"

namespace glisson::mechanics {

/// y = A x for a symmetric compressed matrix (column j is row j, so that threads write apart). Same bits with any
/// threads.
void symmetricTimes(const Eigen::SparseMatrix<double>& A, const Eigen::VectorXd& x, Eigen::VectorXd& y);

/// conjugateGradients of krylov.h from the start x (0 where its size is another), reported as a solve of its own: kind
/// "cg", the seconds it took.
SolveReport conjugateGradients(const VectorMap& A, const VectorMap& precondition, const Eigen::VectorXd& b,
                               Eigen::VectorXd& x, int iterations, double tolerance, const Progress& progress = {});

/// Where a solve ended above its tolerance with a residual of at most `floor`, which rounding alone leaves, it is
/// Converged, its tolerance is the floor, and `why` says so.
void acceptRounding(double floor, SolveReport& report);
/// Evaluating A x in double precision leaves a residual of up to 4 ε ‖|A| |x|‖ however x was found: that floor.
void acceptRounding(const Eigen::SparseMatrix<double>& A, const Eigen::VectorXd& b, const Eigen::VectorXd& x,
                    SolveReport& report);

/// The inverse diagonal, or the inverses of the diagonal blocks [border[i], border[i+1]), as a preconditioner.
VectorMap jacobi(const Eigen::SparseMatrix<double>& A);
VectorMap blockJacobi(const Eigen::SparseMatrix<double>& A, const std::vector<int>& border);

/// Dense Cholesky of a symmetric positive definite matrix of at most `largest` rows, rows and columns scaled to a unit
/// diagonal. One thread: the same bits always.
class DenseCholesky {
 public:
  static constexpr Eigen::Index largest = 10000;  ///< 800 MB
  /// status() is Indefinite or NotFinite where the factor does not exist. Throws BadArgument above `largest` rows.
  explicit DenseCholesky(const Eigen::SparseMatrix<double>& A);
  SolveStatus status() const { return status_; }
  /// x = A⁻¹ b (one column or many). Precondition: status() == Converged.
  void solve(const Eigen::MatrixXd& b, Eigen::MatrixXd& x) const;
  /// Solve, then refine against A (y = A x) until the true residual is at most `enough` or stops falling (three times
  /// at most). Converged where it is at most `tolerance`.
  SolveReport solve(const VectorMap& A, const Eigen::VectorXd& b, Eigen::VectorXd& x, double tolerance,
                    double enough = 1e-15) const;

 private:
  Eigen::MatrixXd L_;
  Eigen::VectorXd scale_;
  SolveStatus status_ = SolveStatus::Converged;
};

}  // namespace glisson::mechanics
