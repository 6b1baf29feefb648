// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "mechanics/static_solve.h"
#include "mechanics/tet_element.h"
#include "mechanics/tet_faces.h"
#include "mechanics/tet_solve.h"
#include "scenes.h"

namespace glisson::mechanics {
namespace {

/// A voxel block as T4 or T10, inner corners moved by a part of the cell (middles stay in the middle of their edge).
TetMesh bent(const VoxelBody& body, bool quadratic, double part) {
  const VoxelMesh voxels(body);
  TetMesh mesh = tetrahedra(body, voxels);
  Random random(4);
  for (int node = 0; node < mesh.nodeCount(); ++node) {
    const Eigen::Vector3i p = voxels.latticeOf(node);
    for (int c = 0; c < 3; ++c)
      if (p[c] > 0 && p[c] < body.cells[c]) mesh.nodes_m(c, node) += part * body.h_m[c] * random.uniform(-1, 1);
  }
  return quadratic ? withMiddles(mesh) : mesh;
}

double volume(const TetMesh& mesh) {
  double sum = 0;
  for (int t = 0; t < mesh.tetCount(); ++t)
    for (const TetPoint& p : tetPoints(mesh, t)) sum += p.volume_m3;
  return sum;
}

const VoxelBody block = test::box({3, 4, 2}, {0.03, 0.05, 0.02}, 5e3, 0.45);

TEST(Tetrahedra, FillTheVoxelsAndFitTogether) {
  VoxelBody body = block;
  body.E_Pa[body.cell(1, 2, 1)] = 0;
  body.E_Pa[body.cell(0, 0, 0)] = 9e3;
  const VoxelMesh voxels(body);
  const TetMesh linear = tetrahedra(body, voxels);
  const double cell = body.h_m.prod();
  EXPECT_EQ(linear.tetCount(), 6 * voxels.cellCount());
  EXPECT_NEAR(volume(linear), voxels.cellCount() * cell, 1e-12 * cell);
  EXPECT_EQ((linear.E_Pa.array() == 9e3).count(), 6);
  // Two triangles on every outer face of a cell, none inside: the cells' diagonals meet.
  const std::size_t outer = exteriorFaces(voxels).size() + cavityFaces(voxels).size();
  EXPECT_EQ(exteriorFaces(linear).size(), 2 * outer);
  const TetMesh quadratic = withMiddles(linear);
  EXPECT_NEAR(volume(quadratic), voxels.cellCount() * cell, 1e-12 * cell);
  for (int t = 0; t < quadratic.tetCount(); ++t)
    for (int e = 0; e < 6; ++e) {
      const auto& edge = tetEdges[static_cast<std::size_t>(e)];
      const auto at = [&](int a) { return Eigen::Vector3d(quadratic.nodes_m.col(quadratic.tets(a, t))); };
      ASSERT_LE((at(4 + e) - 0.5 * (at(edge[0]) + at(edge[1]))).norm(), 1e-15);
    }
  // Outward faces: the divergence theorem for the position gives three times the volume.
  NodalField f = NodalField::Zero(3, quadratic.nodeCount());
  double flux = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (const TetFace& face : exteriorFaces(linear)) {
      const std::vector<int> n = nodesOf(linear, face);
      const Eigen::Vector3d a = linear.nodes_m.col(n[0]);
      const Eigen::Vector3d b = linear.nodes_m.col(n[1]);
      const Eigen::Vector3d c = linear.nodes_m.col(n[2]);
      const Eigen::Vector3d u = b - a;
      const Eigen::Vector3d v = c - a;
      const double area = 0.5 * (u[(axis + 1) % 3] * v[(axis + 2) % 3] - u[(axis + 2) % 3] * v[(axis + 1) % 3]);
      flux += area * (a + b + c)[axis] / 3;
    }
  EXPECT_NEAR(flux, 3 * voxels.cellCount() * cell, 1e-12 * cell);
}

TEST(Tetrahedra, ShapeFunctionsAreOneAtTheirNodeAndSumToOne) {
  Random random(2);
  const TetMesh mesh = bent(block, true, 0.2);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d xi(random.uniform(0, 0.3), random.uniform(0, 0.3), random.uniform(0, 0.3));
    EXPECT_NEAR(tetShape(true, xi).sum(), 1, 1e-14);
    EXPECT_LE(tetShapeDerivatives(true, xi).colwise().sum().norm(), 1e-14);
    const double step = 1e-6;
    for (int c = 0; c < 3; ++c) {
      const Eigen::VectorXd slope = (tetShape(true, xi + step * Eigen::Vector3d::Unit(c)) -
                                     tetShape(true, xi - step * Eigen::Vector3d::Unit(c))) /
                                    (2 * step);
      EXPECT_LE((slope - tetShapeDerivatives(true, xi).col(c)).norm(), 1e-8);
    }
  }
  const std::array<Eigen::Vector3d, 4> corner = {Eigen::Vector3d(0, 0, 0), {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int a = 0; a < 10; ++a) {
    const auto& edge = tetEdges[static_cast<std::size_t>(std::max(0, a - 4))];
    const Eigen::Vector3d xi = a < 4 ? corner[static_cast<std::size_t>(a)]
                                     : Eigen::Vector3d(0.5 * (corner[static_cast<std::size_t>(edge[0])] +
                                                              corner[static_cast<std::size_t>(edge[1])]));
    EXPECT_LE((tetShape(true, xi) - Eigen::VectorXd::Unit(10, a)).norm(), 1e-15);
  }
}

TEST(Tetrahedra, StiffnessIsSymmetricWithExactlySixZeroModes) {
  for (const bool quadratic : {false, true})
    for (const double nu : {0.0, 0.3, 0.49}) {
      const TetMesh mesh = bent(block, quadratic, 0.2);
      for (const int t : {0, 7, 50}) {
        const Eigen::MatrixXd K = tetStiffness(mesh, t, nu);
        EXPECT_EQ((K - K.transpose()).cwiseAbs().maxCoeff(), 0.0);
        const Eigen::VectorXd l = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K).eigenvalues();
        EXPECT_LE(std::abs(l[5]), 1e-12 * l[l.size() - 1]);
        EXPECT_LE(std::abs(l[0]), 1e-12 * l[l.size() - 1]);
        EXPECT_GT(l[6], 1e-6 * l[l.size() - 1]);
      }
    }
}

TEST(Tetrahedra, PatchTest) {
  Eigen::Matrix3d H;
  H << 0.01, 0.02, -0.03, 0.005, -0.02, 0.01, 0.03, 0.01, 0.015;
  for (const bool quadratic : {false, true}) {
    TetProblem p;
    p.mesh = bent(block, quadratic, 0.25);
    p.poisson = 0.45;
    std::vector<char> outside(static_cast<std::size_t>(p.mesh.nodeCount()), 0);
    for (const TetFace& face : exteriorFaces(p.mesh))
      for (const int node : nodesOf(p.mesh, face)) outside[static_cast<std::size_t>(node)] = 1;
    for (int node = 0; node < p.mesh.nodeCount(); ++node)
      if (outside[static_cast<std::size_t>(node)] != 0)
        p.supports.fixations.push_back({node, {true, true, true}, H * p.mesh.nodes_m.col(node)});
    p.f_N = NodalField::Zero(3, p.mesh.nodeCount());
    const Solution s = solveTets(p);
    ASSERT_TRUE(s.report.converged());
    EXPECT_LE((s.u_m - H * p.mesh.nodes_m).norm(), 1e-12 * s.u_m.norm());
    EXPECT_LE(s.reaction_N.rowwise().sum().norm(), 1e-10 * s.reaction_N.cwiseAbs().maxCoeff());
  }
}

TEST(Tetrahedra, QuadraticTetrahedraBendExactly) {
  // Pure bending of a prism: u = κ (x z, −ν y z, −(x² + ν z² − ν y²)/2) is quadratic, so T10 reproduces it.
  constexpr double nu = 0.3;
  constexpr double kappa = 0.8;
  TetProblem p;
  p.mesh = bent(block, true, 0.2);
  p.poisson = nu;
  NodalField exact(3, p.mesh.nodeCount());
  for (int node = 0; node < p.mesh.nodeCount(); ++node) {
    const Eigen::Vector3d x = p.mesh.nodes_m.col(node);
    exact.col(node) = kappa * Eigen::Vector3d(x.x() * x.z(), -nu * x.y() * x.z(),
                                              -0.5 * (x.x() * x.x() + nu * x.z() * x.z() - nu * x.y() * x.y()));
  }
  for (const TetFace& face : exteriorFaces(p.mesh))
    for (const int node : nodesOf(p.mesh, face))
      p.supports.fixations.push_back({node, {true, true, true}, exact.col(node)});
  p.f_N = NodalField::Zero(3, p.mesh.nodeCount());
  const Solution s = solveTets(p);
  EXPECT_LE((s.u_m - exact).norm(), 1e-11 * exact.norm());
  const Eigen::Matrix<double, 6, 1> stress = tetStress_Pa(p.mesh, 20, nu, s.u_m, {0.2, 0.3, 0.1});
  const Eigen::VectorXd N = tetShape(true, {0.2, 0.3, 0.1});
  double z = 0;
  for (int a = 0; a < 10; ++a) z += N[a] * p.mesh.nodes_m(2, p.mesh.tets(a, 20));
  EXPECT_NEAR(stress[0], 5e3 * kappa * z, 1e-9 * 5e3);
  EXPECT_LE(stress.tail<5>().norm(), 1e-9 * 5e3);
}

TEST(Tetrahedra, LoadsHaveTheirSumAndMoment) {
  for (const bool quadratic : {false, true}) {
    const TetMesh mesh = bent(block, quadratic, 0.2);
    const NodalField f = bodyForce(mesh, {1, -2, 3});
    const double V = 0.03 * 0.05 * 0.02;
    EXPECT_LE((f.rowwise().sum() - V * Eigen::Vector3d(1, -2, 3)).norm(), 1e-14 * V);
    EXPECT_NEAR((f.row(2).cwiseProduct(mesh.nodes_m.row(0))).sum(), 3 * V * 0.015, 1e-13 * V);
    std::vector<TetFace> top;
    for (const TetFace& face : exteriorFaces(mesh)) {
      bool all = true;
      for (const int node : nodesOf(mesh, face)) all = all && mesh.nodes_m(2, node) > 0.02 - 1e-12;
      if (all) top.push_back(face);
    }
    EXPECT_EQ(top.size(), 24U);
    const NodalField t = tractionForce(mesh, top, {0, 5, -7});
    EXPECT_LE((t.rowwise().sum() - 0.0015 * Eigen::Vector3d(0, 5, -7)).norm(), 1e-14);
    EXPECT_NEAR((t.row(2).cwiseProduct(mesh.nodes_m.row(1))).sum(), -7 * 0.0015 * 0.025, 1e-15);
  }
}

/// The beam of the validation: 50 × 10 × 10 mm, 12 kPa, body force whose Euler-Bernoulli tip deflection is 1 mm.
Problem beam(const Eigen::Vector3i& cells, double nu) {
  Problem p;
  p.body = test::box(cells, {0.05, 0.01, 0.01}, 12e3, nu);
  const VoxelMesh mesh(p.body);
  p.supports.fixations = fix(test::nodesWhere(mesh, [](const Eigen::Vector3d& x) { return x.x() == 0; }));
  const double perLength = 8 * 12e3 * std::pow(0.01, 4) / 12 * 1e-3 / std::pow(0.05, 4);
  p.f_N = bodyForce(mesh, Eigen::Vector3d(0, 0, -perLength / 1e-4));
  return p;
}

/// Largest deflection of the axis, mm.
double tip_mm(const Problem& p, const Solution& s) {
  const VoxelMesh mesh(p.body);
  return -1e3 * s.u_m(2, mesh.nodeAt(p.body.cells.x(), p.body.cells.y() / 2, p.body.cells.z() / 2));
}

TEST(Tetrahedra, LinearOnesLockAndQuadraticOnesDoNot) {
  const std::array<std::array<double, 2>, 3> truth = {{{0.3, 1.0239}, {0.49, 0.9970}, {0.499, 0.9951}}};  // 3-D, mm
  double previous = 0;
  for (const auto& [nu, tip] : truth) {
    const Problem p = beam({30, 6, 6}, nu);
    const auto error = [&](const Problem& on, TetOrder order, TetPattern pattern) {
      return tip - tip_mm(on, solveTets(on, onTetrahedra(on, order, pattern), {}));
    };
    const double mirrored = error(p, TetOrder::Linear, TetPattern::Mirrored);
    const double parallel = error(p, TetOrder::Linear, TetPattern::Parallel);
    const Problem coarse = beam({16, 4, 4}, nu);
    const double quadratic = error(coarse, TetOrder::Quadratic, TetPattern::Mirrored);
    EXPECT_GT(mirrored, 0.05) << nu;
    EXPECT_GT(parallel, mirrored) << nu;
    EXPECT_GT(parallel, previous) << "the stiffer the closer to incompressible";
    previous = parallel;
    EXPECT_LT(std::abs(quadratic), 0.25 * mirrored) << nu;
  }
  EXPECT_GT(previous, 0.5);
  const Problem fine = beam({24, 6, 6}, 0.49);
  EXPECT_NEAR(tip_mm(fine, solveTets(fine, onTetrahedra(fine, TetOrder::Quadratic), {})), 0.9970, 0.0164);
}

TEST(Tetrahedra, SolversAgreeSpringsHoldAndReactionsBalance) {
  Problem p = beam({8, 4, 4}, 0.45);
  test::paint(p.body, [](const Eigen::Vector3d& x, double E) { return x.x() > 0.03 ? 4 * E : E; });
  const VoxelMesh mesh(p.body);
  p.supports.springs = faceSprings(mesh, test::facesWhere(mesh, 4, [](const Eigen::Vector3d&) { return true; }), 1e4);
  for (const TetOrder order : {TetOrder::Linear, TetOrder::Quadratic}) {
    const TetProblem tets = onTetrahedra(p, order);
    SolverOptions options;
    options.tolerance = 1e-10;
    const Solution a = solveTets(p, tets, options);
    options.kind = SolverKind::Cg;
    options.preconditioner = Preconditioner::BlockJacobi;
    const Solution b = solveTets(p, tets, options);
    EXPECT_EQ(a.report.kind, "factorised");
    EXPECT_EQ(b.report.kind, "block-jacobi-cg");
    ASSERT_TRUE(a.report.converged() && b.report.converged());
    EXPECT_LE((a.u_m - b.u_m).norm(), 1e-7 * a.u_m.norm());
    EXPECT_EQ(a.u_m.cols(), mesh.nodeCount());
    EXPECT_LE((a.reaction_N.rowwise().sum() + p.f_N.rowwise().sum()).norm(), 1e-8 * p.f_N.rowwise().sum().norm());
    EXPECT_NEAR(a.energy_J, 0.5 * a.u_m.cwiseProduct(p.f_N).sum(), 1e-8 * a.energy_J);
    setThreadCount(1);
    const Solution one = solveTets(p, tets, options);
    setThreadCount(2);
    const Solution two = solveTets(p, tets, options);
    setThreadCount(0);
    EXPECT_TRUE(one.u_m == two.u_m);
    options.kind = SolverKind::Multigrid;
    EXPECT_THROW(solveTets(p, tets, options), BadInput);
  }
}

TEST(Tetrahedra, QuadraticOnesStandOnAFoundationAsWellAsTheDefaultHexahedra) {
  // A clamped block on a foundation, pulled at its end, against hexahedra of a quarter of the edge.
  const auto standing = [](int fineness, double k_N_m3, std::vector<Foundation>& bed) {
    Problem p;
    p.body = test::box(fineness * Eigen::Vector3i(10, 6, 4), {0.04, 0.024, 0.016}, 6e3, 0.45);
    const VoxelMesh mesh(p.body);
    const auto always = [](const Eigen::Vector3d&) { return true; };
    p.supports.fixations = fix(test::nodesWhere(mesh, [](const Eigen::Vector3d& x) { return x.x() < 1e-9; }));
    bed = foundations(test::facesWhere(mesh, 4, always), k_N_m3);
    p.supports.springs = faceSprings(mesh, bed);
    p.f_N = tractionForce(mesh, test::facesWhere(mesh, 1, always), Eigen::Vector3d(0, 50, -100));
    return p;
  };
  for (const double k_N_m3 : {2e4, 2e5}) {
    std::vector<Foundation> bed, fineBed;
    const Problem p = standing(1, k_N_m3, bed), fine = standing(4, k_N_m3, fineBed);
    const VoxelMesh mesh(p.body), fineMesh(fine.body);
    const Solution truth = solveStatic(fine), hexahedra = solveStatic(p);
    const auto error_mm = [&](const NodalField& u_m) {
      double most = 0;
      for (int node = 0; node < mesh.nodeCount(); ++node) {
        const Eigen::Vector3i at = 4 * mesh.latticeOf(node);
        most = std::max(most, 1e3 * (u_m.col(node) - truth.u_m.col(fineMesh.nodeAt(at.x(), at.y(), at.z()))).norm());
      }
      return most;
    };
    TetProblem tets = onTetrahedra(p, TetOrder::Quadratic);
    const VoxelFacesOnTets faces(mesh, tets.mesh);
    tets.f_N.setZero();
    for (const Face& face : test::facesWhere(mesh, 1, [](const Eigen::Vector3d&) { return true; }))
      for (const auto& [node, share] : faces.shares(face))
        tets.f_N.col(node) += share * faceArea_m2(mesh, face.side) * Eigen::Vector3d(0, 50, -100);
    const double atCorners = error_mm(solveTets(p, tets, {}).u_m);
    layFoundations(tets, mesh, bed);
    Eigen::Matrix3d total = Eigen::Matrix3d::Zero();
    for (const Spring& s : tets.supports.springs) total += s.k_N_m;
    EXPECT_NEAR(total(0, 0), k_N_m3 * 0.04 * 0.024, 1e-9 * total(0, 0));
    const Solution s = solveTets(p, tets, {});
    EXPECT_LT(error_mm(s.u_m), error_mm(hexahedra.u_m)) << "corners: " << atCorners;
    EXPECT_LT(error_mm(s.u_m), 0.5 * atCorners);
    EXPECT_LE((s.reaction_N.rowwise().sum() + p.f_N.rowwise().sum()).norm(), 1e-8 * p.f_N.rowwise().sum().norm());
  }
}

TEST(Tetrahedra, MiddlesAreHeldOnClampedFacesAndNowhereElse) {
  // Two clamped faces meet in an edge: edges between them run through the inside, and their middles stay free.
  Problem p;
  p.body = test::box({3, 4, 2}, {0.03, 0.04, 0.02}, 5e3, 0.3);
  const VoxelMesh mesh(p.body);
  p.supports.fixations = fix(test::nodesWhere(mesh, [](const Eigen::Vector3d& x) { return x.x() == 0 || x.y() == 0; }));
  for (Fixation& f : p.supports.fixations) f.value_m = 0.1 * mesh.position_m(f.node);
  p.f_N = NodalField::Zero(3, mesh.nodeCount());
  const TetProblem tets = onTetrahedra(p, TetOrder::Quadratic);
  std::vector<int> held(static_cast<std::size_t>(tets.mesh.nodeCount()), 0);
  for (const Fixation& f : tets.supports.fixations) {
    ++held[static_cast<std::size_t>(f.node)];
    EXPECT_LE((f.value_m - 0.1 * tets.mesh.nodes_m.col(f.node)).norm(), 1e-15);
  }
  for (int node = 0; node < tets.mesh.nodeCount(); ++node) {
    const Eigen::Vector3d x = tets.mesh.nodes_m.col(node);
    EXPECT_EQ(held[static_cast<std::size_t>(node)], x.x() < 1e-12 || x.y() < 1e-12 ? 1 : 0) << x.transpose();
  }
}

TEST(Tetrahedra, Refusals) {
  const Problem good = beam({4, 2, 2}, 0.3);
  const auto message = [](const TetProblem& p) -> std::string {
    try {
      solveTets(p);
    } catch (const BadInput& e) {
      return e.what();
    }
    return "";
  };
  TetProblem p = onTetrahedra(good, TetOrder::Quadratic);
  EXPECT_EQ(message(p), "");
  TetProblem flipped = onTetrahedra(good, TetOrder::Linear);
  std::swap(flipped.mesh.tets(0, 5), flipped.mesh.tets(1, 5));
  EXPECT_THAT(message(flipped), testing::HasSubstr("tetrahedron 5 is inverted"));
  TetProblem flat = onTetrahedra(good, TetOrder::Linear);
  flat.mesh.nodes_m.col(flat.mesh.tets(3, 0)) =
      0.5 * (flat.mesh.nodes_m.col(flat.mesh.tets(0, 0)) + flat.mesh.nodes_m.col(flat.mesh.tets(1, 0)));
  EXPECT_THAT(message(flat), testing::HasSubstr("is flat"));
  TetProblem folded = p;  // good at its four points, folded at a corner
  folded.mesh.nodes_m.col(folded.mesh.tets(4, 0)) =
      0.9 * folded.mesh.nodes_m.col(folded.mesh.tets(0, 0)) + 0.1 * folded.mesh.nodes_m.col(folded.mesh.tets(1, 0));
  EXPECT_THAT(message(folded), testing::HasSubstr("inverted"));
  TetProblem soft = p;
  soft.mesh.E_Pa[3] = 0;
  EXPECT_THAT(message(soft), testing::HasSubstr("tetrahedron 3"));
  TetProblem loose = p;
  loose.supports.fixations.resize(1);
  EXPECT_THAT(message(loose), testing::HasSubstr("3 rigid modes"));
  TetProblem bad = p;
  bad.f_N(1, 1) = std::nan("");
  EXPECT_THAT(message(bad), testing::HasSubstr("not finite"));
  bad = p;
  bad.poisson = 0.5;
  EXPECT_THAT(message(bad), testing::HasSubstr("Poisson"));
}

}  // namespace
}  // namespace glisson::mechanics
