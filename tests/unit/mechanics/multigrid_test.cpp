// SPDX-License-Identifier: GPL-3.0-or-later

// The multigrid's bounds, its definiteness and its iterations over elements, Poisson's ratios, shapes and contrasts.
#include "mechanics/multigrid.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "base/random.h"
#include "mechanics/krylov.h"
#include "mechanics/multigrid_level.h"
#include "mechanics/spectral_bound.h"
#include "mechanics/static_solve.h"
#include "scenes.h"

namespace glisson::mechanics {
namespace {

using Eigen::Vector3d;

constexpr HexElement everyElement[] = {HexElement::H8, HexElement::BBar, HexElement::Incompatible};

struct Shape {
  const char* name;
  Eigen::Vector3i cells;
  Vector3d size;
  std::function<double(const Vector3d&)> E;
};

std::vector<Shape> shapes() {
  const auto one = [](const Vector3d&) { return 1.0; };
  const auto smooth = [](const Vector3d& x) {
    return std::exp2(std::sin(8 * x.x()) * std::cos(6 * x.y() + 3 * x.z()));
  };
  const auto ball = [](double contrast) {
    return [contrast](const Vector3d& x) { return (x - Vector3d(0.42, 0.55, 0.5)).norm() < 0.25 ? contrast : 1.0; };
  };
  const auto noise = [random = Random(3)](const Vector3d&) mutable { return std::pow(10.0, random.uniform(-2, 2)); };
  const auto holes = [random = Random(4)](const Vector3d&) mutable { return random.uniform() < 0.3 ? 0.0 : 1.0; };
  const auto round = [](const Vector3d& x) { return (x - Vector3d::Constant(0.5)).norm() < 0.5 ? 1.0 : 0.0; };
  return {{"box", {16, 16, 16}, {1, 1, 1}, one},
          {"varied box", {18, 14, 16}, {1, 1, 1}, smooth},
          {"flat cells", {14, 14, 6}, {1, 1, 1.7}, one},
          {"long cells", {5, 14, 14}, {1, 1, 1}, one},
          {"stiff ball", {16, 16, 16}, {1, 1, 1}, ball(1e3)},
          {"soft ball", {16, 16, 16}, {1, 1, 1}, ball(1e-3)},
          {"noise", {14, 14, 14}, {1, 1, 1}, noise},
          {"holes", {14, 14, 14}, {1, 1, 1}, holes},
          {"round", {15, 15, 15}, {1, 1, 1}, round},
          {"thin", {40, 6, 1}, {4, 0.6, 0.1}, one}};
}

MultigridLevel levelOf(const Shape& shape, HexElement element, double poisson) {
  VoxelBody body = test::box(shape.cells, shape.size, 1.0, poisson);
  test::paint(body, [&](const Vector3d& x, double) { return shape.E(x); });
  MultigridLevel level =
      makeLevel({body.cells, body.h_m / std::cbrt(body.h_m.prod()), body.E_Pa, {}}, element, poisson);
  // Some held degrees of freedom, some springs.
  for (std::size_t f = 0; f < level.exact.size() / 9; f += 7) level.exact.fixed.push_back(f);
  for (std::size_t s = 1; s < level.exact.lattice->nodeSlots() / 4; s += 5)
    level.exact.springs.push_back({s, {0.5, 0.4, 0.3, 0.6, 0.2, 0.7}});
  level.finish();
  return level;
}

/// Largest eigenvalue of D⁻¹ A by 120 Lanczos steps in double.
double largestEigenvalue(const MultigridLevel& level) {
  const std::size_t n = level.exact.size();
  std::vector<double> s(n), v(n), w(n, 0.0), x(n), y(n);
  Random random(99);
  for (std::size_t i = 0; i < n; ++i) {
    s[i] = std::sqrt(static_cast<double>(level.inverseDiagonal[i]));
    v[i] = s[i] > 0 ? random.normal() : 0.0;
  }
  std::vector<double> a, b;
  double length = norm(v);
  for (int step = 0; step < 120 && length > 1e-9; ++step) {
    for (std::size_t i = 0; i < n; ++i) x[i] = s[i] * (v[i] /= length);
    level.exact.apply(x.data(), y.data());
    a.push_back(dot(x, y));
    for (std::size_t i = 0; i < n; ++i) w[i] = s[i] * y[i] - a.back() * v[i] - (b.empty() ? 0.0 : b.back()) * w[i];
    b.push_back(length = norm(w));
    std::swap(v, w);
  }
  const auto count = static_cast<Eigen::Index>(a.size());
  Eigen::MatrixXd T = Eigen::MatrixXd::Zero(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    T(i, i) = a[static_cast<std::size_t>(i)];
    if (i + 1 < count) T(i, i + 1) = T(i + 1, i) = b[static_cast<std::size_t>(i)];
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(T, Eigen::EigenvaluesOnly).eigenvalues()[count - 1];
}

TEST(Multigrid, BoundsLieAboveTheLargestEigenvalueAndNotFarAbove) {
  for (const Shape& shape : shapes())
    for (const HexElement element : everyElement)
      for (const double nu : {0.3, 0.45, 0.4999}) {
        MultigridLevel level = levelOf(shape, element, nu);
        const double truth = largestEigenvalue(level);
        level.bound(true);
        EXPECT_GE(level.lambdaMax, truth * (1 - 1e-6)) << shape.name << ", " << static_cast<int>(element) << ", " << nu;
        level.bound(false);
        EXPECT_GE(level.lambdaMax, truth * (1 - 1e-6)) << shape.name << ", " << static_cast<int>(element) << ", " << nu;
        EXPECT_LE(level.lambdaMax, 1.2 * truth + 0.5) << shape.name << ", " << static_cast<int>(element) << ", " << nu;
      }
}

TEST(Multigrid, TheBoundOverCellsIsReachedByAStiffCellInASoftBody) {
  for (const HexElement element : everyElement) {
    const Shape lonely{"lonely", {9, 9, 9}, {1, 1, 1}, [](const Vector3d& x) {
                         return (x - Vector3d::Constant(0.5)).norm() < 0.05 ? 1.0 : 1e-4;
                       }};
    MultigridLevel level = levelOf(lonely, element, 0.45);
    level.bound(true);
    EXPECT_NEAR(largestEigenvalue(level), level.lambdaMax, 0.01 * level.lambdaMax);
  }
}

Problem clampedBox(int n, double poisson, const std::function<double(const Vector3d&)>& E) {
  Problem p;
  p.body = test::box({n, n, n}, {0.1, 0.1, 0.1}, 1, poisson);
  test::paint(p.body, [&](const Vector3d& c, double) { return 6e3 * E(c / 0.1); });
  const VoxelMesh mesh(p.body);
  const auto always = [](const Vector3d&) { return true; };
  p.supports.fixations = fix(nodesOfFaces(mesh, test::facesWhere(mesh, 4, always)));
  p.f_N = tractionForce(mesh, test::facesWhere(mesh, 5, always), Vector3d(100, 50, 30));
  return p;
}

TEST(Multigrid, ACycleIsSymmetricPositiveDefinite) {
  const auto varied = [random = Random(8)](const Vector3d&) mutable { return std::pow(10.0, random.uniform(-1, 1)); };
  for (const HexElement element : everyElement)
    for (const double nu : {0.3, 0.45, 0.4999}) {
      const Problem p = clampedBox(17, nu, varied);
      const VoxelOperator op(p.body, element, p.supports);
      Multigrid multigrid(op);
      Random random(6);
      const std::size_t n = op.lattice().size();
      std::vector<double> a(n), b(n), Ba(n), Bb(n);
      std::vector<float> z;
      NodalField field(3, op.mesh().nodeCount());
      const auto fill = [&](std::vector<double>& v) {
        for (Eigen::Index i = 0; i < field.size(); ++i) field(i) = random.normal();
        op.project(field);
        op.toSlots(field, v.data());
      };
      for (int trial = 0; trial < 4; ++trial) {
        fill(a);
        fill(b);
        // Rough and smooth ones: those that the cycle has been over already have lost what it handles best.
        for (int pass = 0; pass < 3; ++pass) {
          multigrid.cycle(a, z);
          Ba.assign(z.begin(), z.end());
          multigrid.cycle(b, z);
          Bb.assign(z.begin(), z.end());
          EXPECT_GT(dot(a, Ba), 0.0);
          EXPECT_GT(dot(b, Bb), 0.0);
          EXPECT_NEAR(dot(a, Bb), dot(b, Ba), 1e-4 * std::sqrt(dot(a, Ba) * dot(b, Bb)));
          std::vector<double> AB(n);
          op.lattice().apply(Ba.data(), AB.data());
          for (std::size_t i = 0; i < n; ++i) a[i] -= AB[i];
          op.lattice().apply(Bb.data(), AB.data());
          for (std::size_t i = 0; i < n; ++i) b[i] -= AB[i];
        }
      }
    }
}

/// Iterations to 1e-6 on a clamped box; fails where the solve does not converge.
int iterationsOf(const Problem& p, HexElement element) {
  SolverOptions o;
  o.kind = SolverKind::Multigrid;
  o.element = element;
  o.tolerance = 1e-6;
  const SolveReport r = solveStatic(p, o).report;
  EXPECT_TRUE(r.converged()) << describe(r.status) << " after " << r.iterations << " iterations, residual "
                             << r.residual;
  return r.iterations;
}

TEST(Multigrid, ConvergesOverElementsPoissonsRatiosAndContrasts) {
  const auto one = [](const Vector3d&) { return 1.0; };
  const auto smooth = [](const Vector3d& x) {
    return std::exp2(std::sin(8 * x.x()) * std::cos(6 * x.y() + 3 * x.z()));
  };
  const auto ball = [](double contrast) {
    return [contrast](const Vector3d& x) { return (x - Vector3d(0.42, 0.55, 0.5)).norm() < 0.25 ? contrast : 1.0; };
  };
  for (const HexElement element : everyElement)
    for (const double nu : {0.0, 0.3, 0.4, 0.45, 0.49}) {
      EXPECT_LE(iterationsOf(clampedBox(17, nu, one), element), 30) << nu;
      EXPECT_LE(iterationsOf(clampedBox(17, nu, smooth), element), 30) << nu;
      EXPECT_LE(iterationsOf(clampedBox(17, nu, ball(10)), element), 30) << nu;
      // A power iteration falls short of the largest eigenvalue on bodies of this size.
      if (nu > 0.3 && nu < 0.46) {
        EXPECT_LE(iterationsOf(clampedBox(32, nu, one), element), 30) << nu;
      }
    }
  for (const HexElement element : everyElement) {
    for (const double contrast : {1e-6, 1e3, 1e6})
      EXPECT_LE(iterationsOf(clampedBox(16, 0.3, ball(contrast)), element), 60) << contrast;
    for (const double nu : {0.495, 0.499}) EXPECT_LE(iterationsOf(clampedBox(16, nu, one), element), 60) << nu;
    EXPECT_LE(iterationsOf(clampedBox(16, 0.4999, one), element), 250);
  }
}

TEST(Multigrid, StrongContrastTakesALargerCoarsestLevelOrALongerSmoother) {
  // Layers of four cells, which the usual coarsest level of 4³ cells mixes; a modulus of its own for every cell.
  const auto layers = [](const Vector3d& x) { return static_cast<int>(8 * x.z()) % 2 == 0 ? 1.0 : 1e3; };
  const auto noise = [random = Random(3)](const Vector3d&) mutable { return std::pow(10.0, random.uniform(-3, 3)); };
  for (const double nu : {0.3, 0.49}) EXPECT_LE(iterationsOf(clampedBox(32, nu, layers), HexElement::Incompatible), 60);
  EXPECT_LE(iterationsOf(clampedBox(32, 0.3, noise), HexElement::Incompatible), 65);
}

TEST(Multigrid, ALongerSmootherStaysWithinItsBounds) {
  const Problem p = clampedBox(17, 0.45, [](const Vector3d&) { return 1.0; });
  const VoxelOperator op(p.body, HexElement::Incompatible, p.supports);
  Multigrid multigrid(op);
  const int degree = multigrid.degree();
  EXPECT_FALSE(multigrid.lengthen(1.0));
  EXPECT_TRUE(multigrid.lengthen(2.0));
  EXPECT_EQ(multigrid.degree(), 2 * degree);
  EXPECT_TRUE(multigrid.lengthen(1e3));
  EXPECT_EQ(multigrid.degree(), MultigridOptions::longest);
  EXPECT_FALSE(multigrid.lengthen(2.0));
}

}  // namespace
}  // namespace glisson::mechanics
