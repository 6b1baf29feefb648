// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/newton_solve.h"

#include <chrono>
#include <cmath>
#include <limits>
#include <sstream>

#include "base/error.h"
#include "mechanics/detail/newton_tangent.h"
#include "mechanics/measures.h"
#include "mechanics/supports.h"

namespace glisson::mechanics {
namespace {

constexpr double smallestStep = 1.0 / 128;
constexpr double searchedStep = 0.25;  ///< steps up to this are tried with line search before they are halved
constexpr int iterationLimit = 200;    ///< of all steps
constexpr int plainLimit = 15;         ///< per step, full Newton steps
constexpr int searchLimit = 25;        ///< per step, with line search
constexpr int quick = 8;               ///< iterations after which the next step may grow
constexpr int wastedLimit = 60;        ///< iterations of attempts that failed
constexpr int stalledPlain = 4;        ///< iterations in a row that fail to halve the residual: given up
constexpr int stalledSearch = 8;       ///< likewise with line search

struct Newton {
  LargeDeformationModel model;
  TangentSolver tangents;
  double tolerance;
  Eigen::VectorXd f, prescribed, stiffness;  ///< load, prescribed displacements, diagonal of the undeformed stiffness
  bool moves = false;                        ///< some prescribed displacement is not 0
  int iterations = 0;
  int wasted = 0;  ///< iterations of attempts that failed
  bool atRounding = false;
  const Progress& progress;
  double from = 0, to = 1;  ///< load fractions of the present step

  Newton(const Problem& problem, LargeDeformationKind kind, const SolverOptions& options, const Progress& p)
      : model(problem, kind, options.element),
        tangents(model, options),
        tolerance(options.tolerance),
        f(problem.f_N.reshaped()),
        prescribed(model.op().prescribed_m().reshaped()),
        stiffness(model.op().diagonal().reshaped()),
        moves((prescribed.array() != 0).any()),
        progress(p) {}

  Eigen::VectorXd onFree(const Eigen::VectorXd& v) const {
    return model.held().reshaped().select(0.0, v.array()).matrix();
  }
  /// Residual forces on the free degrees of freedom.
  Eigen::VectorXd residual(double t, const Eigen::VectorXd& force) const { return onFree(t * f - force); }
  /// Norm that scales the residual.
  double reference(double t, const Eigen::VectorXd& force) const {
    const double load = (t * onFree(f)).norm();
    return moves ? std::hypot(load, (force - onFree(force)).norm()) : load;
  }
  double floor(const Eigen::VectorXd& u) const {
    return 4 * std::numeric_limits<double>::epsilon() * onFree(stiffness.cwiseProduct(u)).norm();
  }
  double potential(double t, double energy, const Eigen::VectorXd& u) const { return energy - t * f.dot(u); }

  /// Equilibrium at load fraction t from u. False: u is of no use.
  bool step(double t, Eigen::VectorXd& u, bool search);
  /// A step may end in an equilibrium of folded cells, far from the body's own path.
  bool folded(const Eigen::VectorXd& u) const {
    return summarise(model.op().mesh(), u.reshaped(3, u.size() / 3)).invertedCells > 0;
  }
  /// Moves u along du; false where no length of the step is good.
  bool searchAlong(double t, Eigen::VectorXd& u, const Eigen::VectorXd& du, double potential0,
                   const Eigen::VectorXd& r);
  bool run(Eigen::VectorXd& u, double& reached, int& steps);
};

bool Newton::searchAlong(double t, Eigen::VectorXd& u, const Eigen::VectorXd& du, double potential0,
                         const Eigen::VectorXd& r) {
  const double slope = r.dot(du);
  if (!(slope > 0)) return false;
  double energy = 0;
  Eigen::VectorXd force;
  for (double alpha = 1; alpha > 0.01; alpha *= 0.5) {
    const Eigen::VectorXd next = u + alpha * du;
    if (!model.evaluate(next, Tangent::None, energy, force)) continue;
    if (potential(t, energy, next) <= potential0 - 1e-4 * alpha * slope ||
        residual(t, force).norm() <= (1 - 1e-2 * alpha) * r.norm()) {
      u = next;
      return true;
    }
  }
  return false;
}

bool Newton::step(double t, Eigen::VectorXd& u, bool search) {
  double energy = 0;
  Eigen::VectorXd force;
  Eigen::VectorXd du;
  double last = 0;
  int stalled = 0;
  for (int iteration = 0; iteration <= (search ? searchLimit : plainLimit); ++iteration) {
    progress.check();
    if (iterations >= iterationLimit || !model.evaluate(u, Tangent::Exact, energy, force)) return false;
    Eigen::VectorXd r = residual(t, force);
    const double size = r.norm();
    const double unit = reference(t, force);
    if (!std::isfinite(size) || (iteration > 3 && size > 1e6 * unit)) return false;
    const bool arriving = moves && iteration == 0;  // prescribed displacements are still at the last step's
    if (!arriving) {
      if (size <= tolerance * unit) return !folded(u);
      if (iteration > 2 && size <= floor(u)) {
        atRounding = true;
        return !folded(u);
      }
    }
    stalled = iteration > 0 && size > 0.5 * last ? stalled + 1 : 0;
    last = size;
    if (stalled >= (search ? stalledSearch : stalledPlain)) return false;
    std::ostringstream what;
    what << "load " << static_cast<int>(100 * t) << " %, Newton iteration " << iteration + 1;
    progress.report(from + (to - from) * iteration / (searchLimit + 1.0), what.str());
    Eigen::VectorXd jump = Eigen::VectorXd::Zero(u.size());
    if (arriving) {
      jump = model.held().reshaped().select((t * prescribed - u).array(), 0.0).matrix();
      Eigen::VectorXd pull;
      model.tangent().apply(jump, pull);
      r -= onFree(pull);
    }
    ++iterations;
    bool solved = tangents.solve(r, du, progress);
    if (!solved && search && model.evaluate(u, Tangent::Positive, energy, force))
      solved = tangents.solve(r, du, progress);
    if (!solved) return false;
    if (search && !arriving) {
      if (!searchAlong(t, u, du, potential(t, energy, u), r)) return false;
    } else {
      u += du + jump;
    }
  }
  return false;
}

bool Newton::run(Eigen::VectorXd& u, double& reached, int& steps) {
  double size = 1;
  while (reached < 1) {
    const double target = std::min(1.0, reached + size);
    from = reached;
    to = target;
    int before = iterations;
    Eigen::VectorXd trial = u;
    bool good = step(target, trial, false);
    if (!good) wasted += iterations - before;
    if (!good && size <= searchedStep && wasted < wastedLimit) {
      trial = u;
      before = iterations;
      good = step(target, trial, true);
      if (!good) wasted += iterations - before;
    }
    if (good) {
      u = trial;
      reached = target;
      ++steps;
      if (iterations - before <= quick) size *= 2;
    } else {
      size /= 2;
      if (size < smallestStep || iterations >= iterationLimit || wasted >= wastedLimit) return false;
    }
  }
  return true;
}

}  // namespace

Solution solveLargeDeformation(const Problem& problem, LargeDeformationKind kind, const SolverOptions& options,
                               const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  if (!(options.tolerance > 0 && options.tolerance < 1))
    throw BadArgument("the solver's tolerance must lie between 0 and 1");
  const VoxelMesh mesh(problem.body);
  if (problem.f_N.cols() != mesh.nodeCount())
    throw BadArgument("the load has " + std::to_string(problem.f_N.cols()) + " nodes, the mesh " +
                      std::to_string(mesh.nodeCount()));
  if (!problem.f_N.allFinite()) throw BadInput("the load is not finite at some node");
  requireSupported(mesh, problem.supports);

  Newton newton(problem, kind, options, progress);
  Solution solution;
  SolveReport& report = solution.report;
  report.tolerance = options.tolerance;
  Eigen::VectorXd u = Eigen::VectorXd::Zero(newton.f.size());
  double reached = 0;
  int steps = 0;
  std::ostringstream why;
  why << (kind == LargeDeformationKind::Corotational ? "corotational" : "neo-Hookean, mean dilatation") << ", ";
  if (!newton.moves && newton.onFree(newton.f).cwiseAbs().maxCoeff() == 0) {
    report.kind = "none";
    report.status = SolveStatus::Converged;
    why << "no load on a free degree of freedom";
  } else {
    const bool all = newton.run(u, reached, steps);
    report.kind = newton.tangents.kind();
    report.status = all ? SolveStatus::Converged : SolveStatus::StoppedAtLimit;
    report.iterations = newton.iterations;
    why << steps << (steps == 1 ? " load step" : " load steps");
    if (newton.tangents.innerIterations() > 0) why << ", " << newton.tangents.innerIterations() << " inner iterations";
    if (!all)
      why << "; only " << 100 * reached
          << " % of the load could be applied: beyond it no stable equilibrium was found or cells turn "
          << "inside out. The displacement shown belongs to that part of the load";
  }
  double energy = 0;
  Eigen::VectorXd force;
  if (!newton.model.evaluate(u, Tangent::None, energy, force)) report.status = SolveStatus::NotFinite;
  if (report.kind != "none") {
    const double unit = newton.reference(1, force);
    report.residual = unit > 0 ? newton.residual(1, force).norm() / unit : 1.0;
    if (report.converged() && newton.atRounding && report.residual > report.tolerance) {
      report.tolerance = newton.floor(u) / unit;
      why << "; the residual reached the rounding of double precision, " << report.tolerance
          << ", above the tolerance asked for";
    }
  }
  report.why = why.str();
  solution.u_m = u.reshaped(3, mesh.nodeCount());
  solution.energy_J = energy;
  const VoxelOperator& op = newton.model.op();
  const NodalField spring_N = op.springForce(solution.u_m);
  const NodalField internal_N = force.reshaped(3, mesh.nodeCount()) + spring_N;  // of the cells alone
  solution.reaction_N = reactionForces(op.fixed(), spring_N, internal_N - reached * problem.f_N);
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return solution;
}

}  // namespace glisson::mechanics
