#include "mechanics/static_solve.h"

#include <Eigen/LU>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>

#include "base/error.h"
#include "base/parallel.h"
#include "mechanics/krylov.h"
#include "mechanics/supports.h"

namespace glisson::mechanics {

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

  KrylovResult runCg(Preconditioner kind, const std::vector<double>& b, std::vector<double>& x,
                     const Progress& progress) {
    KrylovOptions k;
    k.limit = ownLimit();
    k.tolerance = options.tolerance;
    return conjugateGradients(op.lattice(), b, x, preconditioning(kind), k, progress);
  }
};

StaticSolver::StaticSolver(const VoxelBody& body, const Supports& supports, const SolverOptions& options,
                           const Progress&) {
  if (!(options.tolerance > 0 && options.tolerance < 1))
    throw BadArgument("the solver's tolerance must lie between 0 and 1");
  if (options.iterations < 0) throw BadArgument("the solver's iteration limit is negative");
  state_ = std::make_unique<State>(body, supports, options);
  requireSupported(state_->op.mesh(), supports);
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
  NodalField b = f_N;
  const NodalField& lifted = s.op.prescribed_m();
  if ((lifted.array() != 0).any()) b += s.op.springForce(lifted) - s.op.applyFree(lifted);
  s.op.project(b);
  solution.u_m = lifted;
  const double scale = b.cwiseAbs().maxCoeff();
  if (scale == 0) {
    solution.report.kind = "none";
    solution.report.why = "no load on a free degree of freedom";
    solution.report.status = SolveStatus::Converged;
  } else {
    std::vector<double> right(s.op.lattice().size());
    std::vector<double> x;
    s.op.toSlots(b / scale, right.data());
    const KrylovResult result = s.runCg(s.options.preconditioner, right, x, progress);
    solution.report.kind = "cg";
    solution.report.status = result.status;
    solution.report.iterations = result.iterations;
    solution.report.residual = result.residual;
    NodalField w;
    s.op.fromSlots(x.data(), w);
    solution.u_m += scale * w;
  }
  const NodalField internal = s.op.applyFree(solution.u_m);
  const NodalField springs = s.op.springForce(solution.u_m);
  solution.reaction_N = springs;
  for (int node = 0; node < nodes; ++node)
    for (int c = 0; c < 3; ++c)
      if (s.op.isFixed(node, c)) solution.reaction_N(c, node) = internal(c, node) - f_N(c, node);
  solution.energy_J = 0.5 * (solution.u_m.cwiseProduct(internal - springs)).sum();
  solution.report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return solution;
}

Solution solveStatic(const Problem& problem, const SolverOptions& options, const Progress& progress) {
  StaticSolver solver(problem.body, problem.supports, options, progress);
  return solver.solve(problem.f_N, progress);
}

std::string describe(SolveStatus status) {
  switch (status) {
    case SolveStatus::Converged:
      return "converged";
    case SolveStatus::StoppedAtLimit:
      return "stopped at the iteration limit";
    case SolveStatus::Indefinite:
      return "met a direction of no stiffness";
    case SolveStatus::NotFinite:
      return "met a number that is not finite";
  }
  return "unknown";
}

}  // namespace glisson::mechanics
