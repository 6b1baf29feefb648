// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "deck.h"
#include "mechanics/loads.h"
#include "mechanics/newton_solve.h"
#include "mechanics/static_solve.h"
#include "mechanics/tet_solve.h"

// Our elements against CalculiX, node by node, on decks written here.
#define NEEDS_CCX \
  if (!ccx::installed()) GTEST_SKIP() << "CalculiX (ccx, Debian package calculix-ccx) is not installed"

namespace glisson {
namespace {

using mechanics::NodalField;

/// A clamped beam of two materials on oblong cells, under a force density with all three components.
mechanics::Problem beam(const Eigen::Vector3i& cells, const Eigen::Vector3d& size_m, double poisson,
                        const Eigen::Vector3d& force_N_m3, double contrast) {
  mechanics::Problem p;
  p.body.cells = cells;
  p.body.h_m = size_m.cwiseQuotient(cells.cast<double>());
  p.body.E_Pa.assign(static_cast<std::size_t>(cells.prod()), 12e3);
  for (int k = 0; k < cells.z(); ++k)
    for (int j = 0; j < cells.y(); ++j)
      for (int i = cells.x() / 2; i < cells.x(); ++i) p.body.E_Pa[p.body.cell(i, j, k)] *= contrast;
  p.body.poisson = poisson;
  const mechanics::VoxelMesh mesh(p.body);
  std::vector<int> clamped;
  for (int node = 0; node < mesh.nodeCount(); ++node)
    if (mesh.latticeOf(node).x() == 0) clamped.push_back(node);
  p.supports.fixations = mechanics::fix(clamped);
  p.f_N = mechanics::bodyForce(mesh, force_N_m3);
  return p;
}

ccx::Deck hexDeck(const mechanics::Problem& p, const std::string& element, const Eigen::Vector3d& force_N_m3) {
  const mechanics::VoxelMesh mesh(p.body);
  ccx::Deck deck;
  deck.element = element;
  deck.nodes_m.resize(3, mesh.nodeCount());
  for (int node = 0; node < mesh.nodeCount(); ++node) deck.nodes_m.col(node) = mesh.position_m(node);
  deck.elements.resize(8, mesh.cellCount());
  deck.E_Pa.resize(mesh.cellCount());
  constexpr std::array<std::size_t, 8> order = {0, 1, 3, 2, 4, 5, 7, 6};
  for (int e = 0; e < mesh.cellCount(); ++e) {
    const std::array<int, 8> nodes = mesh.nodesOf(e);
    for (int a = 0; a < 8; ++a) deck.elements(a, e) = nodes[order[static_cast<std::size_t>(a)]];
    const Eigen::Vector3i c = mesh.cellOf(e);
    deck.E_Pa[e] = p.body.E_Pa[p.body.cell(c.x(), c.y(), c.z())];
  }
  deck.poisson = p.body.poisson;
  deck.fixations = p.supports.fixations;
  deck.force_N_m3 = force_N_m3;
  return deck;
}

double relative(const NodalField& a, const NodalField& b) {
  return (a - b).norm() / b.norm();
}

const Eigen::Vector3d push(3, 5, -20);
constexpr double printed = 1e-6;  ///< CalculiX prints seven digits

TEST(Calculix, HexahedraAgreeNodeByNode) {
  NEEDS_CCX;
  for (const double nu : {0.0, 0.3, 0.45, 0.49}) {
    const mechanics::Problem p = beam({10, 3, 4}, {0.05, 0.01, 0.012}, nu, push, 5);
    const NodalField c3d8 = ccx::run(hexDeck(p, "C3D8", push));
    const NodalField c3d8i = ccx::run(hexDeck(p, "C3D8I", push));
    mechanics::SolverOptions options;
    options.element = mechanics::HexElement::H8;
    EXPECT_LE(relative(mechanics::solveStatic(p, options).u_m, c3d8), printed) << nu;
    options.element = mechanics::HexElement::Incompatible;
    EXPECT_LE(relative(mechanics::solveStatic(p, options).u_m, c3d8i), printed) << nu;
    // CalculiX has no B-bar; it must lie near the incompatible element where the plain one locks.
    options.element = mechanics::HexElement::BBar;
    EXPECT_LE(relative(mechanics::solveStatic(p, options).u_m, c3d8i), 0.08) << nu;
    if (nu == 0.49) {
      EXPECT_GT(relative(c3d8, c3d8i), 0.3) << "the plain element locks";
    }
  }
}

TEST(Calculix, QuadraticTetrahedraAgreeNodeByNode) {
  NEEDS_CCX;
  for (const double nu : {0.0, 0.3, 0.49}) {
    const mechanics::Problem p = beam({8, 3, 3}, {0.05, 0.01, 0.012}, nu, push, 5);
    mechanics::TetProblem tets = mechanics::onTetrahedra(p, mechanics::TetOrder::Quadratic);
    tets.f_N = mechanics::bodyForce(tets.mesh, push);
    ccx::Deck deck;
    deck.element = "C3D10";
    deck.nodes_m = tets.mesh.nodes_m;
    deck.elements = tets.mesh.tets;
    deck.E_Pa = tets.mesh.E_Pa;
    deck.poisson = nu;
    deck.fixations = tets.supports.fixations;
    deck.force_N_m3 = push;
    const NodalField theirs = ccx::run(deck);
    const NodalField ours = mechanics::solveTets(tets).u_m;
    EXPECT_LE(relative(ours, theirs), printed) << nu;
  }
}

TEST(Calculix, LargeRotationsAgree) {
  NEEDS_CCX;
  const Eigen::Vector3d heavy(0, 0, -250);
  const mechanics::Problem p = beam({30, 3, 3}, {0.1, 0.01, 0.01}, 0.3, heavy, 1);
  ccx::Deck deck = hexDeck(p, "C3D8I", heavy);
  deck.largeDeformation = true;
  const NodalField theirs = ccx::run(deck);
  ASSERT_GT(theirs.cwiseAbs().maxCoeff(), 0.025) << "the case should bend far";
  // CalculiX's material is linear between Green's strain and the second Piola-Kirchhoff stress: the strains, a few
  // percent, make the difference.
  const mechanics::Solution turned = mechanics::solveLargeDeformation(p, mechanics::LargeDeformationKind::Corotational);
  const mechanics::Solution stretched =
      mechanics::solveLargeDeformation(p, mechanics::LargeDeformationKind::Hyperelastic);
  ASSERT_TRUE(turned.report.converged() && stretched.report.converged());
  EXPECT_LE(relative(turned.u_m, theirs), 0.005);
  EXPECT_LE(relative(stretched.u_m, theirs), 0.015);
  EXPECT_GT(relative(mechanics::solveStatic(p).u_m, theirs), 0.1) << "linear theory is far away here";
}

}  // namespace
}  // namespace glisson
