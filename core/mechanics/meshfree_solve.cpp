// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/meshfree_solve.h"

#include <Eigen/Dense>
#include <chrono>
#include <cmath>
#include <limits>
#include <sstream>

#include "base/error.h"
#include "base/parallel.h"
#include "mechanics/detail/one_blas_thread.h"

extern "C" {
void dpotrf_(const char* uplo, const int* n, double* a, const int* lda, int* info);
void dpotrs_(const char* uplo, const int* n, const int* nrhs, const double* a, const int* lda, double* b,
             const int* ldb, int* info);
}

namespace glisson::mechanics {
namespace {

double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

void symmetricTimes(const Eigen::SparseMatrix<double>& A, const Eigen::VectorXd& x, Eigen::VectorXd& y) {
  y.resize(A.rows());
  const int* outer = A.outerIndexPtr();
  const int* inner = A.innerIndexPtr();
  const double* value = A.valuePtr();
  parallelChunks(static_cast<std::size_t>(A.cols()), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) {
      double even = 0.0, odd = 0.0;
      int p = outer[j];
      for (; p + 1 < outer[j + 1]; p += 2) {
        even += value[p] * x[inner[p]];
        odd += value[p + 1] * x[inner[p + 1]];
      }
      if (p < outer[j + 1]) even += value[p] * x[inner[p]];
      y[static_cast<Eigen::Index>(j)] = even + odd;
    }
  });
}

SolveReport conjugateGradients(const VectorMap& A, const VectorMap& precondition, const Eigen::VectorXd& b,
                               Eigen::VectorXd& x, int iterations, double tolerance, const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  KrylovOptions options;
  options.limit = iterations;
  options.tolerance = tolerance;
  options.warm = true;
  options.quiet = true;
  const KrylovResult result = conjugateGradients(A, precondition, b, x, options, progress);
  SolveReport report;
  report.kind = "cg";
  report.status = result.status;
  report.iterations = result.iterations;
  report.residual = result.residual;
  report.tolerance = tolerance;
  report.seconds = secondsSince(start);
  return report;
}

void acceptRounding(double floor, SolveReport& report) {
  if (report.status != SolveStatus::StoppedAtLimit || !(report.residual <= floor)) return;
  std::ostringstream note;
  note << "; the residual reached the rounding of double precision, " << floor << ", above the tolerance asked for";
  report.why += note.str();
  report.tolerance = floor;
  report.status = SolveStatus::Converged;
}

void acceptRounding(const Eigen::SparseMatrix<double>& A, const Eigen::VectorXd& b, const Eigen::VectorXd& x,
                    SolveReport& report) {
  if (report.status != SolveStatus::StoppedAtLimit) return;
  const Eigen::VectorXd sizes = A.cwiseAbs() * x.cwiseAbs();
  acceptRounding(4 * std::numeric_limits<double>::epsilon() * sizes.norm() / b.norm(), report);
}

VectorMap jacobi(const Eigen::SparseMatrix<double>& A) {
  auto inverse = std::make_shared<Eigen::VectorXd>(A.diagonal().cwiseInverse());
  return [inverse](const Eigen::VectorXd& r, Eigen::VectorXd& z) { z = inverse->cwiseProduct(r); };
}

VectorMap blockJacobi(const Eigen::SparseMatrix<double>& A, const std::vector<int>& border) {
  auto blocks = std::make_shared<std::vector<Eigen::LLT<Eigen::MatrixXd>>>();
  for (std::size_t i = 0; i + 1 < border.size(); ++i) {
    const int size = border[i + 1] - border[i];
    blocks->emplace_back(Eigen::MatrixXd(A.block(border[i], border[i], size, size)));
    if (blocks->back().info() != Eigen::Success)
      throw SolverFailed("block " + std::to_string(i) + " of the mesh-free matrix is not positive definite", 0, 1.0,
                         0.0);
  }
  return [blocks, border](const Eigen::VectorXd& r, Eigen::VectorXd& z) {
    for (std::size_t i = 0; i < blocks->size(); ++i) {
      const int size = border[i + 1] - border[i];
      z.segment(border[i], size) = (*blocks)[i].solve(r.segment(border[i], size));
    }
  };
}

DenseCholesky::DenseCholesky(const Eigen::SparseMatrix<double>& A) {
  if (A.rows() > largest)
    throw BadArgument("DenseCholesky: " + std::to_string(A.rows()) + " rows; at most " + std::to_string(largest));
  const Eigen::VectorXd diagonal = A.diagonal();
  if (!diagonal.allFinite()) {
    status_ = SolveStatus::NotFinite;
    return;
  }
  if (!(diagonal.array() > 0.0).all()) {
    status_ = SolveStatus::Indefinite;
    return;
  }
  scale_ = diagonal.cwiseSqrt().cwiseInverse();
  L_ = scale_.asDiagonal() * Eigen::MatrixXd(A) * scale_.asDiagonal();
  const int n = static_cast<int>(A.rows());
  int info = 0;
  const OneBlasThread one;
  dpotrf_("L", &n, L_.data(), &n, &info);
  if (info != 0) status_ = L_.allFinite() ? SolveStatus::Indefinite : SolveStatus::NotFinite;
}

void DenseCholesky::solve(const Eigen::MatrixXd& b, Eigen::MatrixXd& x) const {
  if (status_ != SolveStatus::Converged) throw BadArgument("DenseCholesky: solve without a factor");
  if (b.rows() != L_.rows()) throw BadArgument("DenseCholesky: right-hand side of a wrong length");
  x = scale_.asDiagonal() * b;
  const int n = static_cast<int>(L_.rows()), columns = static_cast<int>(b.cols());
  int info = 0;
  {
    const OneBlasThread one;
    dpotrs_("L", &n, &columns, L_.data(), &n, x.data(), &n, &info);
  }
  x = (scale_.asDiagonal() * x).eval();
}

SolveReport DenseCholesky::solve(const VectorMap& A, const Eigen::VectorXd& b, Eigen::VectorXd& x, double tolerance,
                                 double enough) const {
  const auto start = std::chrono::steady_clock::now();
  SolveReport report;
  report.kind = "factorised";
  report.tolerance = tolerance;
  const double norm = b.norm();
  x = Eigen::VectorXd::Zero(b.size());
  if (norm > 0.0 && std::isfinite(norm)) {
    Eigen::VectorXd r = b, best = x, Ax(b.size());
    double residual = 1.0;
    for (int pass = 0; pass < 4; ++pass) {
      Eigen::MatrixXd correction;
      solve(r, correction);
      const Eigen::VectorXd candidate = best + correction.col(0);
      A(candidate, Ax);
      r = b - Ax;
      const double now = r.norm() / norm;
      if (!(now < 0.5 * residual) && pass > 0) break;
      best = candidate, residual = now;
      ++report.iterations;
      if (now <= enough) break;
    }
    x = best;
    report.residual = residual;
  }
  report.status = !std::isfinite(norm) || !x.allFinite() ? SolveStatus::NotFinite
                  : report.residual <= tolerance         ? SolveStatus::Converged
                                                         : SolveStatus::StoppedAtLimit;
  report.seconds = secondsSince(start);
  return report;
}

}  // namespace glisson::mechanics
