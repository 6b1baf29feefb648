// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "base/error.h"
#include "mechanics/dynamics.h"

namespace glisson::mechanics {
namespace {

constexpr int ownLimit = 2000;  ///< CG iterations where the options name no limit

}  // namespace

MatrixSystem::MatrixSystem(Eigen::SparseMatrix<double> K_N_m, Eigen::SparseMatrix<double> M_kg,
                           const SolverOptions& options, std::vector<int> borders)
    : K_(std::move(K_N_m)), M_(std::move(M_kg)), options_(options), borders_(std::move(borders)) {
  if (K_.rows() != K_.cols() || M_.rows() != K_.rows() || M_.cols() != K_.cols())
    throw BadArgument("MatrixSystem: K and M must be square and of one size");
  if (options_.kind == SolverKind::Multigrid)
    throw BadInput("stored matrices have no multigrid solver; choose auto, factorised or cg");
  if (options_.kind == SolverKind::Auto)
    options_.kind = K_.rows() <= DenseCholesky::largest ? SolverKind::Factorised : SolverKind::Cg;
  if (options_.kind == SolverKind::Cg && options.kind == SolverKind::Auto)
    options_.preconditioner = Preconditioner::BlockJacobi;
  K_.makeCompressed();
  M_.makeCompressed();
  if (borders_.empty()) {
    for (Eigen::Index b = 0; b < K_.rows(); b += 3) borders_.push_back(static_cast<int>(b));
    borders_.push_back(static_cast<int>(K_.rows()));
  }
}

void MatrixSystem::applyK(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  symmetricTimes(K_, x, y);
}
void MatrixSystem::applyM(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  symmetricTimes(M_, x, y);
}

void MatrixSystem::prepare(double m, double k) {
  A_ = m * M_ + k * K_;
  A_.makeCompressed();
  factor_.reset();
  preconditioner_ = nullptr;
  if (options_.kind == SolverKind::Factorised) {
    factor_ = std::make_unique<DenseCholesky>(A_);
    if (factor_->status() != SolveStatus::Converged)
      throw SolverFailed(
          "the matrix of the time step has no Cholesky factor: the stiffness is not positive semi-definite", 0, 1.0,
          options_.tolerance);
  } else if (options_.preconditioner == Preconditioner::Jacobi) {
    preconditioner_ = jacobi(A_);
  } else if (options_.preconditioner == Preconditioner::BlockJacobi) {
    preconditioner_ = blockJacobi(A_, borders_);
  }
}

SolveReport MatrixSystem::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const {
  const VectorMap apply = [this](const Eigen::VectorXd& from, Eigen::VectorXd& to) { symmetricTimes(A_, from, to); };
  SolveReport report =
      factor_ ? factor_->solve(apply, b, x, options_.tolerance, options_.tolerance)
              : conjugateGradients(apply, preconditioner_, b, x,
                                   options_.iterations > 0 ? options_.iterations : ownLimit, options_.tolerance);
  acceptRounding(A_, b, x, report);
  return report;
}

void MatrixSystem::setFreeModes(const Eigen::MatrixXd& modes) {
  if (modes.rows() != size()) throw BadArgument("setFreeModes: the modes do not have the system's size");
  freeModes_ = massOrthonormal(*this, modes);
  Eigen::VectorXd Kr(size());
  for (Eigen::Index c = 0; c < freeModes_.cols(); ++c) {
    applyK(freeModes_.col(c), Kr);
    const double scale = K_.diagonal().cwiseAbs().cwiseProduct(freeModes_.col(c).cwiseAbs()).norm();
    if (Kr.norm() > 1e-8 * scale)
      throw BadArgument("setFreeModes: mode " + std::to_string(c) + " stores energy, so it is not free");
  }
}

Eigen::MatrixXd massOrthonormal(const DynamicSystem& system, const Eigen::MatrixXd& vectors) {
  Eigen::MatrixXd out(vectors.rows(), vectors.cols());
  Eigen::Index count = 0;
  Eigen::VectorXd Mx(vectors.rows());
  for (Eigen::Index c = 0; c < vectors.cols(); ++c) {
    Eigen::VectorXd x = vectors.col(c);
    system.applyM(x, Mx);
    const double before = std::sqrt(x.dot(Mx));
    if (!(before > 0.0)) continue;
    x /= before;
    double length = 1.0;
    for (int pass = 0; pass < 3; ++pass) {
      system.applyM(x, Mx);
      for (Eigen::Index b = 0; b < count; ++b) x -= out.col(b).dot(Mx) * out.col(b);
      system.applyM(x, Mx);
      length = std::sqrt(x.dot(Mx));
      if (!(length > 1e-10)) break;
      // After one pass, a vector that keeps its length is orthogonal to working accuracy.
      x /= length;
      if (pass > 0 && length > 0.9) break;
    }
    if (length > 1e-10) out.col(count++) = x;
  }
  return out.leftCols(count);
}

}  // namespace glisson::mechanics
