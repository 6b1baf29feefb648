// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "mechanics/beam.h"
#include "mechanics/static_solve.h"
#include "scenes.h"

namespace glisson::mechanics {
namespace {

bool always(const Eigen::Vector3d&) {
  return true;
}

SolverOptions with(SolverKind kind, double tolerance) {
  SolverOptions o;
  o.kind = kind;
  o.tolerance = tolerance;
  return o;
}

/// The study's cantilever, fully clamped at x = 0, bent along −z by a body force with an Euler-Bernoulli tip of 1 mm.
Problem cantilever(const Eigen::Vector3i& n, double nu) {
  Problem p;
  p.body = test::box(n, {0.05, 0.01, 0.01}, 12e3, nu);
  const VoxelMesh mesh(p.body);
  p.supports.fixations = fix(test::nodesWhere(mesh, [](const auto& x) { return x.x() < 1e-9; }));
  const Cantilever beam;
  p.f_N = bodyForce(mesh, Eigen::Vector3d(0, 0, -loadForTip_N_m(beam, 1e-3) / beam.area_m2()));
  return p;
}

/// Deflection at the middle of the end face.
double tip_mm(const Problem& p, const SolverOptions& options) {
  const VoxelMesh mesh(p.body);
  const Solution s = solveStatic(p, options);
  EXPECT_TRUE(s.report.converged()) << s.report.kind << ", " << s.report.residual;
  return -1e3 * s.u_m(2, mesh.nodeAt(p.body.cells.x(), p.body.cells.y() / 2, p.body.cells.z() / 2));
}

SolverOptions element(HexElement e) {
  SolverOptions o = with(SolverKind::Auto, 1e-9);
  o.element = e;
  return o;
}

TEST(Beam, ClosedForms) {
  const Cantilever beam;
  const double f = loadForTip_N_m(beam, 1e-3);
  EXPECT_NEAR(eulerBernoulliDeflection_m(beam, f, 0.05), 1e-3, 1e-18);
  EXPECT_EQ(eulerBernoulliDeflection_m(beam, f, 0), 0.0);
  for (const auto& [nu, tip] : {std::pair{0.0, 1.0320}, {0.3, 1.0408}, {0.45, 1.0452}, {0.49, 1.0464}}) {
    Cantilever b;
    b.poisson = nu;
    EXPECT_NEAR(1e3 * timoshenkoDeflection_m(b, f, 0.05), tip, 5e-5);
  }
}

TEST(Beam, IncompatibleModesAreWithinTheStudysOnePercentOfAVoxel) {
  // 30 × 6 × 6 cells of 1.67 mm against 60 × 12 × 12, which itself is within a quarter of that of the limit.
  for (const double nu : {0.0, 0.3, 0.45, 0.49}) {
    const double fine = tip_mm(cantilever({60, 12, 12}, nu), element(HexElement::Incompatible));
    const double best = tip_mm(cantilever({30, 6, 6}, nu), element(HexElement::Incompatible));
    const double reference = fine + (fine - best) / 3;
    EXPECT_LE(std::abs(best - reference), nu < 0.49 ? 0.0164 : 0.025) << nu;
    EXPECT_LE(std::abs(tip_mm(cantilever({30, 6, 6}, nu), element(HexElement::BBar)) - reference), 0.0164) << nu;
  }
}

TEST(Beam, PlainHexahedraLockAndTheBetterOnesDoNot) {
  const double reference = tip_mm(cantilever({60, 12, 12}, 0.49), element(HexElement::BBar));
  const double h8 = tip_mm(cantilever({30, 6, 6}, 0.49), element(HexElement::H8));
  EXPECT_LT(h8, reference - 0.1);
  for (const double nu : {0.499, 0.4999}) {
    const double fine = tip_mm(cantilever({60, 12, 12}, nu), element(HexElement::BBar));
    EXPECT_NEAR(tip_mm(cantilever({30, 6, 6}, nu), element(HexElement::Incompatible)), fine, 0.05 * fine);
    EXPECT_NEAR(tip_mm(cantilever({30, 6, 6}, nu), element(HexElement::BBar)), fine, 0.05 * fine);
  }
  // A slab one cell thick.
  const auto slab = [](const Eigen::Vector3i& n) {
    Problem p = cantilever({30, 6, 1}, 0.3);
    p.body = test::box(n, {0.05, 0.01, 0.01 / 6}, 12e3, 0.3);
    const VoxelMesh mesh(p.body);
    p.supports.fixations = fix(test::nodesWhere(mesh, [](const auto& x) { return x.x() < 1e-9; }));
    p.f_N = bodyForce(mesh, Eigen::Vector3d(0, 0, -0.1));
    return p;
  };
  const double thin = tip_mm(slab({60, 12, 4}), element(HexElement::Incompatible));
  EXPECT_NEAR(tip_mm(slab({30, 6, 1}), element(HexElement::Incompatible)), thin, 0.03 * thin);
  EXPECT_LT(tip_mm(slab({30, 6, 1}), element(HexElement::H8)), 0.7 * thin);
}

TEST(Beam, ApproachesTimoshenkoWhereTheClampLeavesPoissonFree) {
  for (const double nu : {0.0, 0.3, 0.45}) {
    Problem p = cantilever({60, 12, 12}, nu);
    const VoxelMesh mesh(p.body);
    p.supports.fixations =
        fix(test::nodesWhere(mesh, [](const auto& x) { return x.x() < 1e-9; }), {true, false, false});
    p.supports.fixations.push_back({mesh.nodeAt(0, 6, 6), {false, true, true}, Eigen::Vector3d::Zero()});
    p.supports.fixations.push_back({mesh.nodeAt(0, 6, 12), {false, true, false}, Eigen::Vector3d::Zero()});
    Cantilever beam;
    beam.poisson = nu;
    // The support's shear force as the parabola of beam theory, so that no single node carries it.
    const double f = loadForTip_N_m(beam, 1e-3);
    const auto root = test::facesWhere(mesh, 0, always);
    Eigen::Matrix3Xd shear(3, static_cast<Eigen::Index>(root.size()));
    double total = 0;
    for (std::size_t i = 0; i < root.size(); ++i) {
      const double t = 2 * faceCentre_m(mesh, root[i]).z() / beam.height_m - 1;
      shear.col(static_cast<Eigen::Index>(i)) = Eigen::Vector3d(0, 0, 1 - t * t);
      total += faceArea_m2(mesh, 0) * (1 - t * t);
    }
    p.f_N += tractionForce(mesh, root, Eigen::Matrix3Xd(f * beam.length_m / total * shear));
    const double timoshenko = 1e3 * timoshenkoDeflection_m(beam, f, 0.05);
    EXPECT_NEAR(tip_mm(p, element(HexElement::Incompatible)), timoshenko, 0.004) << nu;
  }
}

TEST(Solvers, PlainConjugateGradientsStoppedAt200SaySo) {
  SolverOptions options = with(SolverKind::Cg, 1e-6);
  options.preconditioner = Preconditioner::None;
  options.iterations = 200;
  for (const double nu : {0.45, 0.49}) {
    const Solution s = solveStatic(cantilever({30, 6, 6}, nu), options);
    EXPECT_EQ(s.report.status, SolveStatus::StoppedAtLimit);
    EXPECT_EQ(s.report.iterations, 200);
    EXPECT_GT(s.report.residual, 1e-3);
    EXPECT_EQ(s.report.kind, "cg");
  }
}

TEST(Solvers, AllAgree) {
  const Problem p = cantilever({24, 6, 6}, 0.4);
  const Solution direct = solveStatic(p, with(SolverKind::Factorised, 1e-12));
  ASSERT_TRUE(direct.report.converged());
  for (const Preconditioner m : {Preconditioner::None, Preconditioner::Jacobi, Preconditioner::BlockJacobi}) {
    SolverOptions options = with(SolverKind::Cg, 1e-11);
    options.preconditioner = m;
    const Solution s = solveStatic(p, options);
    EXPECT_TRUE(s.report.converged());
    EXPECT_LE((s.u_m - direct.u_m).norm(), 1e-8 * direct.u_m.norm());
  }
  const Solution s = solveStatic(p, with(SolverKind::Multigrid, 1e-11));
  EXPECT_TRUE(s.report.converged());
  EXPECT_LE((s.u_m - direct.u_m).norm(), 1e-8 * direct.u_m.norm());
  EXPECT_LE(s.report.iterations, 30);
}

/// Cube of 22 mm, clamped below, pulled above; moduli from a function of the centre.
Problem cube(int n, const std::function<double(const Eigen::Vector3d&)>& E, double nu = 0.45) {
  Problem p;
  p.body = test::box({n, n, n}, {0.022, 0.022, 0.022}, 1, nu);
  test::paint(p.body, [&](const Eigen::Vector3d& c, double) { return E(c); });
  const VoxelMesh mesh(p.body);
  p.supports.fixations = fix(nodesOfFaces(mesh, test::facesWhere(mesh, 4, always)));
  p.f_N = tractionForce(mesh, test::facesWhere(mesh, 5, always), Eigen::Vector3d(100, 50, 30));
  return p;
}

TEST(Solvers, StrongContrastIsSolvedRightByDefault) {
  const auto inclusion = [](double contrast) {
    return [contrast](const Eigen::Vector3d& c) {
      return (c - Eigen::Vector3d(0.009, 0.012, 0.011)).norm() < 0.006 ? contrast * 3e3 : 3e3;
    };
  };
  const auto noise = [](double decades) {
    return [decades, random = Random(5)](const Eigen::Vector3d&) mutable {
      return 3e3 * std::pow(10.0, decades * random.uniform(-0.5, 0.5));
    };
  };
  const std::vector<std::function<double(const Eigen::Vector3d&)>> scenes = {
      inclusion(10), inclusion(1e3), inclusion(1e6), inclusion(1e-6), noise(2), noise(4), noise(6)};
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const Problem p = cube(14, scenes[i]);
    const Solution direct = solveStatic(p, with(SolverKind::Factorised, 1e-10));
    for (const SolverKind kind : {SolverKind::Auto, SolverKind::Multigrid}) {
      const Solution s = solveStatic(p, with(kind, 1e-11));
      EXPECT_TRUE(s.report.converged()) << "scene " << i << ": " << s.report.why;
      EXPECT_LE((s.u_m - direct.u_m).norm(), 1e-8 * direct.u_m.norm()) << "scene " << i << ": " << s.report.why;
    }
  }
}

TEST(Solvers, AutoSaysWhy) {
  const auto why = [](const Problem& p) { return solveStatic(p, with(SolverKind::Auto, 1e-6)).report; };
  const auto soft = [](const Eigen::Vector3d&) { return 3e3; };
  EXPECT_EQ(why(cube(6, soft)).kind, "factorised");
  EXPECT_NE(why(cube(6, soft)).why.find("small enough"), std::string::npos);
  const SolveReport large = why(cube(16, soft));
  EXPECT_EQ(large.kind, "multigrid-pcg");
  EXPECT_LE(large.iterations, 15);
  EXPECT_LE(large.residual, 1e-6);
}

TEST(Solvers, AutoFactorisesASmallBodyWhenManyLoadsHaveCome) {
  const Problem p = cube(9, [](const Eigen::Vector3d&) { return 3e3; });
  StaticSolver solver(p.body, p.supports, with(SolverKind::Auto, 1e-9));
  const Solution first = solver.solve(p.f_N);
  EXPECT_EQ(first.report.kind, "multigrid-pcg");
  EXPECT_NE(first.report.why.find("until 8 loads"), std::string::npos);
  Solution last;
  for (int load = 1; load <= 8; ++load) last = solver.solve((load + 1) * p.f_N);
  EXPECT_EQ(last.report.kind, "factorised");
  EXPECT_NE(last.report.why.find("so many loads"), std::string::npos);
  EXPECT_LE((last.u_m / 9 - first.u_m).norm(), 1e-7 * first.u_m.norm());
}

TEST(Solvers, ALoadAfterMultigridHasFailedIsSolvedWithoutIt) {
  // No iteration reaches a tolerance below rounding: multigrid gives up, and is not tried for the loads that follow.
  const Problem p = cube(12, [](const Eigen::Vector3d&) { return 3e3; });
  StaticSolver solver(p.body, p.supports, with(SolverKind::Auto, 1e-17));
  const Solution first = solver.solve(p.f_N);
  EXPECT_NE(first.report.why.find("but multigrid"), std::string::npos) << first.report.why;
  EXPECT_TRUE(first.report.diagnostics.contains(DiagnosticCode::SolverFellBack));
  const Solution second = solver.solve(2 * p.f_N);
  EXPECT_NE(second.report.why.find("failed on an earlier load"), std::string::npos) << second.report.why;
  ASSERT_EQ(second.u_m.cols(), first.u_m.cols());
  EXPECT_LE((second.u_m / 2 - first.u_m).norm(), 1e-9 * first.u_m.norm());
  EXPECT_LT(second.report.residual, 1e-12);
}

TEST(Solvers, FlatCellsNeedFewIterations) {
  for (const double nu : {0.3, 0.45}) {
    Problem p;
    p.body = test::box({40, 36, 12}, {40 * 1.64e-3, 36 * 1.64e-3, 12 * 10e-3}, 6e3, nu);
    const VoxelMesh mesh(p.body);
    p.supports.springs = faceSprings(mesh, test::facesWhere(mesh, 3, always), 0.2 * N_m3_per_kPa_mm);
    p.f_N = pressureForce(mesh, test::facesWhere(mesh, 2, [](const auto& c) { return c.x() < 0.02; }), 100);
    const Solution s = solveStatic(p, with(SolverKind::Multigrid, 1e-6));
    EXPECT_TRUE(s.report.converged());
    EXPECT_LE(s.report.iterations, 20) << nu;
  }
}

TEST(Solvers, SameBitsWithAnyNumberOfThreads) {
  const Problem p = cube(18, [](const Eigen::Vector3d& c) { return 3e3 * (1 + 100 * c.x()); });
  const auto solve = [&](int threads, SolverKind kind) {
    setThreadCount(threads);
    return solveStatic(p, with(kind, 1e-8)).u_m;
  };
  for (const SolverKind kind : {SolverKind::Multigrid, SolverKind::Cg, SolverKind::Factorised}) {
    const NodalField one = solve(1, kind);
    EXPECT_EQ(solve(2, kind), one);
    EXPECT_EQ(solve(4, kind), one);
  }
  setThreadCount(0);
}

TEST(Solvers, OneSolverTakesManyLoads) {
  const Problem p = cube(14, [](const Eigen::Vector3d&) { return 3e3; });
  StaticSolver solver(p.body, p.supports, with(SolverKind::Multigrid, 1e-11));
  Random random(2);
  NodalField g = NodalField::Zero(3, solver.mesh().nodeCount());
  for (Eigen::Index i = 0; i < g.size(); i += 7) g(i) = random.normal();
  const Solution a = solver.solve(p.f_N);
  const Solution b = solver.solve(g);
  const Solution both = solver.solve(p.f_N + 2 * g);
  EXPECT_LE((a.u_m + 2 * b.u_m - both.u_m).norm(), 1e-8 * both.u_m.norm());
}

TEST(Solvers, RefuseWithAReason) {
  const Problem p = cube(6, [](const Eigen::Vector3d&) { return 3e3; });
  const auto message = [](const Problem& q, const SolverOptions& o) -> std::string {
    try {
      solveStatic(q, o);
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  Problem bad = p;
  bad.f_N(4) = std::nan("");
  EXPECT_NE(message(bad, {}).find("not finite"), std::string::npos);
  bad = p;
  bad.supports = {};
  EXPECT_NE(message(bad, {}).find("6 free rigid modes"), std::string::npos);
  bad = p;
  bad.f_N = NodalField::Zero(3, 5);
  EXPECT_THROW(solveStatic(bad), BadArgument);
  const Problem large = cube(28, [](const Eigen::Vector3d&) { return 3e3; });
  EXPECT_NE(message(large, with(SolverKind::Factorised, 1e-8)).find("GB"), std::string::npos);
}

TEST(Solvers, StopWhenAsked) {
  const Problem p = cube(16, [](const Eigen::Vector3d&) { return 3e3; });
  std::stop_source stop;
  const Progress progress([&](double, const std::string&) { stop.request_stop(); }, stop.get_token());
  SolverOptions options = with(SolverKind::Cg, 1e-10);
  EXPECT_THROW(solveStatic(p, options, progress), Cancelled);
}

}  // namespace
}  // namespace glisson::mechanics
