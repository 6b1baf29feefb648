// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/newton_solve.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <numbers>

#include "base/error.h"
#include "base/parallel.h"
#include "mechanics/hyperelastic.h"
#include "mechanics/measures.h"
#include "mechanics/static_solve.h"
#include "scenes.h"

namespace glisson::mechanics {
namespace {

constexpr std::array<LargeDeformationKind, 2> kinds = {LargeDeformationKind::Corotational,
                                                       LargeDeformationKind::Hyperelastic};

/// A cantilever along x, clamped at x = 0, with a dead load along −z spread over the end face.
Problem cantilever(const Eigen::Vector3i& cells, const Eigen::Vector3d& size_m, double E_Pa, double poisson,
                   double load_N) {
  Problem p;
  p.body = test::box(cells, size_m, E_Pa, poisson);
  const VoxelMesh mesh(p.body);
  p.supports.fixations = fix(test::nodesWhere(mesh, [](const Eigen::Vector3d& x) { return x.x() == 0; }));
  const std::vector<Face> end = test::facesWhere(mesh, 1, [](const Eigen::Vector3d&) { return true; });
  p.f_N = tractionForce(mesh, end, Eigen::Vector3d(0, 0, -load_N / (size_m.y() * size_m.z())));
  return p;
}

/// Mean displacement of the end face.
Eigen::Vector3d tip(const Problem& p, const Solution& s) {
  const VoxelMesh mesh(p.body);
  const double L = p.body.cells.x() * p.body.h_m.x();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  const auto nodes = test::nodesWhere(mesh, [&](const Eigen::Vector3d& x) { return x.x() > L - 1e-9; });
  for (const int node : nodes) sum += s.u_m.col(node);
  return sum / static_cast<double>(nodes.size());
}

struct Elastica {
  double drop, shortening;  ///< of the end, relative to the length
};

/// End of an inextensible cantilever under a dead end load, α = P L² / (E I) [bisshopp1945large]: θ'' = −α cos θ with
/// θ(0) = 0, θ'(1) = 0; Runge-Kutta with shooting for θ'(0).
Elastica elastica(double alpha) {
  Elastica end{};
  const auto shoot = [&](double slope) {
    constexpr int n = 4000;
    const double ds = 1.0 / n;
    double theta = 0, rate = slope, x = 0, y = 0;
    for (int i = 0; i < n; ++i) {
      const auto f = [&](double t) { return -alpha * std::cos(t); };
      const double k1 = rate, l1 = f(theta), k2 = rate + ds / 2 * l1, l2 = f(theta + ds / 2 * k1),
                   k3 = rate + ds / 2 * l2, l3 = f(theta + ds / 2 * k2), k4 = rate + ds * l3, l4 = f(theta + ds * k3);
      const double next = theta + ds / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
      const double middle = 0.5 * (theta + next) + ds / 8 * (rate - (rate + ds / 6 * (l1 + 2 * l2 + 2 * l3 + l4)));
      rate += ds / 6 * (l1 + 2 * l2 + 2 * l3 + l4);
      x += ds / 6 * (std::cos(theta) + 4 * std::cos(middle) + std::cos(next));
      y += ds / 6 * (std::sin(theta) + 4 * std::sin(middle) + std::sin(next));
      theta = next;
    }
    end = {y, 1 - x};
    return rate;
  };
  double low = 0, high = 2 * alpha;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (shoot(middle) > 0 ? high : low) = middle;
  }
  return end;
}

TEST(LargeDeformation, TheElasticaOfTheTestIsThePublishedOne) {
  EXPECT_NEAR(elastica(1).drop, 0.30172, 1e-5);
  EXPECT_NEAR(elastica(1).shortening, 0.05643, 1e-5);
  EXPECT_NEAR(elastica(2).drop, 0.49346, 1e-5);
  EXPECT_NEAR(elastica(2).shortening, 0.16064, 1e-5);
  EXPECT_NEAR(elastica(10).drop, 0.81061, 1e-5);
  EXPECT_NEAR(elastica(10).shortening, 0.55500, 1e-5);
}

TEST(LargeDeformation, SlenderCantileverFollowsTheElastica) {
  const Eigen::Vector3d size(0.1, 0.002, 0.004);
  const double EI = 1e5 * size.y() * std::pow(size.z(), 3) / 12;
  for (const LargeDeformationKind kind : kinds)
    for (const double alpha : {1.0, 3.0, 10.0}) {
      const Eigen::Vector3i cells =
          kind == LargeDeformationKind::Corotational ? Eigen::Vector3i(60, 1, 3) : Eigen::Vector3i(150, 1, 6);
      Problem p = cantilever(cells, size, 1e5, 0, alpha * EI / (size.x() * size.x()));
      // Held in its plane: a deep cantilever tips over sideways from alpha 4 on.
      p.supports.fixations.clear();
      const VoxelMesh mesh(p.body);
      for (int node = 0; node < mesh.nodeCount(); ++node) {
        const bool clamped = mesh.position_m(node).x() == 0;
        p.supports.fixations.push_back({node, {clamped, true, clamped}, Eigen::Vector3d::Zero()});
      }
      const Solution s = solveLargeDeformation(p, kind);
      ASSERT_TRUE(s.report.converged()) << s.report.why;
      const Eigen::Vector3d u = tip(p, s) / size.x();
      const Elastica exact = elastica(alpha);
      EXPECT_NEAR(-u.z(), exact.drop, 0.005 * exact.drop) << s.report.why;
      EXPECT_NEAR(-u.x(), exact.shortening, 0.01 * exact.shortening);
      const Solution linear = solveStatic(p);
      if (alpha >= 3) {
        EXPECT_GT(-tip(p, linear).z() / size.x(), 1.5 * exact.drop) << "linear theory is far away here";
      }
    }
}

TEST(LargeDeformation, TendsToLinearTheoryWithTheLoad) {
  for (const LargeDeformationKind kind : kinds)
    for (const double nu : {0.3, 0.49}) {
      SolverOptions options;
      options.tolerance = 1e-12;
      options.element = kind == LargeDeformationKind::Hyperelastic ? HexElement::BBar : HexElement::Incompatible;
      const Problem p = cantilever({12, 3, 3}, {0.05, 0.01, 0.01}, 12e3, nu, 1e-3);
      const Solution linear = solveStatic(p, options);
      double previous = 0;
      for (const double scale : {1e-1, 1e-2, 1e-3, 1e-7}) {
        Problem small = p;
        small.f_N *= scale;
        const Solution s = solveLargeDeformation(small, kind, options);
        ASSERT_TRUE(s.report.converged()) << s.report.why << s.report.residual;
        const double difference = (s.u_m / scale - linear.u_m).norm() / linear.u_m.norm();
        if (scale == 1e-7) {
          EXPECT_LE(difference, 1e-6);
          EXPECT_NEAR(s.energy_J / (scale * scale), linear.energy_J, 1e-5 * linear.energy_J);
        } else if (previous > 0) {
          EXPECT_GT(previous / difference, 9)
              << "the difference falls with the load, the displacement's with its square";
        }
        previous = difference;
      }
    }
}

TEST(LargeDeformation, UniaxialNeoHookeanStretch) {
  constexpr double E = 6e3;
  for (const double nu : {0.0, 0.3, 0.45, 0.49})
    for (const double stress : {-0.4 * E, 0.2 * E, 2.0 * E}) {
      const double mu = E * lameMu(nu), lambda = E * lameLambda(nu);
      // Sides free of stress: µ (b² − 1) + λ ln(a b²) = 0; along the axis µ (a² − 1) + λ ln(a b²) = stress · a.
      const auto root = [](double low, double high, const std::function<double(double)>& rising) {
        for (int i = 0; i < 100; ++i) {
          const double middle = 0.5 * (low + high);
          (rising(middle) > 0 ? high : low) = middle;
        }
        return 0.5 * (low + high);
      };
      const auto lateral = [&](double axial) {
        return root(1e-3, 10, [&](double t) { return mu * (t * t - 1) + lambda * std::log(axial * t * t); });
      };
      const double a = root(0.05, 20, [&](double t) {
        const double side = lateral(t);
        return (mu * (t * t - 1) + lambda * std::log(t * side * side)) / t - stress;
      });
      const double b = lateral(a);
      Problem p;
      p.body = test::box({3, 2, 2}, {0.03, 0.02, 0.02}, E, nu);
      const VoxelMesh mesh(p.body);
      for (int axis = 0; axis < 3; ++axis)
        for (const Fixation& f : fix(test::nodesWhere(mesh, [&](const Eigen::Vector3d& x) { return x[axis] == 0; }),
                                     {axis == 0, axis == 1, axis == 2}))
          p.supports.fixations.push_back(f);
      p.f_N = tractionForce(mesh, test::facesWhere(mesh, 1, [](const Eigen::Vector3d&) { return true; }),
                            Eigen::Vector3d(stress, 0, 0));
      SolverOptions options;
      options.tolerance = 1e-11;
      const Solution s = solveLargeDeformation(p, LargeDeformationKind::Hyperelastic, options);
      ASSERT_TRUE(s.report.converged()) << nu << " " << stress << " " << s.report.why;
      for (int node = 0; node < mesh.nodeCount(); ++node) {
        const Eigen::Vector3d x = mesh.position_m(node);
        EXPECT_LE((s.u_m.col(node) - Eigen::Vector3d((a - 1) * x.x(), (b - 1) * x.y(), (b - 1) * x.z())).norm(),
                  1e-8 * 0.03)
            << nu << " " << stress;
      }
      EXPECT_NEAR(s.reaction_N.row(0).sum(), -stress * 4e-4, 1e-9 * std::abs(stress) * 4e-4);
    }
}

TEST(LargeDeformation, ARigidTurnOfTheSurfaceTurnsTheInside) {
  for (const LargeDeformationKind kind : kinds) {
    Problem p;
    p.body = test::box({4, 4, 4}, {0.04, 0.05, 0.03}, 5e3, 0.45);
    const VoxelMesh mesh(p.body);
    const Eigen::Matrix3d R =
        Eigen::AngleAxisd(80 * std::numbers::pi / 180, Eigen::Vector3d(1, 1, 2).normalized()).toRotationMatrix();
    const auto moved = [&](int node) {
      return Eigen::Vector3d((R - Eigen::Matrix3d::Identity()) * mesh.position_m(node));
    };
    for (const int node : nodesOfFaces(mesh, exteriorFaces(mesh)))
      p.supports.fixations.push_back({node, {true, true, true}, moved(node)});
    p.f_N = NodalField::Zero(3, mesh.nodeCount());
    const Solution s = solveLargeDeformation(p, kind);
    ASSERT_TRUE(s.report.converged()) << s.report.why;
    for (int node = 0; node < mesh.nodeCount(); ++node) EXPECT_LE((s.u_m.col(node) - moved(node)).norm(), 1e-7 * 0.05);
    EXPECT_LE(s.reaction_N.cwiseAbs().maxCoeff(), 1e-7 * 5e3 * 0.05 * 0.05);
  }
}

TEST(LargeDeformation, SolversAgreeAndReactionsBalance) {
  for (const LargeDeformationKind kind : kinds) {
    Problem p = cantilever({16, 6, 6}, {0.05, 0.02, 0.02}, 6e3, 0.45, 0.08);
    test::paint(p.body, [](const Eigen::Vector3d& x, double E) { return x.x() > 0.02 && x.y() < 0.01 ? 3 * E : E; });
    const VoxelMesh mesh(p.body);
    const std::vector<Face> below = test::facesWhere(mesh, 4, [](const Eigen::Vector3d&) { return true; });
    p.supports.springs = faceSprings(mesh, below, 2e4, SpringDirection::Normal);
    Solution first;
    for (const auto& [solver, preconditioner] : {std::pair{SolverKind::Factorised, Preconditioner::None},
                                                 {SolverKind::Multigrid, Preconditioner::None},
                                                 {SolverKind::Cg, Preconditioner::BlockJacobi}}) {
      SolverOptions options;
      options.kind = solver;
      options.preconditioner = preconditioner;
      options.tolerance = 1e-9;
      const Solution s = solveLargeDeformation(p, kind, options);
      ASSERT_TRUE(s.report.converged()) << s.report.kind << s.report.why;
      EXPECT_LE(s.report.residual, 1e-9);
      EXPECT_LE((s.reaction_N.rowwise().sum() + p.f_N.rowwise().sum()).norm(), 1e-7 * 0.08);
      if (first.u_m.size() == 0)
        first = s;
      else
        EXPECT_LE((s.u_m - first.u_m).norm(), 1e-6 * first.u_m.norm());
    }
    EXPECT_GT(first.u_m.cwiseAbs().maxCoeff(), 0.01) << "the case should bend far";
  }
}

TEST(LargeDeformation, SameBitsWithAnyNumberOfThreads) {
  for (const LargeDeformationKind kind : kinds)
    for (const SolverKind solver : {SolverKind::Factorised, SolverKind::Multigrid}) {
      const Problem p = cantilever({13, 6, 6}, {0.05, 0.02, 0.02}, 6e3, 0.45, 0.03);
      SolverOptions options;
      options.kind = solver;
      setThreadCount(1);
      const Solution one = solveLargeDeformation(p, kind, options);
      for (const int threads : {2, 4}) {
        setThreadCount(threads);
        const Solution s = solveLargeDeformation(p, kind, options);
        EXPECT_TRUE(s.u_m == one.u_m && s.reaction_N == one.reaction_N && s.energy_J == one.energy_J);
      }
      setThreadCount(0);
    }
}

TEST(LargeDeformation, StopsHonestlyWhereNoEquilibriumIsLeft) {
  // A corotational bar without Poisson's effect shortens by stress / E: at 1.3 E / 0.5 it would be inside out at 5/13
  // of the load.
  Problem p;
  p.body = test::box({4, 2, 2}, {0.04, 0.02, 0.02}, 5e3, 0);
  const VoxelMesh mesh(p.body);
  for (int node = 0; node < mesh.nodeCount(); ++node)
    p.supports.fixations.push_back({node, {mesh.position_m(node).x() == 0, true, true}, Eigen::Vector3d::Zero()});
  p.f_N = tractionForce(mesh, test::facesWhere(mesh, 1, [](const Eigen::Vector3d&) { return true; }),
                        Eigen::Vector3d(-1.3e4, 0, 0));
  const Solution s = solveLargeDeformation(p, LargeDeformationKind::Corotational);
  EXPECT_EQ(s.report.status, SolveStatus::StoppedAtLimit);
  EXPECT_TRUE(s.u_m.allFinite());
  EXPECT_GE(s.report.residual, 8.0 / 13);
  EXPECT_LE(s.report.residual, 8.0 / 13 + 1.0 / 128);
  EXPECT_THAT(s.report.why, testing::HasSubstr("only 3"));
  // What is given is the equilibrium of that part of the load.
  const double part = 1 - s.report.residual;
  EXPECT_NEAR(s.reaction_N.row(0).sum(), part * 1.3e4 * 4e-4, 1e-6);
  EXPECT_NEAR(s.u_m.row(0).minCoeff(), -part * 2.6 * 0.04, 1e-6 * 0.04);
  EXPECT_EQ(summarise(mesh, s.u_m).invertedCells, 0U);
}

TEST(LargeDeformation, LoadsThatFoldCellsAreGivenUpInBoundedWork) {
  Problem p;
  p.body = test::box({6, 6, 4}, {0.03, 0.03, 0.02}, 5e3, 0.4);
  const VoxelMesh mesh(p.body);
  p.supports.fixations = fix(test::nodesWhere(mesh, [](const Eigen::Vector3d& x) { return x.z() == 0; }));
  p.f_N = tractionForce(mesh, test::facesWhere(mesh, 5, [](const Eigen::Vector3d& x) { return x.x() < 0.015; }),
                        Eigen::Vector3d(0, 0, -3e4));
  for (const LargeDeformationKind kind : kinds) {
    const Solution s = solveLargeDeformation(p, kind);
    EXPECT_EQ(s.report.status, SolveStatus::StoppedAtLimit);
    // 60 iterations of failed attempts and the last attempt; what succeeds comes on top.
    EXPECT_LE(s.report.iterations, 150);
    EXPECT_TRUE(s.u_m.allFinite());
    EXPECT_EQ(summarise(mesh, s.u_m).invertedCells, 0U);
    RecordProperty("iterations", s.report.iterations);
    std::printf("folding load: %d iterations, %.2f s: %s\n", s.report.iterations, s.report.seconds,
                s.report.why.c_str());
  }
}

TEST(LargeDeformation, LoadsAndRefusals) {
  Problem p = cantilever({4, 2, 2}, {0.04, 0.02, 0.02}, 5e3, 0.3, 0.01);
  for (const LargeDeformationKind kind : kinds) {
    Problem none = p;
    none.f_N.setZero();
    const Solution s = solveLargeDeformation(none, kind);
    EXPECT_TRUE(s.report.converged());
    EXPECT_EQ(s.u_m.cwiseAbs().maxCoeff(), 0.0);
    Problem tiny = p;
    tiny.f_N *= 1e-12;
    EXPECT_TRUE(solveLargeDeformation(tiny, kind).report.converged());
    Problem loose = p;
    loose.supports = {};
    EXPECT_THROW(solveLargeDeformation(loose, kind), BadInput);
    Problem bad = p;
    bad.f_N(0, 0) = std::nan("");
    EXPECT_THROW(solveLargeDeformation(bad, kind), BadInput);
    bad.f_N.resize(3, 5);
    EXPECT_THROW(solveLargeDeformation(bad, kind), BadArgument);
  }
}

}  // namespace
}  // namespace glisson::mechanics
