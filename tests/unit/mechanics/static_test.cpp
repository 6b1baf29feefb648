// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/static_solve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "mechanics/measures.h"
#include "scenes.h"

namespace glisson::mechanics {
namespace {

const std::array<HexElement, 3> elements = {HexElement::H8, HexElement::BBar, HexElement::Incompatible};

bool always(const Eigen::Vector3d&) {
  return true;
}

/// Force and moment about the origin.
Eigen::Matrix<double, 6, 1> resultant(const VoxelMesh& mesh, const NodalField& f) {
  Eigen::Matrix<double, 6, 1> total = Eigen::Matrix<double, 6, 1>::Zero();
  for (int node = 0; node < mesh.nodeCount(); ++node) {
    total.head<3>() += f.col(node);
    total.tail<3>() += mesh.position_m(node).cross(f.col(node));
  }
  return total;
}

SolverOptions sharp(double tolerance = 1e-12, SolverKind kind = SolverKind::Auto) {
  SolverOptions o;
  o.tolerance = tolerance;
  o.kind = kind;
  return o;
}

TEST(StaticSolve, PatchTestHoldsForAllElementsAndFlatCells) {
  Eigen::Matrix3d A;
  A << 0.01, 0.02, -0.03, 0.04, -0.02, 0.01, -0.01, 0.03, 0.02;
  for (const HexElement element : elements)
    for (const Eigen::Vector3d& h :
         {Eigen::Vector3d(1.64e-3, 1.64e-3, 1.64e-3), Eigen::Vector3d(1.64e-3, 1.64e-3, 10e-3)})
      for (const double nu : {0.3, 0.499}) {
        Problem p;
        p.body = test::box({5, 4, 4}, h.cwiseProduct(Eigen::Vector3d(5, 4, 4)), 3e3, nu);
        const VoxelMesh mesh(p.body);
        const auto onSurface = nodesOfFaces(mesh, exteriorFaces(mesh));
        for (const int node : onSurface)
          p.supports.fixations.push_back({node, {true, true, true}, A * mesh.position_m(node)});
        p.f_N = NodalField::Zero(3, mesh.nodeCount());
        SolverOptions options = sharp();
        options.element = element;
        const Solution s = solveStatic(p, options);
        ASSERT_TRUE(s.report.converged());
        double worst = 0;
        for (int node = 0; node < mesh.nodeCount(); ++node)
          worst = std::max(worst, (s.u_m.col(node) - A * mesh.position_m(node)).norm());
        EXPECT_LE(worst, 1e-10 * s.u_m.cwiseAbs().maxCoeff());
      }
}

/// Bar of 50 × 10 × 10 mm along x at ν = 0, clamped at x−, pulled at x+ by 1 mN.
Problem bar(const std::function<double(const Eigen::Vector3d&)>& E, const Eigen::Vector3i& n = {20, 4, 4}) {
  Problem p;
  p.body = test::box(n, {0.05, 0.01, 0.01}, 12e3, 0.0);
  test::paint(p.body, [&](const Eigen::Vector3d& c, double) { return E(c); });
  const VoxelMesh mesh(p.body);
  p.supports.fixations = fix(nodesOfFaces(mesh, test::facesWhere(mesh, 0, always)));
  p.f_N = tractionForce(mesh, test::facesWhere(mesh, 1, always), Eigen::Vector3d(1e-3 / 1e-4, 0, 0));
  return p;
}

TEST(StaticSolve, SeriesBarIsExactUpToAContrastOfAMillion) {
  for (const SolverKind kind : {SolverKind::Auto, SolverKind::Factorised, SolverKind::Multigrid})
    for (const auto& [contrast, expected_um] :
         {std::pair{1.0, 41.6667}, {1e2, 21.0417}, {1e4, 20.8354}, {1e6, 20.8334}}) {
      const Problem p = bar([c = contrast](const Eigen::Vector3d& x) { return x.x() < 0.025 ? 12e3 : c * 12e3; });
      const double exact = 1e-3 * 0.025 / (1e-4 * 12e3) * (1 + 1 / contrast);
      ASSERT_NEAR(1e6 * exact, expected_um, 1e-4);
      const Solution s = solveStatic(p, sharp(1e-13, kind));
      for (const int node : test::nodesWhere(VoxelMesh(p.body), [](const auto& x) { return x.x() > 0.0499; })) {
        EXPECT_NEAR(s.u_m(0, node), exact, 1e-10 * exact) << "contrast " << contrast << ", " << s.report.kind;
        EXPECT_LE(std::abs(s.u_m(1, node)), 1e-10 * exact);
      }
    }
}

TEST(StaticSolve, ParallelBarTakesTheMeanModulusUnderPrescribedStretch) {
  Problem p = bar([](const Eigen::Vector3d& x) { return x.z() < 0.005 ? 1e3 : 9e3; });
  const VoxelMesh mesh(p.body);
  p.f_N.setZero();
  for (const int node : test::nodesWhere(mesh, [](const auto& x) { return x.x() > 0.0499; }))
    p.supports.fixations.push_back({node, {true, false, false}, Eigen::Vector3d(1e-3, 0, 0)});
  const Solution s = solveStatic(p, sharp());
  const double force = 5e3 * 1e-4 * 1e-3 / 0.05;
  double pulled = 0;
  for (int node = 0; node < mesh.nodeCount(); ++node)
    if (mesh.position_m(node).x() > 0.0499) pulled += s.reaction_N(0, node);
  EXPECT_NEAR(pulled, force, 1e-10 * force);
  EXPECT_NEAR(s.energy_J, 0.5 * force * 1e-3, 1e-10 * force * 1e-3);
  EXPECT_LE(resultant(mesh, s.reaction_N).head<3>().norm(), 1e-10 * force);
}

TEST(StaticSolve, HangingBarStretchesByItsWeight) {
  Problem p = bar([](const Eigen::Vector3d&) { return 12e3; });
  const VoxelMesh mesh(p.body);
  p.f_N = bodyForce(mesh, Eigen::Vector3d(1000 * 9.81, 0, 0));
  const double exact = 1000 * 9.81 * 0.05 * 0.05 / (2 * 12e3);
  ASSERT_NEAR(exact, 1.0219e-3, 5e-8);
  const Solution s = solveStatic(p, sharp());
  for (const int node : test::nodesWhere(mesh, [](const auto& x) { return x.x() > 0.0499; }))
    EXPECT_NEAR(s.u_m(0, node), exact, 1e-10 * exact);
}

/// A lumpy body on a spring foundation and a few fixed nodes, pulled and pressed.
Problem lumpy(const Eigen::Vector3i& n, double decades, double nu = 0.45) {
  Problem p;
  p.body = test::box(n, 1.64e-3 * n.cast<double>(), 6e3, nu);
  Random random(21);
  const Eigen::Vector3d middle = 0.5 * 1.64e-3 * n.cast<double>();
  test::paint(p.body, [&](const Eigen::Vector3d& c, double) {
    if ((c - middle).cwiseQuotient(middle).norm() > 1.05) return 0.0;
    return 6e3 * std::pow(10.0, random.uniform(-0.5, 0.5) * decades);
  });
  const VoxelMesh mesh(p.body);
  const auto back = test::facesWhere(mesh, 3, [&](const auto& c) { return c.y() > middle.y(); });
  p.supports.springs = faceSprings(mesh, back, 0.2 * N_m3_per_kPa_mm);
  p.supports.fixations =
      fix(nodesOfFaces(mesh, test::facesWhere(mesh, 4, [&](const auto& c) { return c.z() < 2e-3; })));
  p.f_N = pressureForce(mesh, test::facesWhere(mesh, 2, always), 100) + bodyForce(mesh, Eigen::Vector3d(0, 0, -1e3));
  return p;
}

TEST(StaticSolve, ReactionsBalanceTheLoad) {
  for (const SolverKind kind : {SolverKind::Factorised, SolverKind::Multigrid, SolverKind::Cg}) {
    const Problem p = lumpy({14, 12, 11}, 2);
    const VoxelMesh mesh(p.body);
    const Solution s = solveStatic(p, sharp(1e-12, kind));
    ASSERT_TRUE(s.report.converged()) << s.report.kind << " " << s.report.residual;
    const auto load = resultant(mesh, p.f_N);
    const auto total = resultant(mesh, p.f_N + s.reaction_N);
    EXPECT_LE(total.head<3>().norm(), 1e-10 * load.head<3>().norm());
    EXPECT_LE(total.tail<3>().norm(), 1e-10 * load.tail<3>().norm());
    EXPECT_NEAR(s.energy_J, 0.5 * p.f_N.cwiseProduct(s.u_m).sum(), 1e-10 * s.energy_J);
  }
}

constexpr double sphereInner_m = 0.02;
constexpr double sphereOuter_m = 0.05;

/// Mean radial displacement at three radii of a thick sphere (E 3 kPa, ν .45) under 100 Pa inside: one octant, n cells
/// per 50 mm, symmetry planes.
Eigen::Vector3d thickSphere_m(int n, const Eigen::Vector3d& radii_m) {
  const double h = sphereOuter_m / n;
  Problem p;
  p.body = test::box({n, n, n}, Eigen::Vector3d::Constant(sphereOuter_m), 3e3, 0.45);
  test::paint(p.body, [](const Eigen::Vector3d& c, double E) {
    return c.norm() > sphereInner_m && c.norm() < sphereOuter_m ? E : 0.0;
  });
  const VoxelMesh mesh(p.body);
  for (int axis = 0; axis < 3; ++axis) {
    std::array<bool, 3> held = {false, false, false};
    held[static_cast<std::size_t>(axis)] = true;
    for (const int node : test::nodesWhere(mesh, [&](const auto& x) { return x[axis] < 0.1 * h; }))
      p.supports.fixations.push_back({node, held, Eigen::Vector3d::Zero()});
  }
  std::vector<Face> inner;
  for (const Face& face : exteriorFaces(mesh)) {
    const Eigen::Vector3d c = faceCentre_m(mesh, face);
    const bool onSymmetryPlane = face.side % 2 == 0 && c[face.side / 2] < 0.1 * h;
    if (!onSymmetryPlane && c.norm() < 0.5 * (sphereInner_m + sphereOuter_m)) inner.push_back(face);
  }
  p.f_N = pressureForce(mesh, inner, 100);
  const Solution s = solveStatic(p, sharp(1e-8));
  EXPECT_TRUE(s.report.converged());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (int r = 0; r < 3; ++r)
    for (int i = 0; i < 20; ++i)
      for (int j = 0; j < 20; ++j) {  // equal areas: uniform in cos θ and φ
        const double z = (i + 0.5) / 20;
        const double phi = (j + 0.5) / 20 * std::numbers::pi / 2;
        const double xy = std::sqrt(1 - z * z);
        const Eigen::Vector3d direction(xy * std::cos(phi), xy * std::sin(phi), z);
        const auto u = displacementAt(mesh, s.u_m, radii_m[r] * direction);
        EXPECT_TRUE(u.has_value());
        if (u) mean[r] += u->dot(direction) / 400;
      }
  return mean;
}

TEST(StaticSolve, ThickSphereUnderPressureWithinOnePercent) {
  const double a3 = std::pow(sphereInner_m, 3);
  const double b3 = std::pow(sphereOuter_m, 3);
  const Eigen::Vector3d radii(sphereInner_m, 0.03, sphereOuter_m);
  const Eigen::Vector3d exact =
      (100 / 3e3 * a3 / (b3 - a3) * (0.1 * radii.array() + 1.45 * b3 / (2 * radii.array().square()))).matrix();
  ASSERT_NEAR(exact[0], 0.52094e-3, 1e-8);
  ASSERT_NEAR(exact[2], 0.09402e-3, 1e-8);
  // A staircase surface converges with first order: each mesh carries its error, two together take most of it away.
  const Eigen::Vector3d coarse = thickSphere_m(40, radii);
  const Eigen::Vector3d fine = thickSphere_m(80, radii);
  for (int r = 0; r < 3; ++r) {
    EXPECT_NEAR(coarse[r], exact[r], 0.03 * exact[r]) << radii[r];
    EXPECT_NEAR(fine[r], exact[r], 0.015 * exact[r]) << radii[r];
    EXPECT_NEAR(2 * fine[r] - coarse[r], exact[r], 0.01 * exact[r]) << radii[r];
  }
}

TEST(StaticSolve, ConvergesWithSecondOrder) {
  // Manufactured u = v sin πx sin πy sin πz on the unit cube, u = 0 on its surface; −div σ integrated by 3 × 3 × 3
  // Gauss.
  const double nu = 0.3;
  const double lambda = nu / ((1 + nu) * (1 - 2 * nu));
  const double mu = 0.5 / (1 + nu);
  const Eigen::Vector3d v(1, 0.5, -0.7);
  constexpr double pi = std::numbers::pi;
  const auto phi = [](const Eigen::Vector3d& x) {
    return std::sin(pi * x.x()) * std::sin(pi * x.y()) * std::sin(pi * x.z());
  };
  const auto force = [&](const Eigen::Vector3d& x) {
    Eigen::Matrix3d hessian;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const int k = 3 - i - j;
        hessian(i, j) =
            i == j ? -pi * pi * phi(x) : pi * pi * std::cos(pi * x[i]) * std::cos(pi * x[j]) * std::sin(pi * x[k]);
      }
    return Eigen::Vector3d(3 * pi * pi * mu * phi(x) * v - (lambda + mu) * hessian * v);
  };
  for (const HexElement element : elements) {
    double previous = 0;
    for (const int n : {6, 12, 24}) {
      Problem p;
      p.body = test::box({n, n, n}, {1, 1, 1}, 1, nu);
      const VoxelMesh mesh(p.body);
      p.supports.fixations = fix(nodesOfFaces(mesh, exteriorFaces(mesh)));
      p.f_N = NodalField::Zero(3, mesh.nodeCount());
      const std::array<double, 3> point = {-std::sqrt(0.6), 0, std::sqrt(0.6)};
      const std::array<double, 3> weight = {5.0 / 18, 8.0 / 18, 5.0 / 18};
      for (int e = 0; e < mesh.cellCount(); ++e)
        for (std::size_t g = 0; g < 27; ++g) {
          const Eigen::Vector3d xi(point[g % 3], point[g / 3 % 3], point[g / 9]);
          const Eigen::Vector3d x = (mesh.cellOf(e).cast<double>() + 0.5 * (xi + Eigen::Vector3d::Ones())) / n;
          const double w = weight[g % 3] * weight[g / 3 % 3] * weight[g / 9] / (n * n * n);
          const auto N = hexShape(xi);
          for (int a = 0; a < 8; ++a) p.f_N.col(mesh.nodesOf(e)[static_cast<std::size_t>(a)]) += w * N[a] * force(x);
        }
      SolverOptions options = sharp(1e-10);
      options.element = element;
      const Solution s = solveStatic(p, options);
      double sum = 0;
      for (int node = 0; node < mesh.nodeCount(); ++node)
        sum += (s.u_m.col(node) - phi(mesh.position_m(node)) * v).squaredNorm();
      const double error = std::sqrt(sum / mesh.nodeCount());
      if (previous > 0) {
        EXPECT_GT(std::log2(previous / error), 1.85) << n;
        EXPECT_LT(std::log2(previous / error), 2.3) << n;
      }
      previous = error;
    }
  }
}

TEST(StaticSolve, ScalesWithTheLoadAndGivesExactlyZeroForNone) {
  for (const SolverKind kind : {SolverKind::Factorised, SolverKind::Multigrid, SolverKind::Cg}) {
    Problem p = lumpy({14, 12, 11}, 1);
    StaticSolver solver(p.body, p.supports, sharp(1e-11, kind));
    const Solution one = solver.solve(p.f_N);
    for (const double factor : {1e-15, 1e-3, 1e15}) {
      const Solution s = solver.solve(factor * p.f_N);
      EXPECT_LE((s.u_m / factor - one.u_m).norm(), 1e-10 * one.u_m.norm());
      EXPECT_TRUE(s.report.converged());
    }
    const Solution none = solver.solve(0 * p.f_N);
    EXPECT_EQ(none.u_m.cwiseAbs().maxCoeff(), 0.0);
    EXPECT_EQ(none.reaction_N.cwiseAbs().maxCoeff(), 0.0);
    EXPECT_TRUE(none.report.converged());
  }
}

TEST(StaticSolve, UnitsDoNotMatter) {
  const Problem metres = lumpy({12, 12, 11}, 1);
  Problem millimetres = metres;  // lengths × 1e3 and moduli × 1e-3: the products that make up K are the same
  millimetres.body.h_m *= 1e3;
  for (double& E : millimetres.body.E_Pa) E *= 1e-3;
  const Solution a = solveStatic(metres, sharp(1e-13));
  const Solution b = solveStatic(millimetres, sharp(1e-13));
  EXPECT_LE((a.u_m - b.u_m).norm(), 1e-10 * a.u_m.norm());
}

}  // namespace
}  // namespace glisson::mechanics
