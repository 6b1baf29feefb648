// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/step_solver.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/error.h"
#include "base/parallel.h"
#include "mechanics/static_solve.h"

namespace glisson::mechanics {
namespace {

constexpr int ownLimit = 2000;           ///< conjugate gradients without a limit of the options
constexpr int ownMultigridLimit = 1000;  ///< likewise, with the multigrid
constexpr int fallBackLimit = 100;       ///< multigrid iterations of a step before Auto falls back
constexpr int directSize = 6000;         ///< degrees of freedom that Auto factorises: every step uses the factor again
/// Tolerance of a step that Auto iterates on, in units of the one asked for: what steps leave does not add up. The end
/// of a motion solved to 1e-6 a step differs by 1e-8 to 1e-7 from one solved to 1e-12, and by 1e-2 from one of half the
/// step.
constexpr double stepTolerance = 100;
constexpr double floatReduction = 1e-4;  ///< of the residual by one correction in float
constexpr double floatMargin = 0.7;      ///< what its recursion aims at, of the goal
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

struct StepSolver::Run {
  const std::vector<double>& b;
  std::vector<double>& x;
  SolveReport report;
  double bNorm = 0, rNorm = 0, goal = 0;
};

StepSolver::StepSolver(std::shared_ptr<const VoxelOperator> voxels, const SolverOptions& options)
    : voxels_(std::move(voxels)), options_(options) {}

// ---------------------------------------------------------------- preparing

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

Preconditioning StepSolver::jacobi() const {
  const Eigen::VectorXd mass_kg = (8.0 / 27.0) * voxels_->lumpedMass_kg();
  NodalField inverse = k_ * voxels_->diagonal();
  inverse.rowwise() += m_ * mass_kg.transpose();
  inverse = inverse.cwiseInverse().eval();
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

// ---------------------------------------------------------------- solving

/// Makes r_ = b − A x; returns its norm.
double StepSolver::residual(const Run& run) {
  r_.resize(run.b.size());
  A_.apply(run.x.data(), r_.data());
  parallelChunks(r_.size(), chunk, [b = run.b.data(), r = r_.data()](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) r[i] = b[i] - r[i];
  });
  return norm(r_);
}

void StepSolver::begin(Run& run) {
  if (!history_.empty()) {
    history_.start(run.b, run.x, r_);
    run.rNorm = norm(r_);
  } else {
    if (run.x.size() == run.b.size())
      A_.project(run.x.data());
    else
      run.x.assign(run.b.size(), 0.0);
    run.rNorm = residual(run);
  }
  if (run.rNorm > run.bNorm) {
    // Worse than none.
    history_.clear();
    run.x.assign(run.b.size(), 0.0);
    r_ = run.b;
    run.rNorm = run.bNorm;
  }
  if (history_.empty()) {
    start_.assign(run.b.size(), 0.0);
    first_ = run.b;
  } else {
    start_ = run.x;
    first_ = r_;
  }
}

/// Gives the history what was solved beyond the start; r_ is the residual that is left.
void StepSolver::remember(const Run& run) {
  if (factor_ || run.report.status != SolveStatus::Converged) return;
  parallelChunks(
      start_.size(), chunk,
      [x = run.x.data(), r = r_.data(), e = start_.data(), Ae = first_.data()](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          e[i] = x[i] - e[i];
          Ae[i] -= r[i];
        }
      });
  history_.add(start_, first_);
}

/// Corrections in float, each from the true residual, until the goal, the limit, or one that does not halve it.
void StepSolver::refineInFloat(Run& run, const PreconditioningOf<float>& M, int limit, bool flexible) {
  const std::size_t n = run.b.size();
  std::vector<float> r(n), d;
  const auto correct = [&](double by) {
    parallelChunks(n, chunk, [by, x = run.x.data(), c = d.data()](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) x[i] += by * static_cast<double>(c[i]);
    });
  };
  SolveReport& report = run.report;
  while (true) {
    report.status = run.rNorm <= run.goal ? SolveStatus::Converged : SolveStatus::StoppedAtLimit;
    if (report.status == SolveStatus::Converged || report.iterations >= limit) return;
    const double before = run.rNorm;
    parallelChunks(n, chunk, [by = 1 / before, from = r_.data(), to = r.data()](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) to[i] = static_cast<float>(by * from[i]);
    });
    KrylovOptions o;
    o.limit = limit - report.iterations;
    o.tolerance = std::max(floatReduction, floatMargin * run.goal / before);
    o.flexible = flexible;
    o.recursive = true;
    const KrylovResult result = conjugateGradients(A32_, r, d, M, o, {});
    report.iterations += result.iterations;
    correct(before);
    run.rNorm = residual(run);
    if (run.rNorm < 0.5 * before) continue;
    report.status = result.status == SolveStatus::Converged ? SolveStatus::StoppedAtLimit : result.status;
    if (run.rNorm < before) return;
    if (std::isfinite(run.rNorm))
      correct(-before);
    else
      run.x = start_;
    run.rNorm = residual(run);
    return;
  }
}

template <class Z>
void StepSolver::iterateInDouble(Run& run, const PreconditioningOf<double, Z>& M, int limit, bool flexible) {
  SolveReport& report = run.report;
  if (run.rNorm <= run.goal) {
    report.status = SolveStatus::Converged;
    return;
  }
  KrylovOptions o;
  o.limit = limit;
  o.tolerance = std::min(0.5, run.goal / run.rNorm);
  o.flexible = flexible;
  const double before = run.rNorm;
  const KrylovResult result = conjugateGradients<double, Z>(A_, r_, d_, M, o, {});
  parallelChunks(d_.size(), chunk, [x = run.x.data(), d = d_.data()](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) x[i] += d[i];
  });
  report.status = result.status;
  report.iterations += result.iterations;
  residual(run);
  run.rNorm = before * result.residual;
}

void StepSolver::byMultigrid(Run& run) {
  SolveReport& report = run.report;
  const bool mayFallBack = options_.kind == SolverKind::Auto && options_.iterations == 0;
  const int limit = options_.iterations > 0 ? options_.iterations : mayFallBack ? fallBackLimit : ownMultigridLimit;
  refineInFloat(
      run, [this](const std::vector<float>& r, std::vector<float>& z) { multigrid_->cycle(r, z); }, limit, true);
  const PreconditioningOf<double, float> cycle = [this](const std::vector<double>& r, std::vector<float>& z) {
    multigrid_->cycle(r, z);
  };
  for (int attempt = 0; attempt < 2; ++attempt) {
    if (report.status == SolveStatus::Converged || report.iterations >= limit) break;
    if (report.status == SolveStatus::Indefinite && !multigrid_->boundByCells() && attempt > 0) break;
    iterateInDouble(run, cycle, limit - report.iterations, true);
  }
  if (report.status == SolveStatus::Converged || !mayFallBack) return;
  multigrid_.reset();
  M_ = blockJacobi<double>();
  const SolveStatus reason = report.status;
  const int spent = report.iterations;
  kind_ = report.kind = "block-jacobi-cg";
  why_ = report.why += ", but multigrid " + describe(reason) + "; block-Jacobi conjugate gradients";
  iterateInDouble(run, M_, ownLimit, false);
  report.diagnostics.add(DiagnosticCode::SolverFellBack, {{"reason", describe(reason)},
                                                          {"spent", std::int64_t{spent}},
                                                          {"solver", kind_},
                                                          {"iterations", std::int64_t{report.iterations - spent}}});
}

void StepSolver::byFactor(Run& run) {
  // From nothing: the factor is as good without an earlier solution.
  run.x.assign(run.b.size(), 0.0);
  r_ = run.b;
  run.rNorm = run.bNorm;
  d_.resize(run.b.size());
  do {
    factor_->solve(r_.data(), d_.data());
    for (std::size_t i = 0; i < d_.size(); ++i) run.x[i] += d_[i];
    const double before = run.rNorm;
    run.rNorm = residual(run);
    ++run.report.iterations;
    if (!(run.rNorm < 0.5 * before)) break;
  } while (run.rNorm > run.goal);
  run.report.status = run.rNorm <= run.goal ? SolveStatus::Converged : SolveStatus::StoppedAtLimit;
}

SolveReport StepSolver::solve(std::vector<double>& b, std::vector<double>& x) {
  Run run{b, x, {}};
  SolveReport& report = run.report;
  report.kind = kind_;
  report.why = why_;
  const bool ownChoice = options_.kind == SolverKind::Auto && !factor_;
  report.tolerance = ownChoice ? std::min(0.01, stepTolerance * options_.tolerance) : options_.tolerance;
  A_.project(b.data());
  run.bNorm = norm(b);
  run.goal = report.tolerance * run.bNorm;
  if (run.bNorm == 0) {
    x.assign(b.size(), 0.0);
    report.status = SolveStatus::Converged;
    return report;
  }
  const int limit = options_.iterations > 0 ? options_.iterations : ownLimit;
  if (!factor_) begin(run);
  if (!std::isfinite(run.bNorm + run.rNorm)) {
    report.status = SolveStatus::NotFinite;
  } else if (factor_) {
    byFactor(run);
  } else if (multigrid_) {
    byMultigrid(run);
  } else {
    if (M32_) refineInFloat(run, M32_, limit, false);
    if (M32_ && report.status != SolveStatus::Converged && !M_) M_ = blockJacobi<double>();
    if (report.status != SolveStatus::Converged && report.iterations < limit)
      iterateInDouble(run, M_, limit - report.iterations, false);
  }
  report.residual = run.rNorm / run.bNorm;
  if (!std::isfinite(report.residual)) report.status = SolveStatus::NotFinite;
  remember(run);
  return report;
}

}  // namespace glisson::mechanics
