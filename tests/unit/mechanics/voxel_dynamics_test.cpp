// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <ctime>
#include <tuple>

#include "base/error.h"
#include "base/random.h"
#include "mechanics/dynamics.h"
#include "scenes.h"

namespace glisson::mechanics {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

Problem cube(int n, double poisson = 0.45, bool held = false) {
  Problem p;
  p.body = test::box({n, n, n}, {0.03, 0.03, 0.03}, 6e3, poisson);
  const VoxelMesh mesh(p.body);
  if (held) p.supports.fixations = fix(test::nodesWhere(mesh, [](const Vector3d& x) { return x.x() == 0.0; }));
  p.f_N = bodyForce(mesh, {0.0, 0.0, -0.01 * p.body.density_kg_m3 * 9.81});
  return p;
}

/// Largest change of linear and angular momentum over the flight of a vibrating free body, relative to what its parts
/// carry.
double momentumDrift(double h_s, int steps, double tolerance) {
  const Problem p = cube(2);
  const auto voxels = std::make_shared<const VoxelOperator>(p.body);
  const VoxelMesh& mesh = voxels->mesh();
  SolverOptions solver;
  solver.kind = SolverKind::Cg;
  solver.preconditioner = Preconditioner::BlockJacobi;
  solver.tolerance = tolerance;
  VoxelSystem system(voxels, solver);
  Random random(5);
  VectorXd v0(system.size());
  MatrixXd rigid(system.size(), 6);
  for (int node = 0; node < mesh.nodeCount(); ++node) {
    rigid.middleRows<3>(3 * node).leftCols<3>().setIdentity();
    for (int c = 0; c < 3; ++c) rigid.block<3, 1>(3 * node, 3 + c) = Vector3d::Unit(c).cross(mesh.position_m(node));
    v0.segment<3>(3 * node) = Vector3d(1, 2, -1) + Vector3d(3, 1, -2).cross(mesh.position_m(node));
    for (int c = 0; c < 3; ++c) v0[3 * node + c] += 0.1 * random.normal();
  }
  MatrixXd Mrigid(system.size(), 6);
  VectorXd y(system.size());
  for (int c = 0; c < 6; ++c) {
    system.applyM(rigid.col(c), y);
    Mrigid.col(c) = y;
  }
  const VectorXd before = Mrigid.transpose() * v0;
  const VectorXd scale = Mrigid.cwiseAbs().transpose() * v0.cwiseAbs();
  DynamicOptions options;
  options.h_s = h_s;
  options.end_s = steps * h_s;
  double drift = 0;
  options.onStep = [&](const DynamicState& s) {
    drift = std::max(drift, (Mrigid.transpose() * s.v - before).cwiseQuotient(scale).cwiseAbs().maxCoeff());
    return true;
  };
  const VectorXd zero = VectorXd::Zero(system.size());
  EXPECT_EQ(integrate(system, zero, zero, v0, options).steps, steps);
  return drift;
}

TEST(VoxelDynamics, MomentumOfFreeVoxelsIsKeptForTenThousandStepsOfAnyLength) {
  // Even with a loose solver: the rigid motions are integrated apart.
  for (const double h_s : {1e-3, 1e-2}) EXPECT_LE(momentumDrift(h_s, 10000, 1e-6), 1e-12) << h_s;
}

TEST(VoxelDynamics, FreeModesMustBeFree) {
  const MatrixXd K = (MatrixXd(2, 2) << 1.0, -1.0, -1.0, 1.0).finished();
  MatrixSystem system(K.sparseView(), MatrixXd::Identity(2, 2).sparseView());
  EXPECT_THROW(system.setFreeModes(Eigen::Vector2d(1, 0)), BadArgument);
  EXPECT_THROW(system.setFreeModes(MatrixXd::Ones(3, 1)), BadArgument);
  system.setFreeModes(MatrixXd::Ones(2, 1));
  EXPECT_NEAR((system.freeModes().transpose() * system.freeModes())(0, 0), 1.0, 1e-14);
}

TEST(VoxelDynamics, EverySolverOfAStepAgreesAndAutoSaysWhy) {
  for (const double h_s : {1e-4, 1e-2, 10.0}) {
    const Problem p = cube(13, 0.45, true);
    const auto run = [&](SolverKind kind) {
      SolverOptions solver;
      solver.kind = kind;
      solver.preconditioner = Preconditioner::BlockJacobi;
      solver.tolerance = 1e-11;
      DynamicOptions options;
      options.h_s = h_s;
      options.end_s = 3 * h_s;
      return solveDynamic(p, options, solver);
    };
    const DynamicSolution direct = run(SolverKind::Factorised);
    for (const SolverKind kind : {SolverKind::Cg, SolverKind::Multigrid, SolverKind::Auto}) {
      const DynamicSolution d = run(kind);
      EXPECT_TRUE(d.solution.report.converged());
      EXPECT_LE((d.solution.u_m - direct.solution.u_m).norm(), 1e-8 * direct.solution.u_m.norm()) << h_s;
      if (kind == SolverKind::Multigrid) {
        EXPECT_LE(d.solution.report.iterations, 30) << h_s;
      }
      if (kind == SolverKind::Auto) {
        EXPECT_EQ(d.solution.report.kind, h_s < 1e-3 ? "block-jacobi-cg" : "multigrid-pcg");
        EXPECT_NE(d.solution.report.why.find("auto"), std::string::npos);
      }
    }
  }
}

TEST(VoxelDynamics, ForcesAtFixedNodesDoNoHarm) {
  const Problem p = cube(4, 0.45, true);
  const auto voxels = std::make_shared<const VoxelOperator>(p.body, HexElement::Incompatible, p.supports);
  SolverOptions solver;
  solver.kind = SolverKind::Cg;
  solver.preconditioner = Preconditioner::BlockJacobi;
  NodalField projected = p.f_N;
  voxels->project(projected);
  const VectorXd zero = VectorXd::Zero(p.f_N.size());
  DynamicOptions options;
  options.end_s = 5e-3;
  std::vector<VectorXd> q;
  for (const NodalField& f : {p.f_N, projected}) {
    VoxelSystem system(voxels, solver);
    const Trajectory t = integrate(system, Eigen::Map<const VectorXd>(f.data(), f.size()), zero, zero, options);
    EXPECT_TRUE(t.worst.converged());
    q.push_back(t.last.q);
  }
  EXPECT_EQ(q[0], q[1]);
}

TEST(VoxelDynamics, TheFirstStepCostsInProportionToTheBody) {
  // Processor time from nothing to the end of the first step, on bodies of 10,125 and 73,167 degrees of freedom.
  const auto firstStep_s = [](int n) {
    const Problem p = cube(n, 0.45, true);
    DynamicOptions dynamic;
    dynamic.h_s = dynamic.end_s = 0.05;
    const std::clock_t start = std::clock();
    EXPECT_EQ(solveDynamic(p, dynamic).trajectory.steps, 1);
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  };
  const double small = firstStep_s(14), large = firstStep_s(28);
  EXPECT_LT(large, 20 * std::max(small, 0.005)) << small << " s and " << large << " s";
}

TEST(VoxelDynamics, MotionsEndAtTheTimeAskedFor) {
  for (const auto& [h_s, end_s, steps] : {std::tuple{0.03, 0.1, 4}, {0.003, 0.1, 34}, {0.025, 0.1, 4}, {0.2, 0.1, 1}}) {
    const TimeSteps plan = timeSteps(h_s, end_s);
    EXPECT_EQ(plan.count, steps);
    EXPECT_LE(plan.h_s, h_s);
    EXPECT_NEAR(plan.count * plan.h_s, end_s, 1e-12);
    DynamicOptions dynamic;
    dynamic.h_s = h_s;
    dynamic.end_s = end_s;
    const Trajectory t = solveDynamic(cube(3, 0.45, true), dynamic).trajectory;
    EXPECT_NEAR(t.last.t_s, end_s, 1e-12);
    EXPECT_EQ(t.steps, steps);
    EXPECT_EQ(t.h_s, plan.h_s);
  }
  EXPECT_EQ(timeSteps(1e-3, 2.0).h_s, 1e-3);
  EXPECT_EQ(timeSteps(1e-3, 0.0).count, 0);
  EXPECT_THROW(timeSteps(0.0, 1.0), BadInput);
  EXPECT_THROW(timeSteps(1e-3, -1.0), BadInput);
}

}  // namespace
}  // namespace glisson::mechanics
