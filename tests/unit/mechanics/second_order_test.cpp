// SPDX-License-Identifier: GPL-3.0-or-later

// Newmark's method and generalised alpha against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "base/error.h"
#include "mechanics/dynamics.h"
#include "moving.h"

namespace glisson::mechanics {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using test::cube;
using test::one;
using test::oneMass;

TEST(Dynamics, NewmarkTurnsAnOscillatorByItsClosedAngle) {
  // Average acceleration keeps x² + (v/ω)² and turns by 2 atan(ωh/2) a step.
  const double omega = 40.0, h = 5e-3;
  MatrixSystem system = oneMass(1.5, 1.5 * omega * omega);
  DynamicOptions options;
  options.scheme = TimeScheme::Newmark;
  options.h_s = h;
  options.end_s = 500 * h;
  options.keepEvery = 1;
  const Trajectory t = integrate(system, one(0.0), one(0.01), one(0.0), options);
  const double angle = 2 * std::atan(0.5 * omega * h);
  for (const DynamicState& s : t.kept) {
    EXPECT_NEAR(s.q[0], 0.01 * std::cos(angle * s.step), 1e-12);
    EXPECT_NEAR(s.v[0] / omega, -0.01 * std::sin(angle * s.step), 1e-12);
    if (s.step > 0) {
      EXPECT_NEAR(s.a[0], -omega * omega * s.q[0], 1e-10) << "in balance at the end of every step";
    }
  }
  for (const StepEnergy& e : t.energies)
    EXPECT_NEAR(e.total_J(), t.energies[0].total_J(), 1e-12 * t.energies[0].total_J());
}

TEST(Dynamics, GeneralisedAlphaLeavesItsSpectralRadiusOfWhatItDoesNotResolve) {
  const double omega = 1e7, h = 1e-3;
  MatrixSystem system = oneMass(1.0, omega * omega);
  for (const double radius : {0.3, 0.8}) {
    DynamicOptions options;
    options.scheme = TimeScheme::GeneralisedAlpha;
    options.spectralRadius = radius;
    options.h_s = h;
    options.end_s = 40 * h;
    options.keepEvery = 1;
    const Trajectory t = integrate(system, one(0.0), one(1e-3), one(0.0), options);
    // A double root: the ratio approaches it as 1 + 1/n.
    const double ratio = std::abs(t.kept[40].q[0] / t.kept[39].q[0]);
    EXPECT_NEAR(ratio, radius, 0.08 * radius);
    EXPECT_LT(std::abs(t.kept[40].q[0]), 1e-3);
  }
}

TEST(Dynamics, SchemesHaveTheirOrderOnADampedBodyUnderARamp) {
  const Problem p = cube(3, 0.3, true);
  const auto at = [&](TimeScheme scheme, double h) {
    DynamicOptions options;
    options.scheme = scheme;
    options.h_s = h;
    options.end_s = 0.064;
    options.ramp_s = 0.032;
    options.rayleighAlpha_1_s = 2.0;
    options.rayleighBeta_s = 1e-3;
    SolverOptions solver;
    solver.kind = SolverKind::Factorised;
    return solveDynamic(p, options, solver).solution.u_m;
  };
  const NodalField truth = at(TimeScheme::Newmark, 1e-4);
  for (const auto& [scheme, order] : {std::pair{TimeScheme::ImplicitEuler, 1.0}, std::pair{TimeScheme::Newmark, 2.0},
                                      std::pair{TimeScheme::GeneralisedAlpha, 2.0}}) {
    const double coarse = (at(scheme, 4e-3) - truth).norm(), fine = (at(scheme, 2e-3) - truth).norm();
    EXPECT_NEAR(std::log2(coarse / fine), order, 0.3) << static_cast<int>(scheme);
    if (order > 1) {
      EXPECT_LT(fine, 0.1 * (at(TimeScheme::ImplicitEuler, 2e-3) - truth).norm());
    }
  }
}

TEST(Dynamics, FreeFallBySecondOrderIsExact) {
  const Problem p = cube(4);
  const auto voxels = std::make_shared<const VoxelOperator>(p.body);
  const Vector3d g(0.0, 0.0, -9.81);
  const NodalField f = voxels->applyMass(g.replicate(1, voxels->mesh().nodeCount()));
  for (const TimeScheme scheme : {TimeScheme::Newmark, TimeScheme::GeneralisedAlpha}) {
    VoxelSystem system(voxels, {});
    DynamicOptions options;
    options.scheme = scheme;
    options.end_s = 20e-3;
    const VectorXd zero = VectorXd::Zero(system.size());
    const Trajectory t = integrate(system, Eigen::Map<const VectorXd>(f.data(), f.size()), zero, zero, options);
    for (Eigen::Index i = 2; i < t.last.q.size(); i += 3) {
      EXPECT_NEAR(t.last.q[i], -0.5 * 9.81 * 4e-4, 1e-11 * 9.81);
      EXPECT_NEAR(t.last.v[i], -9.81 * 20e-3, 1e-10);
    }
  }
  VoxelSystem system(voxels, {});
  DynamicOptions beyond;
  beyond.scheme = TimeScheme::GeneralisedAlpha;
  beyond.spectralRadius = 1.2;
  const VectorXd zero = VectorXd::Zero(system.size());
  EXPECT_THROW(integrate(system, zero, zero, zero, beyond), BadInput);
}

}  // namespace
}  // namespace glisson::mechanics
