// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/dynamics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"

#include "mechanics/static_solve.h"
#include "moving.h"
#include "scenes.h"

namespace glisson::mechanics {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

using test::cube;
using test::one;
using test::oneMass;

TEST(Dynamics, FreeFallOfVoxelsGainsExactlyGHPerStep) {
  const Problem p = cube(4);
  const auto voxels = std::make_shared<const VoxelOperator>(p.body);
  const Vector3d g(0.0, 0.0, -9.81);
  const NodalField f = voxels->applyMass(g.replicate(1, voxels->mesh().nodeCount()));
  SolverOptions solver;
  solver.tolerance = 1e-13;
  VoxelSystem system(voxels, solver);
  DynamicOptions options;
  options.h_s = 1e-3;
  options.end_s = 20e-3;
  options.keepEvery = 1;
  const VectorXd zero = VectorXd::Zero(system.size());
  const Trajectory t = integrate(system, Eigen::Map<const VectorXd>(f.data(), f.size()), zero, zero, options);
  ASSERT_EQ(t.steps, 20);
  for (const DynamicState& s : t.kept) {
    // Backward Euler falls n (n + 1) / 2 times g h², not n² / 2.
    const double expected_m = -0.5 * 9.81 * options.h_s * options.h_s * s.step * (s.step + 1);
    for (Eigen::Index i = 0; i < s.q.size(); i += 3) {
      EXPECT_NEAR(s.q[i + 2], expected_m, 1e-12 * std::abs(expected_m));
      EXPECT_NEAR(s.v[i + 2], -9.81 * options.h_s * s.step, 1e-12 * 9.81 * options.h_s * std::max(1, s.step));
      EXPECT_NEAR(s.q[i], 0.0, 1e-12 * std::abs(expected_m));
    }
  }
}

TEST(Dynamics, FreeFallOfFramesIsTheSame) {
  const Problem p = cube(8);
  MeshfreeOptions frames;
  frames.frames = 8;
  const MeshfreeModel model(p, frames);
  const Vector3d g(0.0, 0.0, -9.81);
  const VectorXd f = model.reduce(model.voxels().applyMass(g.replicate(1, model.voxels().mesh().nodeCount())));
  MatrixSystem system(model.K(), model.M());
  DynamicOptions options;
  options.end_s = 10e-3;
  const VectorXd zero = VectorXd::Zero(system.size());
  const Trajectory t = integrate(system, f, zero, zero, options);
  const double expected_m = -0.5 * 9.81 * 1e-6 * 10 * 11;
  const NodalField u = model.expandRate(t.last.q);
  EXPECT_NEAR(u.row(2).minCoeff(), expected_m, 1e-10 * std::abs(expected_m));
  EXPECT_NEAR(u.row(2).maxCoeff(), expected_m, 1e-10 * std::abs(expected_m));
  EXPECT_LE(u.topRows<2>().cwiseAbs().maxCoeff(), 1e-10 * std::abs(expected_m));
}

TEST(Dynamics, DampedSpringSettlesAtForceOverStiffness) {
  MatrixSystem system = oneMass(0.2, 50.0);
  DynamicOptions options;
  options.h_s = 1e-3;
  options.end_s = 20.0;
  options.rayleighAlpha_1_s = 5.0;
  options.stopWhenSteady = 1e-9;
  const Trajectory t = integrate(system, one(3.0), one(0.0), one(0.0), options);
  EXPECT_TRUE(t.steady);
  EXPECT_LT(t.last.t_s, options.end_s);
  EXPECT_NEAR(t.last.q[0], 3.0 / 50.0, 1e-8 * 3.0 / 50.0);
}

TEST(Dynamics, UndampedAmplitudeShrinksByTheClosedFactor) {
  // |1 / (1 − i ω h)|ⁿ = (1 + ω² h²)^(−n/2): x and v/ω stay on a spiral.
  const double omega = 40.0, h = 2e-3;
  MatrixSystem system = oneMass(1.5, 1.5 * omega * omega);
  DynamicOptions options;
  options.h_s = h;
  options.end_s = 100 * h;
  options.keepEvery = 1;
  const Trajectory t = integrate(system, one(0.0), one(0.01), one(0.0), options);
  for (const DynamicState& s : t.kept) {
    const double amplitude = std::hypot(s.q[0], s.v[0] / omega);
    EXPECT_NEAR(amplitude, 0.01 * std::pow(1.0 + omega * omega * h * h, -0.5 * s.step), 1e-12 * 0.01);
  }
}

TEST(Dynamics, RayleighDampingFollowsTheScalarRecurrence) {
  const double m = 0.7, k = 90.0, alpha = 3.0, beta = 0.004, h = 5e-3, f = 0.4;
  const double c = alpha * m + beta * k;
  MatrixSystem system = oneMass(m, k);
  DynamicOptions options;
  options.h_s = h;
  options.end_s = 60 * h;
  options.rayleighAlpha_1_s = alpha;
  options.rayleighBeta_s = beta;
  options.keepEvery = 1;
  const Trajectory t = integrate(system, one(f), one(0.0), one(0.1), options);
  double x = 0.0, v = 0.1;
  for (std::size_t n = 1; n < t.kept.size(); ++n) {
    // Backward Euler itself: m (v⁺ − v)/h + c v⁺ + k (x + h v⁺) = f.
    v = (m * v / h + f - k * x) / (m / h + c + h * k);
    x += h * v;
    ASSERT_NEAR(t.kept[n].q[0], x, 1e-14);
    ASSERT_NEAR(t.kept[n].v[0], v, 1e-13);
  }
}

TEST(Dynamics, VeryStiffSpringIsStaticInOneStepWithoutOvershoot) {
  const double omega = 1e6, h = 1.0;
  MatrixSystem system = oneMass(2.0, 2.0 * omega * omega);
  DynamicOptions options;
  options.h_s = h;
  options.end_s = 5.0;
  options.keepEvery = 1;
  const Trajectory t = integrate(system, one(7.0), one(0.0), one(0.0), options);
  const double rest = 7.0 / (2.0 * omega * omega);
  for (std::size_t n = 1; n < t.kept.size(); ++n) {
    EXPECT_NEAR(t.kept[n].q[0], rest, 1e-11 * rest);
    // What inertia is left, 1/(ω² h²) of the way, is all that may pass the goal.
    EXPECT_LE(t.kept[n].q[0], rest * (1.0 + 1.001 / (omega * omega * h * h)));
  }
}

TEST(Dynamics, FirstOrderInTheTimeStep) {
  const double omega = 12.0, m = 1.0, end = 0.5;
  const double exact = 0.02 * std::cos(omega * end);
  std::vector<double> error;
  for (const double h : {2e-4, 1e-4, 5e-5}) {
    MatrixSystem system = oneMass(m, m * omega * omega);
    DynamicOptions options;
    options.h_s = h;
    options.end_s = end;
    error.push_back(std::abs(integrate(system, one(0.0), one(0.02), one(0.0), options).last.q[0] - exact));
  }
  EXPECT_NEAR(error[0] / error[1], 2.0, 0.05);
  EXPECT_NEAR(error[1] / error[2], 2.0, 0.05);
}

TEST(Dynamics, EveryTimeStepStaysFiniteAndEnergyNeverGrows) {
  const Problem p = cube(6, 0.45, true);
  MeshfreeOptions frames;
  frames.frames = 5;
  const MeshfreeModel model(p, frames);
  MatrixSystem system(model.K(), model.M());
  Random random(3);
  VectorXd q0(model.dofs()), v0(model.dofs());
  for (Eigen::Index i = 0; i < q0.size(); ++i) q0[i] = 1e-4 * random.normal(), v0[i] = 1e-2 * random.normal();
  const VectorXd f = model.load(model.load_N());
  for (const double h : {1e-9, 1e-6, 1e-3, 1.0, 1e3}) {
    DynamicOptions options;
    options.h_s = h;
    options.end_s = 50 * h;
    options.rayleighBeta_s = 1e-3;
    const Trajectory t = integrate(system, f, q0, v0, options);
    ASSERT_EQ(t.steps, 50) << h;
    EXPECT_TRUE(t.last.q.allFinite() && t.last.v.allFinite()) << h;
    const double scale = t.energies.front().kinetic_J + t.energies.front().elastic_J;
    for (std::size_t n = 1; n < t.energies.size(); ++n)
      EXPECT_LE(t.energies[n].total_J(), t.energies[n - 1].total_J() + 1e-12 * scale) << "h " << h << " step " << n;
  }
}

TEST(Dynamics, MomentumOfAFreeBodyIsKeptForTenThousandSteps) {
  Problem p = cube(6);
  p.body.density_kg_m3 = 1060.0;
  MeshfreeOptions frames;
  frames.frames = 2;
  const MeshfreeModel model(p, frames);
  const int nodes = model.voxels().mesh().nodeCount();
  const VectorXd along = model.nearest(Vector3d(1, 2, -1).normalized().replicate(1, nodes));
  MatrixSystem system(model.K(), model.M());
  Random random(5);
  VectorXd v0 = along;
  for (Eigen::Index i = 0; i < v0.size(); ++i) v0[i] += 0.1 * random.normal();
  const VectorXd Mtranslation = model.M() * along;
  const VectorXd zero = VectorXd::Zero(model.dofs());
  // Where the rigid motions are not told, rounding in K q acts as a force that grows with the distance travelled: the
  // bound then holds over a second of flight only.
  const double before = Mtranslation.dot(v0);
  const auto driftAt = [&](double h_s) {
    DynamicOptions options;
    options.h_s = h_s;
    options.end_s = 10000 * h_s;
    double drift = 0.0;
    options.onStep = [&](const DynamicState& s) {
      drift = std::max(drift, std::abs(Mtranslation.dot(s.v) - before));
      return true;
    };
    EXPECT_EQ(integrate(system, zero, zero, v0, options).steps, 10000);
    return drift / std::abs(before);
  };
  EXPECT_LE(driftAt(1e-4), 1e-10);
  MatrixXd rigid(model.dofs(), 6);
  for (int c = 0; c < 6; ++c) {
    NodalField motion(3, nodes);
    for (int node = 0; node < nodes; ++node)
      motion.col(node) = c < 3 ? Vector3d(Vector3d::Unit(c))
                               : Vector3d(Vector3d::Unit(c - 3).cross(model.voxels().mesh().position_m(node)));
    rigid.col(c) = model.nearest(motion);
  }
  system.setFreeModes(rigid);
  for (const double h_s : {1e-4, 1e-3, 1e-2}) EXPECT_LE(driftAt(h_s), 1e-12) << h_s;
}

TEST(Dynamics, LimitOfTheVoxelModelIsItsStaticSolution) {
  const Problem p = cube(4, 0.45, true);
  SolverOptions solver;
  solver.tolerance = 1e-12;
  const Solution rest = solveStatic(p, solver);
  DynamicOptions options;
  options.h_s = 0.02;
  options.end_s = 40.0;
  options.stopWhenSteady = 1e-8;
  solver.kind = SolverKind::Auto;
  const DynamicSolution d = solveDynamic(p, options, solver);
  EXPECT_TRUE(d.trajectory.steady);
  EXPECT_TRUE(d.solution.report.converged());
  EXPECT_LE((d.solution.u_m - rest.u_m).norm(), 1e-6 * rest.u_m.norm());
  const Vector3d load = p.f_N.rowwise().sum();
  EXPECT_LE((d.solution.reaction_N.rowwise().sum() + load).norm(), 1e-6 * load.norm());
}

TEST(Dynamics, LimitOfTheMeshfreeModelIsItsStaticSolution) {
  const Problem p = cube(8, 0.45, true);
  MeshfreeOptions frames;
  frames.frames = 6;
  const MeshfreeModel model(p, frames);
  DynamicOptions options;
  options.h_s = 0.02;
  options.end_s = 40.0;
  options.ramp_s = 0.1;
  options.stopWhenSteady = 1e-9;
  const DynamicSolution d = solveDynamic(model, options);
  const Solution rest = model.solveStatic();
  EXPECT_TRUE(d.trajectory.steady);
  EXPECT_LE((d.solution.u_m - rest.u_m).norm(), 1e-6 * rest.u_m.norm());
  EXPECT_NEAR(d.solution.energy_J, rest.energy_J, 1e-6 * rest.energy_J);
}

TEST(Dynamics, ReactionsBalanceLoadAndInertiaDuringTheMotion) {
  const Problem p = cube(6, 0.3, true);
  DynamicOptions options;
  options.end_s = 7e-3;
  options.rayleighAlpha_1_s = 2.0;
  options.rayleighBeta_s = 1e-3;
  SolverOptions solver;
  solver.tolerance = 1e-12;
  MeshfreeOptions frames;
  frames.frames = 4;
  const MeshfreeModel model(p, frames);
  const Vector3d load = p.f_N.rowwise().sum();
  const auto check = [&](const DynamicSolution& d, const NodalField& a, const NodalField& v) {
    // d(momentum)/dt + α momentum = load + reactions; stiffness-proportional damping is internal.
    const Vector3d inertia = model.voxels().applyMass(a + 2.0 * v).rowwise().sum();
    const Vector3d reaction = d.solution.reaction_N.rowwise().sum();
    EXPECT_LE((inertia - load - reaction).norm(), 1e-9 * load.norm());
    EXPECT_GT(inertia.norm(), 1e-3 * load.norm());
  };
  const DynamicSolution reduced = solveDynamic(model, options, solver);
  check(reduced, model.expandRate(reduced.trajectory.last.a), model.expandRate(reduced.trajectory.last.v));
  const DynamicSolution full = solveDynamic(p, options, solver);
  const Eigen::Index n = model.voxels().mesh().nodeCount();
  check(full, Eigen::Map<const NodalField>(full.trajectory.last.a.data(), 3, n),
        Eigen::Map<const NodalField>(full.trajectory.last.v.data(), 3, n));
}

TEST(Dynamics, PrescribedDisplacementPullsTheBodyAlong) {
  Problem p = cube(4, 0.3);
  p.f_N.setZero();
  const VoxelMesh mesh(p.body);
  p.supports.fixations = fix(test::nodesWhere(mesh, [](const Vector3d& x) { return x.x() == 0.0; }));
  for (Fixation& f : p.supports.fixations) f.value_m = {1e-3, 0.0, 0.0};
  DynamicOptions options;
  options.h_s = 0.05;
  options.end_s = 30.0;
  SolverOptions solver;
  solver.tolerance = 1e-11;
  const DynamicSolution d = solveDynamic(p, options, solver);
  // A rigid motion of the support ends as a rigid motion of the body.
  EXPECT_LE((d.solution.u_m.row(0).array() - 1e-3).abs().maxCoeff(), 1e-9);
  EXPECT_LE(d.solution.u_m.bottomRows<2>().cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Dynamics, TheSameBitsWithAnyNumberOfThreads) {
  const Problem p = cube(6, 0.45, true);
  MeshfreeOptions frames;
  frames.frames = 5;
  DynamicOptions options;
  options.end_s = 5e-3;
  std::vector<DynamicSolution> full, reduced;
  for (const int threads : {1, 2, 4}) {
    setThreadCount(threads);
    full.push_back(solveDynamic(p, options));
    reduced.push_back(solveDynamic(MeshfreeModel(p, frames), options));
  }
  setThreadCount(0);
  for (std::size_t i = 1; i < full.size(); ++i) {
    EXPECT_EQ(full[i].solution.u_m, full[0].solution.u_m);
    EXPECT_EQ(reduced[i].solution.u_m, reduced[0].solution.u_m);
  }
}

TEST(Dynamics, CgStoppedEarlySaysSo) {
  const Problem p = cube(8, 0.49, true);
  MeshfreeOptions frames;
  frames.frames = 8;
  const MeshfreeModel model(p, frames);
  SolverOptions solver;
  solver.kind = SolverKind::Cg;
  solver.preconditioner = Preconditioner::None;
  solver.iterations = 3;
  DynamicOptions options;
  options.h_s = 0.1;
  options.end_s = 0.5;
  const DynamicSolution d = solveDynamic(model, options, solver);
  EXPECT_EQ(d.solution.report.status, SolveStatus::StoppedAtLimit);
  EXPECT_GT(d.solution.report.residual, solver.tolerance);
}

TEST(Dynamics, RefusesImpossibleSettings) {
  MatrixSystem system = oneMass(1.0, 1.0);
  DynamicOptions options;
  options.h_s = 0.0;
  EXPECT_THROW(integrate(system, one(0), one(0), one(0), options), BadInput);
  options.h_s = 1e-3;
  options.rayleighBeta_s = -1.0;
  EXPECT_THROW(integrate(system, one(0), one(0), one(0), options), BadInput);
  options.rayleighBeta_s = 0.0;
  options.h_s = 1e-12;
  EXPECT_THROW(integrate(system, one(0), one(0), one(0), options), BadInput);
  options.h_s = 1e-3;
  EXPECT_THROW(integrate(system, one(0), VectorXd::Zero(2), one(0), options), BadArgument);
}

}  // namespace
}  // namespace glisson::mechanics
