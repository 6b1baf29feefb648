// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/step_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "base/error.h"
#include "base/parallel.h"
#include "mechanics/static_solve.h"

namespace glisson::mechanics {
namespace {

constexpr int ownLimit = 2000;           ///< conjugate gradients without a limit of the options
constexpr int ownMultigridLimit = 1000;  ///< likewise, with the multigrid
constexpr int fallBackLimit = 100;       ///< multigrid iterations of a step before Auto falls back
/// Tolerance of a step that Auto iterates on where nobody asked for one, in units of the usual one: what steps leave
/// does not add up. The end of a motion solved to 1e-6 a step differs by 1e-8 to 1e-7 from one solved to 1e-12, and by
/// 1e-2 from one of half the step.
constexpr double stepTolerance = 100;
constexpr double floatReduction = 1e-4;  ///< of the residual by one correction in float
constexpr double floatMargin = 0.7;      ///< what its recursion aims at, of the goal
constexpr std::size_t chunk = 16384;

}  // namespace

struct StepSolver::Run {
  const std::vector<double>& b;
  std::vector<double>& x;
  SolveReport report;
  double bNorm = 0, rNorm = 0, goal = 0;
};

StepSolver::StepSolver(std::shared_ptr<const VoxelOperator> voxels, const SolverOptions& options)
    : voxels_(std::move(voxels)), options_(options) {}

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
  o.flexible = flexible;
  // The residual is that of x itself: the one that the iterations carry along goes on falling below rounding.
  for (int spent = 0; spent < limit;) {
    o.limit = limit - spent;
    o.tolerance = std::min(0.5, run.goal / run.rNorm);
    const double before = run.rNorm;
    const KrylovResult result = conjugateGradients<double, Z>(A_, r_, d_, M, o, {});
    parallelChunks(d_.size(), chunk, [x = run.x.data(), d = d_.data()](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) x[i] += d[i];
    });
    spent += result.iterations;
    report.iterations += result.iterations;
    report.status = result.status;
    run.rNorm = residual(run);
    report.status = run.rNorm <= run.goal                     ? SolveStatus::Converged
                    : result.status == SolveStatus::Converged ? SolveStatus::StoppedAtLimit
                                                              : result.status;
    if (result.status != SolveStatus::Converged || run.rNorm <= run.goal || !(run.rNorm < 0.5 * before)) break;
  }
}

/// A step that rounding alone keeps from its goal has converged.
bool StepSolver::acceptRounding(Run& run) const {
  SolveReport& report = run.report;
  if (report.status != SolveStatus::StoppedAtLimit) return false;
  NodalField forces;
  voxels_->fromSlots(run.x.data(), forces);
  forces = forces.cwiseProduct(diagonal()).eval();
  voxels_->project(forces);
  const double floor = 4 * std::numeric_limits<double>::epsilon() * forces.norm() / run.bNorm;
  if (!(run.rNorm <= floor * run.bNorm)) return false;
  std::ostringstream note;
  note << "; the residual reached the rounding of double precision, " << floor << ", above the tolerance asked for";
  report.why += note.str();
  report.tolerance = floor;
  report.status = SolveStatus::Converged;
  return true;
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
  if (report.status == SolveStatus::Converged || acceptRounding(run) || !mayFallBack) return;
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
  const bool ownChoice = options_.kind == SolverKind::Auto && !factor_ && !options_.keepsTolerance();
  report.tolerance = ownChoice ? stepTolerance * options_.tolerance : options_.tolerance;
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
  acceptRounding(run);
  remember(run);
  return report;
}

}  // namespace glisson::mechanics
