// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/meshfree.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "mechanics/static_solve.h"
#include "scenes.h"

namespace glisson::mechanics {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// A lumpy body with a notch, two materials.
Problem lump(int n = 8, double poisson = 0.45) {
  Problem p;
  p.body = test::box({n + 2, n, n - 1}, Vector3d(n + 2, n, n - 1) * 0.004, 5e3, poisson);
  const double size = 0.004 * n;
  test::paint(p.body, [&](const Vector3d& x, double E) {
    if (x.x() > 0.6 * size && x.y() > 0.7 * size) return 0.0;
    return x.z() > 0.5 * size ? 4.0 * E : E;
  });
  const VoxelMesh mesh(p.body);
  p.f_N = bodyForce(mesh, {500.0, -300.0, -1000.0});
  return p;
}

void holdFace(Problem& p, const std::array<bool, 3>& axis = {true, true, true}) {
  const VoxelMesh mesh(p.body);
  const auto held = fix(test::nodesWhere(mesh, [](const Vector3d& x) { return x.x() == 0.0; }), axis);
  p.supports.fixations.insert(p.supports.fixations.end(), held.begin(), held.end());
}

MeshfreeOptions framesOf(const KernelOptions& kernel, int frames) {
  MeshfreeOptions o;
  o.kernel = kernel.kernel;
  o.order = kernel.order;
  // As many functions, whatever a frame carries.
  o.frames = kernel.kernel == Kernel::Mls ? frames * (kernel.order == 1 ? 4 : 10) : frames;
  return o;
}

class EveryFrame : public testing::TestWithParam<KernelOptions> {};

TEST_P(EveryFrame, FreeStiffnessIsSymmetricWithSixZeroModes) {
  const MeshfreeModel model(lump(), framesOf(GetParam(), 5));
  const MatrixXd K = model.K(), M = model.M();
  EXPECT_EQ(K, K.transpose());
  EXPECT_EQ(M, M.transpose());
  const MatrixXd L = Eigen::LLT<MatrixXd>(M).matrixL();
  const MatrixXd A = L.triangularView<Eigen::Lower>().solve(L.triangularView<Eigen::Lower>().solve(K).transpose());
  const VectorXd omega2 = Eigen::SelfAdjointEigenSolver<MatrixXd>(0.5 * (A + A.transpose())).eigenvalues();
  EXPECT_LT(omega2.head(6).cwiseAbs().maxCoeff(), 1e-9 * omega2.maxCoeff());
  EXPECT_GT(omega2[6], 1e3 * omega2.head(6).cwiseAbs().maxCoeff());
  EXPECT_GT(omega2[6], 0.0);
}

TEST_P(EveryFrame, MassAddsUpToRhoV) {
  const Problem p = lump();
  const MeshfreeModel model(p, framesOf(GetParam(), 5));
  const double mass_kg = p.body.density_kg_m3 * model.voxels().mesh().cellCount() * 0.004 * 0.004 * 0.004;
  const int nodes = model.voxels().mesh().nodeCount();
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) {
      const VectorXd ta = model.nearest(Vector3d::Unit(a).replicate(1, nodes));
      const VectorXd tb = model.nearest(Vector3d::Unit(b).replicate(1, nodes));
      EXPECT_NEAR(ta.dot(model.M() * tb), a == b ? mass_kg : 0.0, 1e-9 * mass_kg);
    }
  EXPECT_EQ(Eigen::LLT<MatrixXd>(MatrixXd(model.M())).info(), Eigen::Success);
}

TEST_P(EveryFrame, LinearFieldsAreInTheSpaceAndHaveTheVoxelEnergy) {
  const Problem p = lump();
  const MeshfreeModel model(p, framesOf(GetParam(), 5));
  const VoxelMesh& mesh = model.voxels().mesh();
  Eigen::Matrix3d G;
  G << 0.02, 0.01, -0.03, 0.005, -0.01, 0.02, 0.0, 0.04, 0.015;
  NodalField u(3, mesh.nodeCount());
  for (int n = 0; n < mesh.nodeCount(); ++n) u.col(n) = Vector3d(1e-3, 2e-3, -1e-3) + G * mesh.position_m(n);
  const VectorXd q = model.nearest(u);
  EXPECT_LE((model.expand(q) - u).cwiseAbs().maxCoeff(), 1e-10 * u.cwiseAbs().maxCoeff());
  const double energy = 0.5 * u.cwiseProduct(model.voxels().applyFree(u)).sum();
  EXPECT_NEAR(0.5 * q.dot(model.K() * q), energy, 1e-8 * energy);
}

TEST_P(EveryFrame, MatricesAreTheExactProjectionWithSpringsAndClamps) {
  // Single-axis fixations make the three clamps differ; springs are oblique.
  Problem p = lump(7);
  holdFace(p, {true, false, true});
  const VoxelMesh mesh(p.body);
  for (const int n : test::nodesWhere(mesh, [](const Vector3d& x) { return x.z() == 0.0; })) {
    const Vector3d a = Vector3d(1.0, 0.5, 2.0).normalized();
    p.supports.springs.push_back({n, 3.0 * a * a.transpose() + 0.2 * Eigen::Matrix3d::Identity()});
  }
  const MeshfreeModel model(p, framesOf(GetParam(), 4));
  Random random(9);
  for (int trial = 0; trial < 3; ++trial) {
    VectorXd a(model.dofs()), b(model.dofs());
    for (Eigen::Index i = 0; i < a.size(); ++i) a[i] = random.normal(), b[i] = random.normal();
    const NodalField ua = model.expandRate(a), ub = model.expandRate(b);
    for (const Fixation& f : p.supports.fixations) {
      EXPECT_EQ(ua(0, f.node), 0.0);
      EXPECT_EQ(ua(2, f.node), 0.0);
    }
    const double k = ua.cwiseProduct(model.voxels().applyFree(ub) - model.voxels().springForce(ub)).sum();
    const double scale = std::sqrt(a.dot(model.K() * a) * b.dot(model.K() * b));
    EXPECT_NEAR(a.dot(model.K() * b), k, 1e-11 * scale);
    const double m = ua.cwiseProduct(model.voxels().applyMass(ub)).sum();
    EXPECT_NEAR(a.dot(model.M() * b), m, 1e-11 * std::sqrt(a.dot(model.M() * a) * b.dot(model.M() * b)));
    EXPECT_NEAR(model.reduce(p.f_N).dot(a), p.f_N.cwiseProduct(ua).sum(), 1e-11 * p.f_N.norm() * ua.norm());
  }
}

TEST_P(EveryFrame, EnergyErrorIsOneSidedAndReactionsBalance) {
  Problem p = lump();
  holdFace(p);
  const MeshfreeModel model(p, framesOf(GetParam(), 6));
  const Solution s = model.solveStatic();
  EXPECT_TRUE(s.report.converged());
  const Solution full = solveStatic(p);
  EXPECT_LT(s.energy_J, full.energy_J * (1.0 + 1e-7));
  EXPECT_GT(s.energy_J, 0.3 * full.energy_J);
  EXPECT_NEAR(s.energy_J, 0.5 * p.f_N.cwiseProduct(s.u_m).sum(), 1e-8 * s.energy_J);
  // The reactions balance the load, although only the subspace is in equilibrium.
  const Vector3d load = p.f_N.rowwise().sum();
  EXPECT_LE((s.reaction_N.rowwise().sum() + load).norm(), 1e-9 * load.norm());
  for (const Fixation& f : p.supports.fixations) EXPECT_EQ(s.u_m.col(f.node), Vector3d::Zero());
}

TEST_P(EveryFrame, SameBitsWithAnyNumberOfThreads) {
  Problem p = lump();
  holdFace(p);
  std::vector<MatrixXd> K;
  std::vector<NodalField> u;
  for (const int threads : {1, 2, 4}) {
    setThreadCount(threads);
    const MeshfreeModel model(p, framesOf(GetParam(), 6));
    K.emplace_back(model.K());
    u.push_back(model.solveStatic().u_m);
  }
  setThreadCount(0);
  EXPECT_EQ(K[1], K[0]);
  EXPECT_EQ(K[2], K[0]);
  EXPECT_EQ(u[1], u[0]);
  EXPECT_EQ(u[2], u[0]);
}

INSTANTIATE_TEST_SUITE_P(Frames, EveryFrame,
                         testing::Values(KernelOptions{Kernel::Wendland, 1, 0.0},
                                         KernelOptions{Kernel::Wendland, 2, 0.0},
                                         KernelOptions{Kernel::Voronoi, 1, 0.0}, KernelOptions{Kernel::Mls, 1, 0.0},
                                         KernelOptions{Kernel::Mls, 2, 0.0}));

TEST(Meshfree, SmallerSpacesInsideLargerOnesStoreLessEnergy) {
  // Affine frames lie inside quadratic ones on the same sites and supports.
  Problem p = lump(9);
  holdFace(p);
  MeshfreeOptions affine = framesOf({Kernel::Wendland, 1, 0.0}, 7);
  affine.alpha = 2.0;
  MeshfreeOptions quadratic = affine;
  quadratic.order = 2;
  const MeshfreeModel small(p, affine), large(p, quadratic);
  ASSERT_EQ(small.basis().sites().position_m, large.basis().sites().position_m);
  EXPECT_LT(small.solveStatic().energy_J, large.solveStatic().energy_J);
}

TEST(Meshfree, UniformStretchByPrescribedFacesIsHeldToAPercent) {
  // Both ends move rigidly along x, all else free, ν = 0: u = x ε is the solution; the lift holds two different values.
  Problem p;
  p.body = test::box({16, 8, 8}, {0.04, 0.02, 0.02}, 8e3, 0.0);
  const VoxelMesh mesh(p.body);
  for (const int n : test::nodesWhere(mesh, [](const Vector3d& x) { return x.x() == 0.0; }))
    p.supports.fixations.push_back({n, {true, true, true}, Vector3d::Zero()});
  for (const int n : test::nodesWhere(mesh, [](const Vector3d& x) { return x.x() > 0.0399; }))
    p.supports.fixations.push_back({n, {true, false, false}, Vector3d(1e-3, 0.0, 0.0)});
  const MeshfreeModel model(p, framesOf({Kernel::Wendland, 2, 0.0}, 16));
  const Solution s = model.solveStatic();
  for (const Fixation& f : p.supports.fixations) EXPECT_EQ(s.u_m(0, f.node), f.value_m.x());
  // The clamp's cubic is not a linear field: the space holds it to a fraction of a percent, from above in energy.
  const double exact_J = 0.5 * 8e3 * 0.02 * 0.02 / 0.04 * 1e-6;
  EXPECT_GE(s.energy_J, exact_J * (1.0 - 1e-9));
  EXPECT_LE(s.energy_J, exact_J * 1.01);
  for (int n = 0; n < mesh.nodeCount(); ++n) EXPECT_NEAR(s.u_m(0, n), 1e-3 * mesh.position_m(n).x() / 0.04, 2e-5);
  double pull_N = 0.0;
  for (const Fixation& f : p.supports.fixations)
    if (f.value_m.x() > 0.0) pull_N += s.reaction_N(0, f.node);
  EXPECT_NEAR(pull_N, 8e3 * 0.02 * 0.02 / 0.04 * 1e-3, 0.01 * pull_N);
}

TEST(Meshfree, AThinSlabDropsFunctionsItCannotTellApart) {
  // One voxel thick: z² is 1 and z on the two layers of nodes.
  Problem p;
  p.body = test::box({30, 30, 1}, {0.06, 0.06, 0.002}, 5e3, 0.3);
  const VoxelMesh mesh(p.body);
  p.f_N = bodyForce(mesh, {0.0, 0.0, -1.0});
  holdFace(p);
  const MeshfreeModel model(p, framesOf({Kernel::Wendland, 2, 0.0}, 10));
  EXPECT_EQ(model.dofs(), 3 * 9 * model.frames());
  ASSERT_FALSE(model.notes().empty());
  EXPECT_NE(model.notes().back().find("left out"), std::string::npos);
  const Solution s = model.solveStatic();
  EXPECT_TRUE(s.report.converged());
  EXPECT_LT(s.energy_J, solveStatic(p).energy_J * (1.0 + 1e-7));
}

TEST(Meshfree, TooFewVoxelsAreNoted) {
  Problem p = lump();
  const MeshfreeModel model(p, framesOf({Kernel::Wendland, 2, 0.0}, 200));
  EXPECT_LT(model.frames(), 12);
  ASSERT_FALSE(model.notes().empty());
  EXPECT_NE(model.notes()[0].find("instead of 200"), std::string::npos);
}

TEST(Meshfree, DuplicateAndStraySitesAreLeftOutWithANote) {
  Problem p = lump();
  holdFace(p);
  for (const KernelOptions& kernel : {KernelOptions{Kernel::Wendland, 1, 0.0}, KernelOptions{Kernel::Mls, 1, 0.0}}) {
    MeshfreeOptions good = framesOf(kernel, 6);
    good.sites_m = MeshfreeModel(p, good).basis().sites().position_m;
    const Solution clean = MeshfreeModel(p, good).solveStatic();
    MeshfreeOptions bad = good;
    const Eigen::Index n = good.sites_m.cols();
    bad.sites_m.conservativeResize(3, n + 3);
    bad.sites_m.col(n) = good.sites_m.col(2);
    bad.sites_m.col(n + 1) = good.sites_m.col(0) + Vector3d(1e-7, 0, 0);
    bad.sites_m.col(n + 2) = Vector3d(1.0, 0, 0);
    const MeshfreeModel model(p, bad);
    EXPECT_EQ(model.frames(), n);
    EXPECT_THAT(model.notes(),
                testing::IsSupersetOf({testing::HasSubstr("1 mesh-free sites left out: they lie outside"),
                                       testing::HasSubstr("2 mesh-free sites left out: each lies on")}));
    EXPECT_EQ(model.solveStatic().u_m, clean.u_m);
  }
  MeshfreeOptions nowhere;
  nowhere.sites_m = Vector3d(1.0, 0, 0);
  EXPECT_THROW(MeshfreeModel(p, nowhere), BadInput);
  nowhere.sites_m(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(MeshfreeModel(p, nowhere), BadInput);
}

TEST(Meshfree, CoplanarSitesGiveAFiniteConvergedAnswer) {
  Problem p = lump();
  holdFace(p);
  for (const int order : {1, 2}) {
    MeshfreeOptions o = framesOf({Kernel::Mls, order, 0.0}, 1);
    o.sites_m.resize(3, 16);
    for (int i = 0; i < 16; ++i) o.sites_m.col(i) = Vector3d(0.004 + 0.006 * (i % 4), 0.004 + 0.005 * (i / 4), 0.01);
    const MeshfreeModel model(p, o);
    EXPECT_FALSE(model.notes().empty());
    const Solution s = model.solveStatic();
    EXPECT_TRUE(s.report.converged());
    EXPECT_TRUE(s.u_m.allFinite());
    EXPECT_LT(s.energy_J, solveStatic(p).energy_J * (1.0 + 1e-7));
  }
}

TEST(Meshfree, RefusesWhatItCannotSolve) {
  Problem p = lump();
  const MeshfreeModel loose(p, framesOf({}, 4));
  EXPECT_THROW(loose.solveStatic(), BadInput);
  holdFace(p);
  const MeshfreeModel model(p, framesOf({}, 4));
  SolverOptions multigrid;
  multigrid.kind = SolverKind::Multigrid;
  EXPECT_THROW(model.solveStatic(multigrid), BadInput);
  NodalField f = p.f_N;
  f(1, 5) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(model.solveStatic(f), BadInput);
  EXPECT_THROW(model.solveStatic(NodalField::Zero(3, 5)), BadArgument);
  EXPECT_THROW(model.expand(VectorXd::Zero(3)), BadArgument);
  for (int n = 0; n < model.voxels().mesh().nodeCount(); ++n) p.supports.fixations.push_back({n});
  EXPECT_THROW(MeshfreeModel(p, framesOf({}, 4)), BadInput);
}

TEST(Meshfree, ScalesWithTheLoadWithoutThresholds) {
  Problem p = lump();
  holdFace(p);
  const MeshfreeModel model(p, framesOf({}, 5));
  const Solution one = model.solveStatic();
  EXPECT_EQ(model.solveStatic(NodalField::Zero(3, p.f_N.cols())).u_m.cwiseAbs().maxCoeff(), 0.0);
  for (const double factor : {1e-15, 1e15}) {
    const Solution s = model.solveStatic(factor * p.f_N);
    EXPECT_TRUE(s.report.converged());
    EXPECT_LE((s.u_m - factor * one.u_m).norm(), 1e-10 * factor * one.u_m.norm());
  }
}

TEST(Meshfree, EverySolverGivesTheSameAnswerAndTheTruth) {
  Problem p = lump();
  holdFace(p);
  const MeshfreeModel model(p, framesOf({}, 6));
  const Solution reference = model.solveStatic();
  SolverOptions cg;
  cg.kind = SolverKind::Cg;
  cg.tolerance = 1e-10;
  for (const auto preconditioner : {Preconditioner::Jacobi, Preconditioner::BlockJacobi}) {
    cg.preconditioner = preconditioner;
    const Solution s = model.solveStatic(cg);
    EXPECT_TRUE(s.report.converged());
    EXPECT_LE((s.u_m - reference.u_m).norm(), 1e-6 * reference.u_m.norm());
  }
  cg.preconditioner = Preconditioner::None;
  cg.iterations = 20;
  const Solution early = model.solveStatic(cg);
  EXPECT_EQ(early.report.status, SolveStatus::StoppedAtLimit);
  EXPECT_EQ(early.report.iterations, 20);
  EXPECT_GT(early.report.residual, 1e-10);
}

}  // namespace
}  // namespace glisson::mechanics
