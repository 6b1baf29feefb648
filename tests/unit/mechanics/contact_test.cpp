// SPDX-License-Identifier: GPL-3.0-or-later

// A rigid, frictionless bar against bodies in large deformation.
#include "mechanics/contact/contact_solve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "base/error.h"
#include "base/parallel.h"
#include "contact_scenes.h"
#include "mechanics/contact/contact_setup.h"
#include "mechanics/hyperelastic.h"
#include "mechanics/measures.h"

namespace glisson::mechanics {
namespace {

/// The block of the published comparison with CalculiX: 160 × 60 × 100 mm, E 6.09 kPa, ν .45, a bar of 10 × 80 mm.
ContactProblem comparedBlock(double h_mm) {
  const Eigen::Vector3i cells = (Eigen::Vector3d(160, 60, 100) / h_mm).array().round().cast<int>();
  ContactProblem p = onClampedBlock(box(cells, Eigen::Vector3d::Constant(1e-3 * h_mm), 6090, 0.45), 2);
  p.bar = RigidBar{{{0.04, 0.09, 0.05}, {0.12, 0.09, 0.05}}, 0.005, {0, -1, 0}};
  return p;
}

double depth_mm(const ContactProblem& p, const ContactSolution& s, const Eigen::Vector3d& at_mm) {
  return -1e3 * displacementAt(VoxelMesh(p.problem.body), s.solution.u_m, 1e-3 * at_mm)->y();
}

TEST(CellLaws, ForceIsTheDerivativeOfTheEnergyAndTangentThatOfTheForce) {
  for (const SolidLaw law : {SolidLaw::Polynomial, SolidLaw::Logarithmic, SolidLaw::Linear}) {
    ContactProblem p = onClampedBlock(box({5, 4, 6}, {2e-3, 3e-3, 1.5e-3}, 6090, 0.45), 1);
    p.law = law;
    SolidLevel level = finestLevel(p);
    const std::size_t n = 3 * level.nodes();
    std::mt19937 random(3);
    std::uniform_real_distribution<double> range(-4e-4, 4e-4);
    std::vector<double> u(n), v(n), gradient(n + 1), above(n + 1), below(n + 1);
    for (std::size_t i = 0; i < n; ++i) {
      u[i] = level.active[i] > 0 ? range(random) : 0;
      v[i] = level.active[i] > 0 ? range(random) : 0;
    }
    const double step = 1e-4;
    std::vector<double> up = u, down = u;
    for (std::size_t i = 0; i < n; ++i) {
      up[i] += step * v[i];
      down[i] -= step * v[i];
    }
    double energy = 0, energyUp = 0, energyDown = 0;
    ASSERT_TRUE(level.forces(law, u.data(), energy, gradient.data()));
    ASSERT_TRUE(level.forces(law, up.data(), energyUp, above.data()));
    ASSERT_TRUE(level.forces(law, down.data(), energyDown, below.data()));
    double work = 0;
    for (std::size_t i = 0; i < n; ++i) work += gradient[i] * v[i];
    EXPECT_NEAR((energyUp - energyDown) / (2 * step), work, 1e-6 * std::abs(work));

    level.linearise(law, u.data(), {}, false, Eigen::Vector3d::Zero());
    std::vector<float> x(n + 1, 0.0F), y(n + 1);
    for (std::size_t i = 0; i < n; ++i) x[i] = static_cast<float>(v[i]);
    level.apply(x.data(), y.data(), false);
    double wrong = 0, size = 0;
    for (std::size_t i = 0; i < n; ++i) {
      if (!(level.active[i] > 0)) continue;
      const double d = (above[i] - below[i]) / (2 * step);
      wrong += (d - static_cast<double>(y[i])) * (d - static_cast<double>(y[i]));
      size += d * d;
    }
    EXPECT_LT(std::sqrt(wrong / size), 2e-6);
  }
}

TEST(CellLaws, UniaxialTractionAgreesWithItsClosedForm) {
  // One free bar of cubes, pulled at its end: F = diag(a, b, b), S22 = 0 gives b, S11 the traction.
  for (const SolidLaw law : {SolidLaw::Polynomial, SolidLaw::Logarithmic}) {
    const double E = 10e3, nu = 0.4, mu = E * lameMu(nu), lambda = E * lameLambda(nu), stretch = 1.5;
    const auto volume = [&](double J) {  // dU/dJ of the part beside µ/2 (I1 − 3)
      return law == SolidLaw::Polynomial ? -mu + (lambda + mu) * (J - 1) : (-mu + lambda * std::log(J)) / J;
    };
    double low = 0.3, high = 1.5;
    for (int i = 0; i < 200; ++i) {
      const double b = 0.5 * (low + high);
      (mu * b + volume(stretch * b * b) * stretch * b > 0 ? high : low) = b;
    }
    const double b = 0.5 * (low + high), traction_Pa = mu * stretch + volume(stretch * b * b) * b * b;
    ContactProblem p;
    p.problem.body = box({6, 2, 2}, Eigen::Vector3d::Constant(5e-3), E, nu);
    p.law = law;
    const VoxelMesh mesh(p.problem.body);
    p.problem.f_N = NodalField::Zero(3, mesh.nodeCount());
    for (int n = 0; n < mesh.nodeCount(); ++n) {
      const Eigen::Vector3i at = mesh.latticeOf(n);
      const std::array<bool, 3> held = {at.x() == 0, at.y() == 0, at.z() == 0};
      if (held[0] || held[1] || held[2]) p.problem.supports.fixations.push_back({n, held, {0, 0, 0}});
      const double share = (at.y() % 2 == 0 ? 0.5 : 1) * (at.z() % 2 == 0 ? 0.5 : 1);
      if (at.x() == 6) p.problem.f_N(0, n) = traction_Pa * share * 25e-6;
    }
    ContactOptions options;
    options.tolerance = 1e-9;
    const ContactSolution s = solveContact(p, options);
    ASSERT_TRUE(s.solution.report.converged());
    const double end_m = s.solution.u_m(0, mesh.nodeAt(6, 1, 1));
    EXPECT_NEAR(end_m, (stretch - 1) * 30e-3, 1e-8);
  }
}

TEST(RigidBarContact, AgreesWithCalculixOnABlock) {
  ContactProblem p = comparedBlock(4);
  p.force_N = 4.6;
  const ContactSolution s = solveContact(p);
  ASSERT_TRUE(s.solution.report.converged());
  EXPECT_EQ(s.outcome, ContactOutcome::Reached);
  // CalculiX 2.20, neo-Hookean, rigid cylinder, surface contact: 11.7, 5.27 and 1.78 mm.
  EXPECT_NEAR(depth_mm(p, s, {80, 60, 50}), 11.7, 0.05 * 11.7);
  EXPECT_NEAR(depth_mm(p, s, {80, 40, 50}), 5.27, 0.05 * 5.27);
  EXPECT_NEAR(depth_mm(p, s, {80, 20, 50}), 1.78, 0.06 * 1.78);
  // What the bar exerts is what the pressures add up to, and what the clamp holds.
  EXPECT_NEAR(s.force_N.y(), -4.6, 1e-5);
  EXPECT_NEAR(s.solution.reaction_N.row(1).sum(), 4.6, 1e-4);
  EXPECT_LT(s.penetrationMax_m, 0.5e-3);
  EXPECT_FALSE(s.capacityExceeded);
}

TEST(RigidBarContact, TravelAndForceAreTwoWaysToOneState) {
  ContactProblem p = comparedBlock(5);
  p.force_N = 3.0;
  const ContactSolution byForce = solveContact(p);
  ASSERT_TRUE(byForce.solution.report.converged());
  p.force_N.reset();
  p.travel_m = byForce.travel_m;
  const ContactSolution byTravel = solveContact(p);
  ASSERT_TRUE(byTravel.solution.report.converged());
  EXPECT_NEAR(byTravel.force_N.y(), -3.0, 2e-4);
  EXPECT_LT((byTravel.solution.u_m - byForce.solution.u_m).cwiseAbs().maxCoeff(), 2e-6);
}

TEST(RigidBarContact, TheGridsAxesDoNotMatter) {
  // The same block with its axes turned: x → y → z → x.
  ContactProblem p = comparedBlock(10);
  p.force_N = 2.0;
  const ContactSolution s = solveContact(p);
  const auto turned = [](const Eigen::Vector3d& v) { return Eigen::Vector3d(v.z(), v.x(), v.y()); };
  ContactProblem q;
  q.problem.body = box({10, 16, 6}, Eigen::Vector3d::Constant(0.01), 6090, 0.45);
  const VoxelMesh mesh(q.problem.body);
  q.problem.f_N = NodalField::Zero(3, mesh.nodeCount());
  for (int n = 0; n < mesh.nodeCount(); ++n)
    if (mesh.latticeOf(n).z() == 0) q.problem.supports.fixations.push_back({n, {true, true, true}, {0, 0, 0}});
  for (const SurfaceSample& sample : p.surface)
    q.surface.push_back({turned(sample.p_m), turned(sample.normal), sample.area_m2});
  q.bar = RigidBar{{turned(p.bar->centreline_m[0]), turned(p.bar->centreline_m[1])}, 0.005, turned(p.bar->hoist)};
  q.force_N = 2.0;
  const ContactSolution t = solveContact(q);
  ASSERT_TRUE(s.solution.report.converged() && t.solution.report.converged());
  EXPECT_NEAR(t.travel_m, s.travel_m, 1e-7);
  EXPECT_LT((t.force_N - turned(s.force_N)).norm(), 1e-5);
}

TEST(RigidBarContact, LineContactFollowsHertz) {
  // Plane strain: one layer of cells whose nodes stay in their planes; half width a = R/5.
  const double E = 10e3, nu = 0.3, R = 5e-3, a = 1e-3;
  const double line_N_m = std::numbers::pi * E * a * a / (4 * R * (1 - nu * nu));
  const double thick = 0.25e-3;
  ContactProblem p = onClampedBlock(box({160, 80, 1}, {0.25e-3, 0.25e-3, thick}, E, nu), 2);
  const VoxelMesh mesh(p.problem.body);
  p.problem.supports.fixations.clear();
  for (int n = 0; n < mesh.nodeCount(); ++n) {
    const bool floor = mesh.latticeOf(n).y() == 0;
    p.problem.supports.fixations.push_back({n, {floor, floor, true}, {0, 0, 0}});
  }
  p.law = SolidLaw::Linear;
  p.bar = RigidBar{{{0.02, 0.03, -0.02}, {0.02, 0.03, 0.02}}, R, {0, -1, 0}};
  p.force_N = line_N_m * thick;
  ContactOptions options;
  options.zone_m = 0.02e-3;
  const ContactSolution s = solveContact(p, options);
  ASSERT_TRUE(s.solution.report.converged());
  double force = 0, second = 0;
  for (std::size_t i = 0; i < p.surface.size(); ++i) {
    const double f = s.pressure_Pa[i] * p.surface[i].area_m2, x = p.surface[i].p_m.x() - 0.02;
    force += f;
    second += f * x * x;
  }
  // The pressure of an elliptic contact has the second moment a²/4.
  EXPECT_NEAR(2 * std::sqrt(second / force), a, 0.03 * a);
  EXPECT_NEAR(s.pressureMax_Pa, 2 * line_N_m / (std::numbers::pi * a), 0.03 * 2 * line_N_m / (std::numbers::pi * a));
}

TEST(RigidBarContact, ABarThatIsAskedForTooMuchSlipsAndSaysWhatItBore) {
  // A cantilever that bends under the bar near its end until the bar slides off.
  ContactProblem p;
  p.problem.body = box({24, 4, 4}, Eigen::Vector3d::Constant(2.5e-3), 10e3, 0.4);
  const VoxelMesh mesh(p.problem.body);
  p.problem.f_N = NodalField::Zero(3, mesh.nodeCount());
  for (int n = 0; n < mesh.nodeCount(); ++n)
    if (mesh.latticeOf(n).x() == 0) p.problem.supports.fixations.push_back({n, {true, true, true}, {0, 0, 0}});
  p.surface = topOf(p.problem.body, 2);
  for (int side = 0; side < 4; ++side)  // the end face as well: what the bar slides over
    for (int k = 0; k < 8; ++k)
      for (int j = 0; j < 8; ++j)
        if (side == 0) p.surface.push_back({{60e-3, (j + 0.5) * 1.25e-3, (k + 0.5) * 1.25e-3}, {1, 0, 0}, 1.5625e-6});
  p.bar = RigidBar{{{0.052, 0.05, -0.02}, {0.052, 0.05, 0.03}}, 0.004, {0, -1, 0}};
  p.force_N = 5.0;
  const ContactSolution s = solveContact(p);
  EXPECT_EQ(s.outcome, ContactOutcome::Slips);
  EXPECT_FALSE(s.solution.report.converged());
  EXPECT_TRUE(s.capacityExceeded);
  // Beam theory: 3 E I w / L³ is 5 mN for a deflection of half its length, where the end stands at about 45°.
  EXPECT_GT(s.capacity_N, 1e-3);
  EXPECT_LT(s.capacity_N, 20e-3);
}

TEST(RigidBarContact, TheNumberOfThreadsDoesNotChangeABit) {
  ContactProblem p = comparedBlock(5);
  p.force_N = 2.0;
  setThreadCount(1);
  const ContactSolution one = solveContact(p);
  setThreadCount(3);
  const ContactSolution three = solveContact(p);
  setThreadCount(0);
  EXPECT_EQ(one.travel_m, three.travel_m);
  EXPECT_EQ(one.solution.u_m, three.solution.u_m);
}

TEST(RigidBarContact, ABarThatMeetsNothingIsRefused) {
  ContactProblem p = comparedBlock(10);
  p.bar->centreline_m = {{0.5, 0.09, 0.05}, {0.6, 0.09, 0.05}};
  p.force_N = 1.0;
  EXPECT_THROW(solveContact(p), BadInput);
}

TEST(RigidBar, TheGapOfABentBarHasTheDerivativesItSays) {
  // Beside the arc, over both ends, inside the bar and behind the circle's middle; no point on a border between them.
  RigidBar bar = hook({0.08, 0.02, 0.05}, Eigen::Vector3d(1, 0.2, 0).normalized(),
                      Eigen::Vector3d(-0.2, 1, 0).normalized(), 0.08, std::numbers::pi / 2);
  EXPECT_NEAR((bar.centre_m() - Eigen::Vector3d(0.08, 0.02, 0.05)).norm(), 0, 1e-12);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> range(-0.07, 0.07);
  int besideArc = 0, overEnds = 0;
  for (int i = 0; i < 400; ++i) {
    const Eigen::Vector3d p = bar.centre_m() + Eigen::Vector3d(range(random), range(random), 0.3 * range(random));
    const double s = 0.1 * range(random), step = 1e-6;
    const Gap gap = gapTo(bar, p, s);
    if (gap.rho_m < 2e-3) continue;
    double chords = 1;  // the distance from the drawn line, which lies within 0.06 mm of the arc
    RigidBar drawn = bar;
    drawn.arc.reset();
    chords = gapTo(drawn, p, s).g_m;
    EXPECT_NEAR(gap.g_m, chords, 7e-5);
    bool smooth = true;
    Eigen::Vector3d slope;
    Eigen::Matrix3d curvature;
    for (int c = 0; c < 3; ++c) {
      const Gap up = gapTo(bar, p + step * Eigen::Vector3d::Unit(c), s),
                down = gapTo(bar, p - step * Eigen::Vector3d::Unit(c), s);
      smooth = smooth && up.t.isZero(0) == gap.t.isZero(0) && down.t.isZero(0) == gap.t.isZero(0);
      slope[c] = (up.g_m - down.g_m) / (2 * step);
      curvature.col(c) = (up.n - down.n) / (2 * step);
    }
    if (!smooth) continue;
    ++(gap.t.isZero(0) ? overEnds : besideArc);
    EXPECT_LT((slope - gap.n).norm(), 1e-6);
    EXPECT_LT((curvature - gap.curvature()).norm() / curvature.norm(), 1e-5);
  }
  EXPECT_GT(besideArc, 50);
  EXPECT_GT(overEnds, 50);
}

TEST(RigidBarContact, ABentBladeBearsSmallAndLargeForces) {
  ContactProblem p = comparedBlock(5);
  p.bar = hook({0.08, 0.09, 0.05}, {1, 0, 0}, {0, 0, 1}, 0.08, std::numbers::pi / 2);
  for (const double force_N : {0.01, 0.1, 1.0, 4.6}) {
    p.force_N = force_N;
    const ContactSolution s = solveContact(p);
    ASSERT_TRUE(s.solution.report.converged()) << force_N << " N: " << s.solution.report.residual;
    EXPECT_LE(s.solution.report.residual, 1e-6);
    EXPECT_NEAR(s.force_N.y(), -force_N, 2e-6 * force_N);
  }
}

TEST(RigidBarContact, LoadsBarAndSupportsAreInBalance) {
  // Weight, a pressure that follows a side, springs and a clamp, and a bar that reaches over clamped cells.
  ContactProblem p = comparedBlock(5);
  const VoxelMesh mesh(p.problem.body);
  p.problem.f_N.row(1).setConstant(-2.0 / mesh.nodeCount());
  for (int n = 0; n < mesh.nodeCount(); ++n) {
    const Eigen::Vector3i at = mesh.latticeOf(n);
    if (at.z() == 0 && at.y() > 0) p.problem.supports.springs.push_back({n, 2.0 * Eigen::Matrix3d::Identity()});
    if (at.x() == 0 && at.y() > 0) p.problem.supports.fixations.push_back({n, {true, false, false}, {0, 0, 0}});
  }
  for (int j = 0; j < 12; ++j)
    for (int i = 0; i < 32; ++i) {
      const auto at = [&](int a, int b) { return Eigen::Vector3d(5e-3 * Eigen::Vector3d(i + a, j + b, 20)); };
      p.pressures.push_back({{at(0, 0), at(1, 0), at(1, 1), at(0, 1)}, 100});
    }
  p.bar->centreline_m = {{-0.01, 0.09, 0.05}, {0.07, 0.09, 0.05}};
  p.force_N = 3.0;
  const ContactSolution s = solveContact(p);
  ASSERT_TRUE(s.solution.report.converged());
  EXPECT_NEAR(s.following_N.z(), -100 * 0.16 * 0.06, 0.1);
  const Eigen::Vector3d sum =
      s.force_N + s.following_N + p.problem.f_N.rowwise().sum() + s.solution.reaction_N.rowwise().sum();
  EXPECT_LT(sum.norm(), 1e-5 * 3.0);
}

TEST(RigidBarContact, BodiesThatDifferInScaleAnswerAlikeUnderForcesInProportion) {
  const auto solved = [](double E_Pa) {
    ContactProblem p = comparedBlock(5);
    p.problem.body.E_Pa.assign(p.problem.body.E_Pa.size(), E_Pa);
    p.force_N = 0.5e-3 * E_Pa;
    return solveContact(p);
  };
  const ContactSolution tissue = solved(6e3);
  ASSERT_TRUE(tissue.solution.report.converged());
  for (const double E_Pa : {500.0, 3e3, 20e3, 90e3}) {
    const ContactSolution s = solved(E_Pa);
    ASSERT_TRUE(s.solution.report.converged()) << E_Pa;
    EXPECT_NEAR(s.travel_m, tissue.travel_m, 1e-6) << E_Pa;
  }
}

/// A block of 60 × 30 × 60 mm on a clamp, E 6 kPa, ν .45; a bar of 10 × 50 mm.
ContactProblem thinBlock(double h_mm) {
  const Eigen::Vector3i cells = (Eigen::Vector3d(60, 30, 60) / h_mm).array().round().cast<int>();
  const Eigen::Vector3d h_m = 1e-3 * Eigen::Vector3d(60, 30, 60).cwiseQuotient(cells.cast<double>());
  ContactProblem p = onClampedBlock(box(cells, h_m, 6e3, 0.45), h_mm > 3 ? 4 : 2);
  p.bar = RigidBar{{{0.01, 0.09, 0.03}, {0.05, 0.09, 0.03}}, 0.005, {0, -1, 0}};
  return p;
}

TEST(RigidBarContact, ABarThatIsDrivenIntoABlockBearsOrSaysThatItCuts) {
  for (const double h_mm : {6.0, 5.0, 4.0}) {
    ContactProblem p = thinBlock(h_mm);
    p.travel_m = 24e-3;
    const ContactSolution s = solveContact(p);
    const bool answered = s.outcome == ContactOutcome::Reached;
    EXPECT_EQ(answered, s.solution.report.converged());
    // The block bears some 5 N at 16 mm, and stiffens as the bar comes near the clamp.
    if (answered)
      EXPECT_GT(s.force_N.norm(), 5.0) << h_mm << " mm";
    else
      EXPECT_TRUE(s.outcome == ContactOutcome::Cuts || s.outcome == ContactOutcome::Folds) << h_mm << " mm";
  }
}

TEST(RigidBarContact, AForceThatFallsForAWhileIsNoSlip) {
  ContactProblem p = thinBlock(6);
  p.travel_m = 20e-3;
  const ContactSolution driven = solveContact(p);
  ASSERT_TRUE(driven.solution.report.converged());
  ASSERT_GT(driven.force_N.norm(), 5.0);
  p.travel_m.reset();
  p.force_N = 4.5;
  const ContactSolution pushed = solveContact(p);
  ASSERT_TRUE(pushed.solution.report.converged());
  EXPECT_NEAR(pushed.force_N.norm(), 4.5, 1e-4);
  EXPECT_LT(pushed.travel_m, driven.travel_m);
}

TEST(RigidBarContact, WhatTheBarSpendsIsTheEnergyOfTheBody) {
  ContactProblem p = comparedBlock(5);
  p.force_N = 4.0;
  const ContactSolution s = solveContact(p);
  ASSERT_TRUE(s.solution.report.converged());
  double work_J = 0;
  for (std::size_t i = 1; i + 1 < s.path.size(); ++i)
    work_J += 0.5 * (s.path[i].force_N + s.path[i - 1].force_N) * (s.path[i].travel_m - s.path[i - 1].travel_m);
  // The path goes on to the first step beyond the force; the last part of it is left out.
  const PathStep last = s.path[s.path.size() - 2];
  work_J += 0.5 * (last.force_N + 4.0) * (s.travel_m - last.travel_m);
  EXPECT_NEAR(s.solution.energy_J, work_J, 0.05 * work_J);
}

}  // namespace
}  // namespace glisson::mechanics
