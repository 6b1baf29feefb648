// SPDX-License-Identifier: GPL-3.0-or-later

// Which solver a step takes, and what it needs before the first one.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/error.h"
#include "base/parallel.h"
#include "mechanics/static_solve.h"
#include "mechanics/step_solver.h"

namespace glisson::mechanics {
namespace {

constexpr int directSize = 6000;  ///< degrees of freedom that Auto factorises: every step uses the factor again
/// Iterations of block-Jacobi conjugate gradients from which the multigrid is taken; an estimate from the work of both.
constexpr double worthMultigrid = 45;
constexpr std::size_t chunk = 16384;

/// A's numbers in float.
LatticeOperator<float> inFloat(const LatticeOperator<double>& A) {
  LatticeOperator<float> F;
  F.lattice = A.lattice;
  for (std::size_t p = 0; p < 8; ++p) {
    std::transform(A.blocks.b[p].begin(), A.blocks.b[p].end(), F.blocks.b[p].begin(),
                   [](double v) { return static_cast<float>(v); });
    F.blocks.mass[p] = static_cast<float>(A.blocks.mass[p]);
  }
  F.E.assign(A.E.begin(), A.E.end());
  F.rho.assign(A.rho.begin(), A.rho.end());
  for (const auto& spring : A.springs) {
    auto& s = F.springs.emplace_back();
    s.slot = spring.slot;
    for (std::size_t v = 0; v < 6; ++v) s.k[v] = static_cast<float>(spring.k[v]);
  }
  F.fixed = A.fixed;
  return F;
}

}  // namespace

/// Applies the inverse 3 × 3 diagonal blocks, stored as six arrays of node slots (xx xy xz yy yz zz).
template <class T>
PreconditioningOf<T> StepSolver::blockJacobi() const {
  // The diagonal of a box's consistent mass is 8/27 of its row sum.
  const Eigen::VectorXd mass_kg = (8.0 / 27.0) * voxels_->lumpedMass_kg();
  const std::vector<Eigen::Matrix3d> blocks = voxels_->blockDiagonals();
  const std::size_t n = A_.lattice->nodeSlots();
  std::vector<T> inverse(6 * n, T{0});
  for (std::size_t at = 0; at < blocks.size(); ++at) {
    const auto node = static_cast<int>(at);
    Eigen::Matrix3d D = k_ * blocks[at] + m_ * mass_kg[node] * Eigen::Matrix3d::Identity();
    for (int c = 0; c < 3; ++c)
      if (voxels_->isFixed(node, c)) {
        D.row(c).setZero();
        D.col(c).setZero();
        D(c, c) = 1.0;
      }
    D = D.inverse().eval();
    for (int c = 0; c < 3; ++c)
      if (voxels_->isFixed(node, c)) D(c, c) = 0.0;
    T* to = inverse.data() + voxels_->slotOfNode(node);
    for (const double value : {D(0, 0), D(0, 1), D(0, 2), D(1, 1), D(1, 2), D(2, 2)}) {
      *to = static_cast<T>(value);
      to += n;
    }
  }
  return [n, inverse = std::move(inverse)](const std::vector<T>& r, std::vector<T>& z) {
    parallelChunks(n, chunk / 4,
                   [n, D = inverse.data(), in = r.data(), out = z.data()](std::size_t begin, std::size_t end) {
                     for (std::size_t s = begin; s < end; ++s) {
                       const T x = in[s], y = in[n + s], w = in[2 * n + s];
                       out[s] = D[s] * x + D[n + s] * y + D[2 * n + s] * w;
                       out[n + s] = D[n + s] * x + D[3 * n + s] * y + D[4 * n + s] * w;
                       out[2 * n + s] = D[2 * n + s] * x + D[4 * n + s] * y + D[5 * n + s] * w;
                     }
                   });
  };
}

template PreconditioningOf<double> StepSolver::blockJacobi<double>() const;

NodalField StepSolver::diagonal() const {
  const Eigen::VectorXd mass_kg = (8.0 / 27.0) * voxels_->lumpedMass_kg();
  NodalField d = k_ * voxels_->diagonal();
  d.rowwise() += m_ * mass_kg.transpose();
  return d;
}

Preconditioning StepSolver::jacobi() const {
  NodalField inverse = diagonal().cwiseInverse();
  voxels_->project(inverse);
  std::vector<double> slots(A_.size());
  voxels_->toSlots(inverse, slots.data());
  return [slots = std::move(slots)](const std::vector<double>& r, std::vector<double>& z) {
    parallelChunks(r.size(), chunk,
                   [D = slots.data(), in = r.data(), out = z.data()](std::size_t begin, std::size_t end) {
                     for (std::size_t i = begin; i < end; ++i) out[i] = D[i] * in[i];
                   });
  };
}

/// Iterations that block-Jacobi conjugate gradients are expected to need.
double StepSolver::expectedIterations() const {
  // Smooth motions weigh m · (row sum of M) against a diagonal k K + m M; the largest eigenvalue is about 3.
  const double sum = voxels_->diagonal().row(0).sum();
  const double mass = voxels_->lumpedMass_kg().sum();
  const double kappa = 3 * (k_ * sum + m_ * mass * 8.0 / 27.0) / (m_ * mass);
  return 0.5 * std::sqrt(kappa) * std::log(2 / options_.tolerance);
}

void StepSolver::makeFactor() {
  factor_ = std::make_unique<Factorisation>(A_, voxels_->K0(), hexMass(voxels_->body().h_m));
  kind_ = "factorised";
}

void StepSolver::makeMultigrid() {
  multigrid_ = std::make_unique<Multigrid>(*voxels_, MultigridOptions::forPoisson(voxels_->body().poisson),
                                           MultigridMatrix{k_, m_});
  A32_ = inFloat(A_);
  kind_ = "multigrid-pcg";
}

void StepSolver::choose() {
  const int dofs = voxels_->dofs() - voxels_->fixedCount();
  std::ostringstream note;
  note << "auto, " << dofs << " degrees of freedom: ";
  if (dofs <= directSize) {
    makeFactor();
    note << "small enough to factorise once for all steps";
  } else {
    const double iterations = expectedIterations();
    note << "the step's mass leaves about " << std::ceil(iterations) << " iterations to block-Jacobi";
    if (iterations > worthMultigrid && k_ > 0) {
      note << ", more than multigrid costs";
      makeMultigrid();
    } else {
      A32_ = inFloat(A_);
      M32_ = blockJacobi<float>();
      kind_ = "block-jacobi-cg";
    }
  }
  why_ = note.str();
}

void StepSolver::prepare(double m, double k) {
  m_ = m;
  k_ = k;
  A_ = voxels_->implicitLattice(m, k);
  M_ = nullptr;
  M32_ = nullptr;
  multigrid_.reset();
  factor_.reset();
  history_.clear();
  why_ = "asked for";
  switch (options_.kind) {
    case SolverKind::Auto: choose(); return;
    case SolverKind::Factorised:
      if (const int dofs = voxels_->dofs() - voxels_->fixedCount(); dofs > StaticSolver::factorisedLimit)
        throw BadInput("the factorised solver was asked for with " + std::to_string(dofs) +
                       " degrees of freedom; it is offered up to " + std::to_string(StaticSolver::factorisedLimit) +
                       ": use multigrid or auto, or larger cells");
      makeFactor();
      return;
    case SolverKind::Multigrid: makeMultigrid(); return;
    case SolverKind::Cg: break;
  }
  switch (options_.preconditioner) {
    case Preconditioner::Jacobi:
      kind_ = "jacobi-cg";
      M_ = jacobi();
      return;
    case Preconditioner::BlockJacobi:
      kind_ = "block-jacobi-cg";
      M_ = blockJacobi<double>();
      return;
    case Preconditioner::None: break;
  }
  kind_ = "cg";
  M_ = [](const std::vector<double>& r, std::vector<double>& z) { z = r; };
}

}  // namespace glisson::mechanics
