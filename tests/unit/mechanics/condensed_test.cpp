// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/condensed.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "base/error.h"
#include "mechanics/dynamics.h"
#include "scenes.h"

namespace glisson::mechanics {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// A soft block on a fixed base with a stiff ball inside; three patches of traction on its top are the tool inputs.
struct Scene {
  VoxelBody body = test::box({12, 10, 6}, {0.06, 0.05, 0.03}, 6e3, 0.45);
  Supports supports;
  std::vector<NodalField> inputs;

  Scene() {
    test::paint(body, [](const Vector3d& x, double E) {
      return (x - Vector3d(0.03, 0.025, 0.015)).norm() < 0.01 ? 10.0 * E : E;
    });
    const VoxelMesh mesh(body);
    supports.fixations = fix(test::nodesWhere(mesh, [](const Vector3d& x) { return x.z() == 0.0; }));
    for (int i = 0; i < 3; ++i) {
      const auto faces =
          test::facesWhere(mesh, 5, [&](const Vector3d& x) { return std::abs(x.x() - 0.02 * i - 0.01) < 0.006; });
      inputs.push_back(tractionForce(mesh, faces, Vector3d(i == 1 ? 200.0 : 0.0, 0.0, -300.0)));
    }
  }
  StaticSolver solver() const {
    SolverOptions o;
    o.tolerance = 1e-10;
    return StaticSolver(body, supports, o);
  }
};

TEST(Condensed, IsTheFullSolution) {
  const Scene scene;
  StaticSolver solver = scene.solver();
  const CondensedModel model(solver, scene.inputs, everyNode(solver.mesh()));
  const VectorXd amount = Vector3d(0.7, -1.3, 2.0);
  NodalField f = NodalField::Zero(3, solver.mesh().nodeCount());
  for (int i = 0; i < 3; ++i) f += amount[i] * scene.inputs[static_cast<std::size_t>(i)];
  const Solution full = solver.solve(f);
  VectorXd u;
  model.evaluate(amount, u);
  const Eigen::Map<const NodalField> field(u.data(), 3, u.size() / 3);
  EXPECT_GT(full.u_m.colwise().norm().maxCoeff(), 1e-3);
  EXPECT_LE((field - full.u_m).colwise().norm().maxCoeff(), 1e-9);  // 1e-6 mm
}

TEST(Condensed, LandmarksInterpolateTheField) {
  const Scene scene;
  StaticSolver solver = scene.solver();
  // A linear field is met exactly by trilinear weights.
  const auto g = [](const Vector3d& x) { return 0.2 + 3.0 * x.x() - 2.0 * x.y() + 0.7 * x.z(); };
  for (const Vector3d& p :
       {Vector3d(0.0123, 0.0307, 0.0199), Vector3d(0.06, 0.05, 0.03), Vector3d(0, 0, 0), Vector3d(0.03, 0.0, 0.0111)}) {
    const Landmark l = landmarkAt(solver.mesh(), p);
    double value = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < l.nodes.size(); ++i) {
      value += l.weights[i] * g(solver.mesh().position_m(l.nodes[i]));
      sum += l.weights[i];
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);
    EXPECT_NEAR(value, g(p), 1e-12);
  }
  EXPECT_THROW(landmarkAt(solver.mesh(), {0.07, 0.01, 0.01}), BadInput);
  EXPECT_THROW(landmarkAt(solver.mesh(), {0.01, -0.001, 0.01}), BadInput);
}

TEST(Condensed, ALandmarkInAHoleIsRefused) {
  VoxelBody body = test::box({5, 5, 5}, {0.05, 0.05, 0.05}, 1e3, 0.3);
  body.E_Pa[body.cell(2, 2, 2)] = 0.0;
  EXPECT_THROW(landmarkAt(VoxelMesh(body), {0.025, 0.025, 0.025}), BadInput);
  EXPECT_NO_THROW(landmarkAt(VoxelMesh(body), {0.02, 0.025, 0.025}));
}

TEST(Condensed, ToolComplianceIsSymmetricPositiveAndTwiceTheEnergy) {
  const Scene scene;
  StaticSolver solver = scene.solver();
  const CondensedModel model(solver, scene.inputs, {});
  EXPECT_EQ(model.toolCompliance(), model.toolCompliance().transpose());
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(model.toolCompliance()(i, i), 2.0 * solver.solve(scene.inputs[static_cast<std::size_t>(i)]).energy_J,
                1e-8 * model.toolCompliance()(i, i));
}

TEST(Condensed, PrescribedMeanDisplacementIsReached) {
  const Scene scene;
  StaticSolver solver = scene.solver();
  const CondensedModel model(solver, scene.inputs, everyNode(solver.mesh()));
  const Vector3d wanted_m(2e-3, -1e-3, 0.5e-3);
  VectorXd u;
  model.evaluate(model.prescribe(wanted_m), u);
  const Eigen::Map<const NodalField> field(u.data(), 3, u.size() / 3);
  for (int i = 0; i < 3; ++i) {
    const NodalField& f = scene.inputs[static_cast<std::size_t>(i)];
    EXPECT_NEAR(f.cwiseProduct(field).sum() / f.colwise().norm().sum(), wanted_m[i], 1e-9);
  }
  const CondensedModel twice(solver, {scene.inputs[0], scene.inputs[0]}, {});
  EXPECT_THROW(twice.prescribe(Eigen::Vector2d(1e-3, 1e-3)), BadInput);
}

TEST(Condensed, RefusesPrescribedSupports) {
  Scene scene;
  scene.supports.fixations.front().value_m.x() = 1e-3;
  StaticSolver solver = scene.solver();
  EXPECT_THROW(CondensedModel(solver, scene.inputs, {}), BadInput);
}

/// Largest difference (m) over all nodes and steps between condensed dynamics and full implicit Euler.
double differenceFromFull(const Scene& scene, int vectors, double ramp_s, double alpha, double beta, int training = 0) {
  StaticSolver solver = scene.solver();
  const auto voxels = std::make_shared<const VoxelOperator>(scene.body, HexElement::Incompatible, scene.supports);
  CondensedDynamicOptions options;
  options.vectors = vectors;
  options.training = training;
  options.rayleighAlpha_1_s = alpha;
  options.rayleighBeta_s = beta;
  CondensedDynamics fast(solver, {scene.inputs[0]}, everyNode(voxels->mesh()), options);
  EXPECT_LE(fast.size(), vectors);
  SolverOptions exact;
  exact.tolerance = 1e-9;
  VoxelSystem system(voxels, exact);
  NodalField f = scene.inputs[0];
  voxels->project(f);
  DynamicOptions dynamic;
  dynamic.end_s = 0.15;
  dynamic.ramp_s = ramp_s;
  dynamic.rayleighAlpha_1_s = alpha;
  dynamic.rayleighBeta_s = beta;
  double worst_m = 0.0, largest_m = 0.0;
  VectorXd u;
  dynamic.onStep = [&](const DynamicState& s) {
    fast.step(VectorXd::Constant(1, ramp_s > 0.0 ? std::min(1.0, s.t_s / ramp_s) : 1.0));
    fast.evaluate(u);
    worst_m = std::max(worst_m, (u - s.q).cwiseAbs().maxCoeff());
    largest_m = std::max(largest_m, s.q.cwiseAbs().maxCoeff());
    return true;
  };
  const VectorXd zero = VectorXd::Zero(system.size());
  integrate(system, Eigen::Map<const VectorXd>(f.data(), f.size()), zero, zero, dynamic);
  EXPECT_GT(largest_m, 5e-4);
  std::printf("condensed dynamics, %d vectors, ramp %.1f s, beta %.0e s: largest difference %.1e mm of %.2f mm\n",
              vectors, ramp_s, beta, 1e3 * worst_m, 1e3 * largest_m);
  return worst_m;
}

TEST(Condensed, DynamicsFollowFullImplicitEulerToAMicrometre) {
  const Scene scene;
  EXPECT_LE(differenceFromFull(scene, 8, 0.1, 1.0, 2e-3), 1e-6);
  EXPECT_LE(differenceFromFull(scene, 16, 0.0, 1.0, 2e-3), 1e-6);
}

TEST(Condensed, MoreVectorsFollowAnUndampedBlowMoreClosely) {
  const Scene scene;
  const double few = differenceFromFull(scene, 4, 0.0, 0.0, 0.0);
  const double many = differenceFromFull(scene, 32, 0.0, 0.0, 0.0);
  EXPECT_LT(many, 0.1 * few);
}

TEST(Condensed, TrainedVectorsFollowABlowThatKrylovVectorsCannot) {
  const Scene scene;
  EXPECT_LE(differenceFromFull(scene, 12, 0.0, 1.0, 2e-3, 150), 1e-6);
  EXPECT_GT(differenceFromFull(scene, 24, 0.0, 0.0, 0.0), 1e-6);
  EXPECT_LE(differenceFromFull(scene, 24, 0.0, 0.0, 0.0, 150), 1e-6);
  // What was trained with a blow serves a slow push as well.
  EXPECT_LE(differenceFromFull(scene, 8, 0.1, 1.0, 2e-3, 150), 1e-6);
}

TEST(Condensed, DynamicsEndAtTheStaticSolutionAndLoseEnergyWhenReleased) {
  const Scene scene;
  StaticSolver solver = scene.solver();
  const CondensedModel rest(solver, scene.inputs, everyNode(solver.mesh()));
  CondensedDynamicOptions options;
  options.h_s = 5e-3;
  CondensedDynamics fast(solver, scene.inputs, everyNode(solver.mesh()), options);
  const VectorXd amount = Vector3d(1.0, 0.5, -0.5);
  for (int i = 0; i < 4000; ++i) fast.step(amount);
  VectorXd moving, still;
  fast.evaluate(moving);
  rest.evaluate(amount, still);
  EXPECT_LE((moving - still).norm(), 1e-6 * still.norm());
  double before = fast.energy_J();
  EXPECT_GT(before, 0.0);
  for (int i = 0; i < 500; ++i) {
    fast.step(VectorXd::Zero(3));
    EXPECT_LE(fast.energy_J(), before * (1.0 + 1e-12));
    before = fast.energy_J();
  }
}

}  // namespace
}  // namespace glisson::mechanics
