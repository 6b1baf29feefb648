// SPDX-License-Identifier: GPL-3.0-or-later

// The solver of implicit time steps: its starts from earlier solutions, and its error beside that of the time step.
#include "mechanics/step_solver.h"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>

#include "base/error.h"
#include "base/random.h"
#include "mechanics/dynamics.h"
#include "mechanics/static_solve.h"
#include "scenes.h"

namespace glisson::mechanics {
namespace {

using Eigen::Vector3d;

Problem heldCube(int n) {
  Problem p;
  p.body = test::box({n, n, n}, {0.1, 0.1, 0.1}, 6e3, 0.45);
  const VoxelMesh mesh(p.body);
  const auto always = [](const Vector3d&) { return true; };
  p.supports.fixations = fix(nodesOfFaces(mesh, test::facesWhere(mesh, 4, always)));
  p.f_N = tractionForce(mesh, test::facesWhere(mesh, 5, always), Vector3d(100, 50, 30));
  return p;
}

std::vector<double> randomLoad(const VoxelOperator& voxels, Random& random) {
  NodalField field(3, voxels.mesh().nodeCount());
  for (Eigen::Index i = 0; i < field.size(); ++i) field(i) = random.normal();
  voxels.project(field);
  std::vector<double> slots(voxels.lattice().size());
  voxels.toSlots(field, slots.data());
  return slots;
}

std::vector<double> difference(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> d(a.size());
  for (std::size_t i = 0; i < d.size(); ++i) d[i] = a[i] - b[i];
  return d;
}

TEST(SolutionHistory, StartsAreExactForCombinationsOfTheLastSolutionsAndElseLeaveTheSmallestResidual) {
  const Problem p = heldCube(4);
  const VoxelOperator voxels(p.body, HexElement::Incompatible, p.supports);
  const LatticeOperator<double> A = voxels.implicitLattice(1.0, 1e-4);
  Factorisation factor(A, voxels.K0(), hexMass(p.body.h_m));
  Random random(11);
  SolutionHistory history;
  std::deque<std::vector<double>> last;  // right sides, the latest first
  const std::vector<double> weights = {0.3, -2.0, 1.0, 0.5};
  const std::size_t n = A.size();
  std::vector<double> x(n), start(n), r(n), Ax(n);
  for (int step = 0; step < 40; ++step) {
    const std::vector<double> b = randomLoad(voxels, random);
    factor.solve(b.data(), x.data());
    history.start(b, start, r);
    A.apply(start.data(), Ax.data());
    ASSERT_LE(norm(difference(difference(b, Ax), r)), 1e-12 * norm(b)) << "step " << step;
    EXPECT_LE(norm(r), norm(b) * (1 + 1e-12));
    for (const std::vector<double>& known : last)
      EXPECT_LE(std::abs(dot(r, known)), 1e-10 * norm(r) * norm(known)) << "orthogonal to all that the space reaches";
    std::vector<double> e = difference(x, start);
    history.add(e, r);
    last.push_front(b);
    if (last.size() > SolutionHistory::kept) last.pop_back();
    std::vector<double> known(n, 0.0);
    for (std::size_t s = 0; s < last.size(); ++s)
      for (std::size_t i = 0; i < n; ++i) known[i] += weights[s] * last[s][i];
    factor.solve(known.data(), x.data());
    SolutionHistory copy = history;
    copy.start(known, start, r);
    ASSERT_LE(norm(difference(start, x)), 1e-10 * norm(x)) << "step " << step;
    ASSERT_LE(norm(r), 1e-10 * norm(known)) << "step " << step;
  }
}

TEST(StepSolver, ARightSideAndItsMultiplesCostNoSecondSolve) {
  const Problem p = heldCube(13);
  const auto voxels = std::make_shared<const VoxelOperator>(p.body, HexElement::Incompatible, p.supports);
  for (const double h : {1e-3, 1e-1}) {
    SolverOptions options;
    StepSolver solver(voxels, options);
    solver.prepare(1.0, h * h);
    Random random(5);
    const std::vector<double> load = randomLoad(*voxels, random);
    std::vector<double> b = load, x;
    EXPECT_GT(solver.solve(b, x).iterations, 2);
    for (double& v : b) v *= -3;
    const SolveReport again = solver.solve(b, x);
    EXPECT_TRUE(again.converged());
    EXPECT_LE(again.residual, again.tolerance);
    EXPECT_LE(again.iterations, 1);
    // Another matrix has nothing to do with the last one's solutions.
    solver.prepare(1.0, 0.5 * h * h);
    b = load;
    x.clear();
    EXPECT_GT(solver.solve(b, x).iterations, 2);
  }
}

TEST(StepSolver, FloatReachesWhatDoubleDoes) {
  const Problem p = heldCube(13);
  const auto voxels = std::make_shared<const VoxelOperator>(p.body, HexElement::Incompatible, p.supports);
  for (const double h : {1e-3, 1e-1, 1e3})
    for (const SolverKind kind : {SolverKind::Auto, SolverKind::Multigrid}) {
      SolverOptions options;
      options.kind = kind;
      options.tolerance = 1e-12;
      StepSolver solver(voxels, options);
      solver.prepare(1.0, h * h);
      Random random(5);
      std::vector<double> b = randomLoad(*voxels, random), x, Ax(b.size());
      const SolveReport report = solver.solve(b, x);
      EXPECT_TRUE(report.converged()) << h << ": " << report.residual;
      voxels->implicitLattice(1.0, h * h).apply(x.data(), Ax.data());
      EXPECT_LE(norm(difference(b, Ax)), 1.01 * report.tolerance * norm(b)) << h;
      EXPECT_LE(report.tolerance, 1e-10);
    }
}

TEST(StepSolver, AToleranceAskedForIsKeptAndOnlyTheProgramsOwnIsAdapted) {
  const Problem p = heldCube(13);
  const auto voxels = std::make_shared<const VoxelOperator>(p.body, HexElement::Incompatible, p.supports);
  for (const double h : {1e-3, 1e-1}) {
    const auto solved = [&](double tolerance, bool asked) {
      SolverOptions options;
      options.tolerance = tolerance;
      options.toleranceAsked = asked;
      StepSolver solver(voxels, options);
      solver.prepare(1.0, h * h);
      Random random(5);
      std::vector<double> b = randomLoad(*voxels, random), x;
      const SolveReport report = solver.solve(b, x);
      EXPECT_TRUE(report.converged()) << h;
      EXPECT_LE(report.residual, report.tolerance) << h;
      return report;
    };
    const SolveReport own = solved(SolverOptions::usualTolerance, false);
    const SolveReport asked = solved(SolverOptions::usualTolerance, true);
    EXPECT_DOUBLE_EQ(own.tolerance, 100 * SolverOptions::usualTolerance);
    EXPECT_EQ(asked.tolerance, SolverOptions::usualTolerance);
    EXPECT_GT(asked.iterations, own.iterations);
    for (const double tolerance : {1e-5, 1e-10}) EXPECT_EQ(solved(tolerance, false).tolerance, tolerance);
  }
}

TEST(StepSolver, AResidualAtTheRoundingOfDoublePrecisionHasConverged) {
  const Problem p = heldCube(13);
  const auto voxels = std::make_shared<const VoxelOperator>(p.body, HexElement::Incompatible, p.supports);
  for (const double h : {1e-3, 1e3})
    for (const SolverKind kind : {SolverKind::Auto, SolverKind::Multigrid, SolverKind::Factorised}) {
      SolverOptions options;
      options.kind = kind;
      options.tolerance = 1e-18;
      StepSolver solver(voxels, options);
      solver.prepare(1.0, h * h);
      std::vector<double> b(voxels->lattice().size()), x;
      voxels->toSlots(p.f_N, b.data());
      const SolveReport report = solver.solve(b, x);
      EXPECT_TRUE(report.converged()) << h << ": " << describe(report.status) << ", " << report.residual;
      EXPECT_LE(report.residual, report.tolerance);
      EXPECT_LT(report.tolerance, 1e-10);
      EXPECT_NE(report.why.find("rounding"), std::string::npos) << report.why;
      EXPECT_TRUE(report.diagnostics.empty()) << "no fall-back";
    }
}

TEST(StepSolver, ItsErrorAtTheEndIsFarBelowThatOfTheTimeSteps) {
  // 27,783 degrees of freedom, shaken by a sudden load; the usual tolerance against a tight one, and half the step.
  const Problem p = heldCube(20);
  for (const double h : {1e-3, 1e-2})
    for (const TimeScheme scheme : {TimeScheme::ImplicitEuler, TimeScheme::Newmark}) {
      const auto at = [&](double step, double tolerance) {
        DynamicOptions dynamic;
        dynamic.scheme = scheme;
        dynamic.h_s = step;
        dynamic.end_s = 16 * h;
        dynamic.ramp_s = 8 * h;
        SolverOptions options;
        if (tolerance > 0) options.tolerance = tolerance;
        return solveDynamic(p, dynamic, options).solution.u_m;
      };
      const NodalField usual = at(h, 0), tight = at(h, 1e-12), finer = at(0.5 * h, 1e-12);
      const double ofSolver = (usual - tight).norm(), ofSteps = (finer - tight).norm();
      EXPECT_GT(ofSteps, 1e-4 * tight.norm()) << h;
      EXPECT_LT(ofSolver, 1e-3 * ofSteps) << h << ", scheme " << static_cast<int>(scheme);
    }
}

}  // namespace
}  // namespace glisson::mechanics
