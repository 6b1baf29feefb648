#include <Eigen/LU>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
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
  if (factor_) return factor_->solve(apply, b, x, options_.tolerance, options_.tolerance);
  return conjugateGradients(apply, preconditioner_, b, x, options_.iterations > 0 ? options_.iterations : ownLimit,
                            options_.tolerance);
}

VoxelSystem::VoxelSystem(std::shared_ptr<const VoxelOperator> voxels, const SolverOptions& options)
    : voxels_(std::move(voxels)), options_(options) {
  if (options_.kind == SolverKind::Auto || options_.kind == SolverKind::Factorised ||
      options_.kind == SolverKind::Multigrid)
    options_.preconditioner = Preconditioner::BlockJacobi;
}

void VoxelSystem::applyK(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  const NodalField u = Eigen::Map<const NodalField>(x.data(), 3, x.size() / 3);
  NodalField f;
  voxels_->apply(u, f);
  y = Eigen::Map<const Eigen::VectorXd>(f.data(), f.size());
}

void VoxelSystem::applyM(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  NodalField f = voxels_->applyMass(Eigen::Map<const NodalField>(x.data(), 3, x.size() / 3));
  voxels_->project(f);
  y = Eigen::Map<const Eigen::VectorXd>(f.data(), f.size());
}

void VoxelSystem::prepare(double m, double k) {
  m_ = m, k_ = k;
  preconditioner_ = nullptr;
  if (options_.preconditioner == Preconditioner::None) return;
  // The diagonal of a box's consistent mass is 8/27 of its row sum.
  const Eigen::VectorXd mass_kg = (8.0 / 27.0) * voxels_->lumpedMass_kg();
  if (options_.preconditioner == Preconditioner::Jacobi) {
    NodalField inverse = k * voxels_->diagonal();
    inverse.rowwise() += m * mass_kg.transpose();
    inverse = inverse.cwiseInverse().eval();
    voxels_->project(inverse);
    const Eigen::VectorXd diagonal = Eigen::Map<const Eigen::VectorXd>(inverse.data(), inverse.size());
    preconditioner_ = [diagonal](const Eigen::VectorXd& r, Eigen::VectorXd& z) { z = diagonal.cwiseProduct(r); };
    return;
  }
  std::vector<Eigen::Matrix3d> blocks = voxels_->blockDiagonals();
  for (std::size_t n = 0; n < blocks.size(); ++n) {
    const auto node = static_cast<int>(n);
    Eigen::Matrix3d A = k * blocks[n] + m * mass_kg[node] * Eigen::Matrix3d::Identity();
    for (int c = 0; c < 3; ++c)
      if (voxels_->isFixed(node, c)) {
        A.row(c).setZero();
        A.col(c).setZero();
        A(c, c) = 1.0;
      }
    blocks[n] = A.inverse();
    for (int c = 0; c < 3; ++c)
      if (voxels_->isFixed(node, c)) blocks[n](c, c) = 0.0;
  }
  preconditioner_ = [blocks = std::move(blocks)](const Eigen::VectorXd& r, Eigen::VectorXd& z) {
    parallelChunks(blocks.size(), 8192, [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) {
        const auto at = static_cast<Eigen::Index>(3 * n);
        z.segment<3>(at) = blocks[n] * r.segment<3>(at);
      }
    });
  };
}

SolveReport VoxelSystem::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const {
  Eigen::VectorXd Kx(b.size());
  const VectorMap apply = [&](const Eigen::VectorXd& from, Eigen::VectorXd& to) {
    applyK(from, Kx);
    applyM(from, to);
    to = m_ * to + k_ * Kx;
  };
  return conjugateGradients(apply, preconditioner_, b, x, options_.iterations > 0 ? options_.iterations : ownLimit,
                            options_.tolerance);
}

}  // namespace glisson::mechanics
