// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/static_solve.h"

#include <Eigen/LU>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <sstream>

#include "base/error.h"
#include "base/parallel.h"
#include "mechanics/factorisation.h"
#include "mechanics/krylov.h"
#include "mechanics/multigrid.h"
#include "mechanics/supports.h"

namespace glisson::mechanics {

namespace {

// Crossovers as tests/benchmark measures them: a factor costs what 8 multigrid solves do at 1,700 degrees of freedom,
// what 30 do at 4,400, and its solves are no quicker from 8,000 on.
constexpr int directSize = 1500;        ///< degrees of freedom that are factorised at once
constexpr int manyLoadsSize = 6000;     ///< degrees of freedom that are factorised once many loads have come
constexpr int manyLoads = 8;            ///< loads solved by iteration before that
constexpr double hardContrast = 1e3;    ///< of moduli, where multigrid by mean moduli begins to slow down
constexpr double hardPoisson = 0.495;   ///< likewise
constexpr int hardSize = 30000;         ///< degrees of freedom up to which a factor is worth its second and its 300 MB
constexpr int multigridLimit = 1000;    ///< iterations before Auto falls back
constexpr int slowIterations = 45;      ///< multigrid iterations in all from which a larger coarsest level pays
constexpr int slowerIterations = 60;    ///< with it, those from which the smoother is lengthened
constexpr int wantedIterations = 40;    ///< what that aims at
constexpr int largerCoarsest = 8000;    ///< degrees of freedom
constexpr double longPoisson = 0.4925;  ///< from which the smoother is long from the start (MultigridOptions)

}  // namespace

struct StaticSolver::State {
  VoxelOperator op;
  SolverOptions options;
  std::vector<double> inverseDiagonal;         ///< slots, 0 where fixed or no node
  std::vector<Eigen::Matrix3d> inverseBlocks;  ///< per node, 0 rows and columns where fixed

  State(const VoxelBody& body, const Supports& supports, const SolverOptions& o)
      : op(body, o.element, supports), options(o) {}

  void prepareJacobi() {
    if (!inverseDiagonal.empty()) return;
    const NodalField d = op.diagonal();
    NodalField inverse = d.cwiseInverse();
    op.project(inverse);
    inverseDiagonal.resize(op.lattice().size());
    op.toSlots(inverse, inverseDiagonal.data());
  }

  void prepareBlocks() {
    if (!inverseBlocks.empty()) return;
    inverseBlocks = op.blockDiagonals();
    for (int node = 0; node < op.mesh().nodeCount(); ++node) {
      Eigen::Matrix3d& B = inverseBlocks[static_cast<std::size_t>(node)];
      for (int c = 0; c < 3; ++c)
        if (op.isFixed(node, c)) {
          B.row(c).setZero();
          B.col(c).setZero();
          B(c, c) = 1;
        }
      B = B.inverse().eval();
      for (int c = 0; c < 3; ++c)
        if (op.isFixed(node, c)) B(c, c) = 0;
    }
  }

  Preconditioning preconditioning(Preconditioner kind) {
    if (kind == Preconditioner::Jacobi) {
      prepareJacobi();
      return [this](const std::vector<double>& r, std::vector<double>& z) {
        parallelChunks(r.size(), 16384, [&](std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) z[i] = inverseDiagonal[i] * r[i];
        });
      };
    }
    if (kind == Preconditioner::BlockJacobi) {
      prepareBlocks();
      return [this](const std::vector<double>& r, std::vector<double>& z) {
        const std::size_t n = op.lattice().lattice->nodeSlots();
        std::fill(z.begin(), z.end(), 0.0);
        parallelChunks(inverseBlocks.size(), 8192, [&](std::size_t begin, std::size_t end) {
          for (std::size_t node = begin; node < end; ++node) {
            const std::size_t s = op.slotOfNode(static_cast<int>(node));
            const Eigen::Vector3d v = inverseBlocks[node] * Eigen::Vector3d(r[s], r[n + s], r[2 * n + s]);
            for (std::size_t c = 0; c < 3; ++c) z[c * n + s] = v[static_cast<Eigen::Index>(c)];
          }
        });
      };
    }
    return [](const std::vector<double>& r, std::vector<double>& z) { z = r; };
  }

  int ownLimit() const {
    if (options.iterations > 0) return options.iterations;
    return std::clamp(op.dofs(), 1000, 20000);
  }

  std::unique_ptr<Multigrid> multigrid;   ///< made when first needed
  bool multigridFailed = false;           ///< then Auto does not try again
  bool strengthened = false;              ///< the multigrid has the larger coarsest level, if there is one
  int loads = 0;                          ///< solved so far
  std::unique_ptr<Factorisation> factor;  ///< likewise

  /// Makes a slow multigrid quicker, first by a larger coarsest level: mean moduli are poorest on the coarsest ones,
  /// whose cells mix stiff and soft parts. False where there is nothing left to try.
  bool strengthen(int expected) {
    if (!strengthened) {
      strengthened = true;
      const int levels = multigrid->levels();
      MultigridOptions strong = MultigridOptions::forPoisson(op.body().poisson);
      strong.coarsestDofs = largerCoarsest;
      multigrid.reset();
      multigrid = std::make_unique<Multigrid>(op, strong);
      if (multigrid->levels() < levels) return true;
    }
    if (expected <= slowerIterations) return false;
    return multigrid->lengthen(static_cast<double>(expected) / wantedIterations);
  }

  KrylovResult runMultigrid(const std::vector<double>& b, std::vector<double>& x, int limit, const Progress& progress) {
    if (!multigrid) multigrid = std::make_unique<Multigrid>(op, MultigridOptions::forPoisson(op.body().poisson));
    KrylovOptions k;
    k.limit = options.iterations > 0 ? options.iterations : limit;
    k.tolerance = options.tolerance;
    k.flexible = true;
    k.energyToo = true;
    // Beyond that ratio the volume is what is slow, which neither mends, and a new start costs iterations.
    if (op.body().poisson <= longPoisson)
      k.slow = [this](int expected) { return expected > slowIterations && strengthen(expected); };
    const PreconditioningOf<double, float> cycle = [this](const std::vector<double>& r, std::vector<float>& z) {
      multigrid->cycle(r, z);
    };
    KrylovResult result = conjugateGradients<double, float>(op.lattice(), b, x, cycle, k, progress);
    if (result.status == SolveStatus::Indefinite && multigrid->boundByCells()) {
      const int spent = result.iterations;
      result = conjugateGradients<double, float>(op.lattice(), b, x, cycle, k, progress);
      result.iterations += spent;
    }
    return result;
  }

  /// Direct solve with refinement; the iterations are the corrections made.
  KrylovResult runFactorised(const std::vector<double>& b, std::vector<double>& x, const Progress& progress) {
    progress.report(0, "factorising");
    if (!factor) factor = std::make_unique<Factorisation>(op.lattice(), op.K0());
    std::vector<double> r = b;
    std::vector<double> d(b.size());
    const double bNorm = norm(b);
    KrylovResult result;
    x.assign(b.size(), 0.0);
    result.residual = 1;
    constexpr int corrections = 8;
    for (; result.iterations < corrections; ++result.iterations) {
      progress.check();
      factor->solve(r.data(), d.data());
      std::vector<double> better = x;
      for (std::size_t i = 0; i < x.size(); ++i) better[i] += d[i];
      op.lattice().apply(better.data(), d.data());
      for (std::size_t i = 0; i < x.size(); ++i) d[i] = b[i] - d[i];
      const double residual = norm(d) / bNorm;
      if (!std::isfinite(residual)) {
        result.status = SolveStatus::NotFinite;
        return result;
      }
      if (residual >= result.residual) break;
      const bool slow = residual > 0.5 * result.residual;
      result.residual = residual;
      x.swap(better);
      r.swap(d);
      // One correction more than the tolerance asks is cheap and takes the error of a badly conditioned body away.
      if (slow || residual < 1e-15) break;
    }
    result.status = result.residual <= options.tolerance ? SolveStatus::Converged : SolveStatus::StoppedAtLimit;
    return result;
  }

  KrylovResult runCg(Preconditioner kind, const std::vector<double>& b, std::vector<double>& x,
                     const Progress& progress) {
    KrylovOptions k;
    k.limit = ownLimit();
    k.tolerance = options.tolerance;
    return conjugateGradients(op.lattice(), b, x, preconditioning(kind), k, progress);
  }

  /// The load on the free degrees of freedom, that of prescribed displacements included, over its largest entry, which
  /// is returned.
  double rightSide(const NodalField& f_N, std::vector<double>& right) const;
  /// Where rounding alone leaves the residual that a solve ended with, it has converged.
  void acceptRounding(Solution& solution, double bNorm) const;
  KrylovResult run(const std::vector<double>& b, std::vector<double>& x, SolveReport& report, const Progress& progress);
  KrylovResult runAuto(const std::vector<double>& b, std::vector<double>& x, SolveReport& report,
                       const Progress& progress);
};

double StaticSolver::State::rightSide(const NodalField& f_N, std::vector<double>& right) const {
  const NodalField& lifted = op.prescribed_m();
  if ((lifted.array() != 0).any()) {
    op.toSlots(f_N + (op.springForce(lifted) - op.applyFree(lifted)), right.data());
  } else {
    op.toSlots(f_N, right.data());
  }
  op.lattice().project(right.data());
  double scale = 0;
  for (const double v : right) scale = std::max(scale, std::abs(v));
  if (scale > 0)
    for (double& v : right) v /= scale;
  return scale;
}

void StaticSolver::State::acceptRounding(Solution& solution, double bNorm) const {
  NodalField forces = op.diagonal().cwiseProduct(solution.u_m);
  op.project(forces);
  const double floor = 4 * std::numeric_limits<double>::epsilon() * forces.norm() / bNorm;
  SolveReport& report = solution.report;
  if (!(report.residual <= floor)) return;
  std::ostringstream note;
  note << "; the residual reached the rounding of double precision, " << floor << ", above the tolerance asked for";
  report.why += note.str();
  report.tolerance = floor;
  report.status = SolveStatus::Converged;
}

KrylovResult StaticSolver::State::run(const std::vector<double>& b, std::vector<double>& x, SolveReport& report,
                                      const Progress& progress) {
  switch (options.kind) {
    case SolverKind::Cg:
      report.kind = options.preconditioner == Preconditioner::None     ? "cg"
                    : options.preconditioner == Preconditioner::Jacobi ? "jacobi-cg"
                                                                       : "block-jacobi-cg";
      report.why = "asked for";
      return runCg(options.preconditioner, b, x, progress);
    case SolverKind::Factorised:
      report.kind = "factorised";
      report.why = "asked for";
      return runFactorised(b, x, progress);
    case SolverKind::Multigrid: {
      report.kind = "multigrid-pcg";
      const KrylovResult result = runMultigrid(b, x, 1000, progress);
      report.why = "asked for; degrees of freedom per level " + multigrid->describe();
      return result;
    }
    case SolverKind::Auto: break;
  }
  return runAuto(b, x, report, progress);
}

KrylovResult StaticSolver::State::runAuto(const std::vector<double>& b, std::vector<double>& x, SolveReport& report,
                                          const Progress& progress) {
  const int dofs = op.dofs() - op.fixedCount();
  double softest = 0;
  double stiffest = 0;
  for (const double E : op.body().E_Pa) {
    if (E == 0) continue;
    softest = softest == 0 ? E : std::min(softest, E);
    stiffest = std::max(stiffest, E);
  }
  const double contrast = stiffest / softest;
  std::ostringstream why;
  why << "auto, " << dofs << " degrees of freedom, moduli within a factor of " << contrast << ", Poisson's ratio "
      << op.body().poisson << ": ";
  const bool small = dofs <= directSize;
  const bool hard = contrast >= hardContrast || op.body().poisson >= hardPoisson;
  const bool many = dofs <= manyLoadsSize && loads >= manyLoads;
  ++loads;
  if (small || (hard && dofs <= hardSize) || many) {
    why << (small  ? "small enough to factorise at once"
            : hard ? "hard for iteration and small enough to factorise"
                   : "small, and so many loads that a factor pays");
    report.kind = "factorised";
    report.why = why.str();
    return runFactorised(b, x, progress);
  }
  KrylovResult result;
  int spent = 0;
  const bool failedBefore = multigridFailed;
  if (!failedBefore) {
    result = runMultigrid(b, x, multigridLimit, progress);
    spent = result.iterations;
    report.kind = "multigrid-pcg";
    if (dofs <= manyLoadsSize) why << "quicker by iteration until " << manyLoads << " loads have come, ";
    why << "multigrid (" << multigrid->describe() << ")";
    report.why = why.str();
    if (result.status == SolveStatus::Converged || options.iterations > 0) return result;
    multigridFailed = true;
  }
  if (failedBefore)
    why << "multigrid failed on an earlier load";
  else
    why << ", but multigrid " << describe(result.status) << " after " << spent << " iterations at residual "
        << result.residual;
  std::vector<double> y;
  KrylovResult second;
  if (dofs <= factorisedLimit) {
    why << "; factorised";
    report.kind = "factorised";
    second = runFactorised(b, y, progress);
  } else {
    why << "; block-Jacobi conjugate gradients";
    report.kind = "block-jacobi-cg";
    second = runCg(Preconditioner::BlockJacobi, b, y, progress);
  }
  report.why = why.str();
  report.diagnostics.add(DiagnosticCode::SolverFellBack,
                         {{"reason", failedBefore ? std::string("failed on an earlier load") : describe(result.status)},
                          {"spent", std::int64_t{spent}},
                          {"solver", report.kind},
                          {"iterations", std::int64_t{second.iterations}}});
  second.iterations += spent;
  // Where multigrid was not tried there is no other answer to fall back on.
  if (!failedBefore && !(second.residual < result.residual)) return result;
  x.swap(y);
  return second;
}

StaticSolver::StaticSolver(const VoxelBody& body, const Supports& supports, const SolverOptions& options,
                           const Progress&) {
  if (!(options.tolerance > 0 && options.tolerance < 1))
    throw BadArgument("the solver's tolerance must lie between 0 and 1");
  if (options.iterations < 0) throw BadArgument("the solver's iteration limit is negative");
  state_ = std::make_unique<State>(body, supports, options);
  requireSupported(state_->op.mesh(), supports);
  const int dofs = state_->op.dofs() - state_->op.fixedCount();
  if (options.kind == SolverKind::Factorised && dofs > factorisedLimit) {
    std::ostringstream what;
    what << "the factorised solver was asked for with " << dofs << " degrees of freedom; it would take about "
         << Factorisation::expectedBytes(dofs) / 1e9 << " GB. It is offered up to " << factorisedLimit
         << ": use multigrid or auto, or larger cells";
    throw BadInput(what.str());
  }
}
StaticSolver::~StaticSolver() = default;
StaticSolver::StaticSolver(StaticSolver&&) noexcept = default;
StaticSolver& StaticSolver::operator=(StaticSolver&&) noexcept = default;

const VoxelOperator& StaticSolver::voxels() const {
  return state_->op;
}

Solution StaticSolver::solve(const NodalField& f_N, const Progress& progress) {
  State& s = *state_;
  const auto start = std::chrono::steady_clock::now();
  const int nodes = s.op.mesh().nodeCount();
  if (f_N.cols() != nodes)
    throw BadArgument("the load has " + std::to_string(f_N.cols()) + " nodes, the mesh " + std::to_string(nodes));
  if (!f_N.allFinite()) throw BadInput("the load is not finite at some node");
  Solution solution;
  solution.report.tolerance = s.options.tolerance;
  std::vector<double> right(s.op.lattice().size());
  const double scale = s.rightSide(f_N, right);
  if (scale == 0) {
    solution.report.kind = "none";
    solution.report.why = "no load on a free degree of freedom";
    solution.report.status = SolveStatus::Converged;
    solution.u_m = s.op.prescribed_m();
  } else {
    std::vector<double> x;
    const KrylovResult result = s.run(right, x, solution.report, progress);
    solution.report.status = result.status;
    solution.report.iterations = result.iterations;
    solution.report.residual = result.residual;
    s.op.fromSlots(x.data(), solution.u_m);
    solution.u_m *= scale;
    solution.u_m += s.op.prescribed_m();
    if (result.status == SolveStatus::StoppedAtLimit) s.acceptRounding(solution, scale * norm(right));
  }
  right = {};
  const NodalField internal = s.op.applyFree(solution.u_m);
  const NodalField spring_N = s.op.springForce(solution.u_m);
  solution.energy_J = 0.5 * (solution.u_m.cwiseProduct(internal - spring_N)).sum();
  solution.reaction_N = reactionForces(s.op.fixed(), spring_N, internal - f_N);
  solution.report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return solution;
}

Solution solveStatic(const Problem& problem, const SolverOptions& options, const Progress& progress) {
  StaticSolver solver(problem.body, problem.supports, options, progress);
  return solver.solve(problem.f_N, progress);
}

std::string describe(SolveStatus status) {
  switch (status) {
    case SolveStatus::Converged: return "converged";
    case SolveStatus::StoppedAtLimit: return "stopped at the iteration limit";
    case SolveStatus::Indefinite: return "met a direction of no stiffness";
    case SolveStatus::NotFinite: return "met a number that is not finite";
  }
  return "unknown";
}

}  // namespace glisson::mechanics
