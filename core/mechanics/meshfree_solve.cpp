// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/meshfree_solve.h"

#include <Eigen/Dense>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>
#include <sstream>

#include "base/error.h"
#include "base/parallel.h"

extern "C" {
void dpotrf_(const char* uplo, const int* n, double* a, const int* lda, int* info);
void dpotrs_(const char* uplo, const int* n, const int* nrhs, const double* a, const int* lda, double* b,
             const int* ldb, int* info);
void openblas_set_num_threads(int threads);
int openblas_get_num_threads();
}

namespace glisson::mechanics {
namespace {

double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// BLAS on one thread while it lives: its sums would depend on the number of threads otherwise.
class OneBlasThread {
 public:
  OneBlasThread() : lock_(guard()), before_(openblas_get_num_threads()) {
    if (before_ != 1) openblas_set_num_threads(1);
  }
  ~OneBlasThread() {
    if (before_ != 1) openblas_set_num_threads(before_);
  }
  OneBlasThread(const OneBlasThread&) = delete;
  OneBlasThread& operator=(const OneBlasThread&) = delete;

 private:
  static std::mutex& guard() {
    static std::mutex mutex;
    return mutex;
  }
  std::lock_guard<std::mutex> lock_;
  int before_;
};

double dot(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return parallelSum(static_cast<std::size_t>(a.size()), 16384, [&](std::size_t begin, std::size_t end) {
    const auto from = static_cast<Eigen::Index>(begin), count = static_cast<Eigen::Index>(end - begin);
    return a.segment(from, count).dot(b.segment(from, count));
  });
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
  SolveReport report;
  report.kind = "cg";
  report.tolerance = tolerance;
  const auto finish = [&](SolveStatus status, double residual) {
    report.status = status, report.residual = residual, report.seconds = secondsSince(start);
    return report;
  };
  if (x.size() != b.size()) x = Eigen::VectorXd::Zero(b.size());
  const double norm = std::sqrt(dot(b, b));
  if (!std::isfinite(norm)) return finish(SolveStatus::NotFinite, norm);
  if (norm == 0.0) {
    x.setZero();
    return finish(SolveStatus::Converged, 0.0);
  }
  Eigen::VectorXd Ap(b.size()), z(b.size());
  A(x, Ap);
  Eigen::VectorXd r = b - Ap;
  const auto trueResidual = [&] {
    A(x, Ap);
    const Eigen::VectorXd rest = b - Ap;
    return std::sqrt(dot(rest, rest)) / norm;
  };
  const auto apply = [&](const Eigen::VectorXd& from, Eigen::VectorXd& to) {
    if (precondition)
      precondition(from, to);
    else
      to = from;
  };
  apply(r, z);
  Eigen::VectorXd p = z;
  double rz = dot(r, z);
  SolveStatus status = SolveStatus::StoppedAtLimit;
  int restarts = 0;
  while (true) {
    if (std::sqrt(dot(r, r)) <= tolerance * norm) {
      // The recurrence drifts from b − A x; only the true residual ends the iteration.
      A(x, Ap);
      r = b - Ap;
      if (std::sqrt(dot(r, r)) <= tolerance * norm) {
        status = SolveStatus::Converged;
        break;
      }
      if (++restarts > 5) break;
      apply(r, z);
      p = z;
      rz = dot(r, z);
    }
    if (report.iterations >= iterations) break;
    if (report.iterations % 16 == 0) progress.check();
    A(p, Ap);
    const double pAp = dot(p, Ap);
    if (!std::isfinite(pAp) || !std::isfinite(rz)) {
      status = SolveStatus::NotFinite;
      break;
    }
    if (pAp <= 0.0) {
      status = SolveStatus::Indefinite;
      break;
    }
    const double alpha = rz / pAp;
    x += alpha * p;
    r -= alpha * Ap;
    apply(r, z);
    const double next = dot(r, z);
    p = z + (next / rz) * p;
    rz = next;
    ++report.iterations;
  }
  const double residual = trueResidual();
  if (!std::isfinite(residual)) status = SolveStatus::NotFinite;
  return finish(status, residual);
}

void acceptRounding(const Eigen::SparseMatrix<double>& A, const Eigen::VectorXd& b, const Eigen::VectorXd& x,
                    SolveReport& report) {
  if (report.status != SolveStatus::StoppedAtLimit) return;
  const Eigen::VectorXd sizes = A.cwiseAbs() * x.cwiseAbs();
  const double floor = 4 * std::numeric_limits<double>::epsilon() * sizes.norm() / b.norm();
  if (!(report.residual <= floor)) return;
  std::ostringstream note;
  note << "; the residual reached the rounding of double precision, " << floor << ", above the tolerance asked for";
  report.why += note.str();
  report.tolerance = floor;
  report.status = SolveStatus::Converged;
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
