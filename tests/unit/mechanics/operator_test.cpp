// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/voxel_operator.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <limits>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "scenes.h"

namespace glisson::mechanics {
namespace {

/// A lumpy body with holes, several decades of modulus and rows of different lengths.
VoxelBody lumpy(int nx, int ny, int nz, std::uint64_t seed) {
  VoxelBody body = test::box({nx, ny, nz}, {0.0164 * nx, 0.02 * ny, 0.011 * nz}, 1.0, 0.45);
  Random random(seed);
  for (double& E : body.E_Pa) E = random.uniform() < 0.3 ? 0.0 : std::pow(10.0, random.uniform(2, 6));
  body.E_Pa[0] = 1e3;
  return body;
}

NodalField randomField(int nodes, std::uint64_t seed) {
  Random random(seed);
  NodalField u(3, nodes);
  for (Eigen::Index i = 0; i < u.size(); ++i) u(i) = random.normal();
  return u;
}

/// The textbook way: element by element with the dense 24 × 24 matrix.
NodalField assembledProduct(const VoxelOperator& op, const NodalField& u) {
  NodalField y = NodalField::Zero(3, u.cols());
  for (int e = 0; e < op.mesh().cellCount(); ++e) {
    const Eigen::Vector3i p = op.mesh().cellOf(e);
    const auto nodes = op.mesh().nodesOf(e);
    Eigen::Matrix<double, 24, 1> local;
    for (int a = 0; a < 8; ++a) local.segment<3>(3 * a) = u.col(nodes[static_cast<std::size_t>(a)]);
    const Eigen::Matrix<double, 24, 1> f = op.body().E_Pa[op.body().cell(p.x(), p.y(), p.z())] * (op.K0() * local);
    for (int a = 0; a < 8; ++a) y.col(nodes[static_cast<std::size_t>(a)]) += f.segment<3>(3 * a);
  }
  return y;
}

TEST(VoxelMesh, NumbersNodesInLatticeOrder) {
  const VoxelBody body = lumpy(7, 5, 4, 1);
  const VoxelMesh mesh(body);
  for (int node = 0; node < mesh.nodeCount(); ++node) {
    const Eigen::Vector3i p = mesh.latticeOf(node);
    EXPECT_EQ(mesh.nodeAt(p.x(), p.y(), p.z()), node);
  }
  for (int e = 0; e < mesh.cellCount(); ++e)
    for (int a = 0; a < 8; ++a)
      EXPECT_EQ(mesh.latticeOf(mesh.nodesOf(e)[static_cast<std::size_t>(a)]),
                mesh.cellOf(e) + Eigen::Vector3i(a & 1, a >> 1 & 1, a >> 2 & 1));
  EXPECT_EQ(mesh.nodeAt(-1, 0, 0), -1);
  EXPECT_EQ(mesh.nodeAt(0, 0, 5), -1);
}

TEST(VoxelMesh, RefusesBadBodiesAndNamesTheCell) {
  const auto message = [](const VoxelBody& body) -> std::string {
    try {
      const VoxelMesh mesh(body);
    } catch (const BadInput& e) {
      return e.what();
    }
    return "";
  };
  const VoxelBody good = test::box({4, 3, 2}, {0.04, 0.03, 0.02}, 1e3, 0.45);
  EXPECT_EQ(message(good), "");
  for (const double E : {-1.0, std::nan(""), std::numeric_limits<double>::infinity(), 1e30}) {
    VoxelBody body = good;
    body.E_Pa[body.cell(2, 1, 1)] = E;
    EXPECT_NE(message(body).find("(2, 1, 1) in slice 1"), std::string::npos) << message(body);
  }
  for (const double nu : {0.5, 0.7, -1.0, std::nan("")}) {
    VoxelBody body = good;
    body.poisson = nu;
    EXPECT_NE(message(body).find("Poisson"), std::string::npos);
  }
  for (const double rho : {0.0, -1.0, std::nan("")}) {
    VoxelBody body = good;
    body.density_kg_m3 = rho;
    EXPECT_NE(message(body).find("density"), std::string::npos);
  }
  VoxelBody body = good;
  body.E_Pa.assign(body.E_Pa.size(), 0.0);
  EXPECT_NE(message(body).find("no filled cell"), std::string::npos);
  body = good;
  body.E_Pa.pop_back();
  EXPECT_NE(message(body).find("moduli"), std::string::npos);
  body = good;
  body.h_m.y() = 0;
  EXPECT_NE(message(body).find("edges"), std::string::npos);
}

TEST(VoxelOperator, EqualsElementByElementProducts) {
  for (const HexElement element : {HexElement::H8, HexElement::BBar, HexElement::Incompatible})
    for (const auto& [nx, ny, nz] : {std::array{1, 1, 1}, std::array{5, 4, 3}, std::array{37, 6, 5}}) {
      const VoxelOperator op(lumpy(nx, ny, nz, 11), element);
      const NodalField u = randomField(op.mesh().nodeCount(), 5);
      const NodalField expected = assembledProduct(op, u);
      EXPECT_LE((op.applyFree(u) - expected).norm(), 1e-14 * expected.norm());
    }
}

TEST(VoxelOperator, FloatKernelAgreesToFloatPrecision) {
  const VoxelOperator op(lumpy(33, 7, 6, 2));
  LatticeOperator<float> small;
  small.lattice = op.lattice().lattice;
  small.blocks = RowBlocks<float>(walshBlocks(op.K0()));
  small.E = cellSlotsOf<float>(*small.lattice, op.body().E_Pa, 1.0);
  std::vector<double> x(small.size());
  std::vector<double> y(small.size());
  op.toSlots(randomField(op.mesh().nodeCount(), 3), x.data());
  op.lattice().applyCells(x.data(), y.data());
  const std::vector<float> xf(x.begin(), x.end());
  std::vector<float> yf(small.size());
  small.applyCells(xf.data(), yf.data());
  double error = 0;
  double size = 0;
  for (std::size_t i = 0; i < y.size(); ++i) {
    error += std::pow(yf[i] - y[i], 2);
    size += y[i] * y[i];
  }
  EXPECT_LE(std::sqrt(error / size), 1e-6);
}

TEST(VoxelOperator, IsSymmetricWithSixZeroModesWhenFree) {
  VoxelBody body = test::box({3, 2, 2}, {0.03, 0.02, 0.02}, 1.0, 0.45);
  Random random(4);
  for (double& E : body.E_Pa) E = random.uniform(1e3, 1e5);
  body.E_Pa[3] = 0;
  const VoxelOperator op(body);
  Eigen::MatrixXd K(op.dofs(), op.dofs());
  for (int d = 0; d < op.dofs(); ++d) {
    NodalField unit = NodalField::Zero(3, op.mesh().nodeCount());
    unit(d) = 1;
    K.col(d) = op.applyFree(unit).reshaped();
  }
  EXPECT_LE((K - K.transpose()).cwiseAbs().maxCoeff(), 1e-14 * K.cwiseAbs().maxCoeff());
  const Eigen::VectorXd l = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K).eigenvalues();
  EXPECT_LE(std::abs(l[5]), 1e-12 * l[l.size() - 1]);
  EXPECT_GT(l[6], 1e-6 * l[l.size() - 1]);
  EXPECT_LE((K.diagonal() - op.diagonal().reshaped()).norm(), 1e-14 * K.diagonal().norm());
}

TEST(VoxelOperator, SupportsAreProjectedAndSpringsAdded) {
  const VoxelBody body = lumpy(6, 5, 4, 9);
  Supports supports;
  supports.fixations.push_back({3, {true, false, true}, Eigen::Vector3d(0.1, 0.2, 0.3)});
  Eigen::Matrix3d k;
  k << 4, 1, 0, 1, 3, 0.5, 0, 0.5, 2;
  supports.springs.push_back({7, 0.4 * k});
  supports.springs.push_back({7, 0.6 * k});
  const VoxelOperator op(body, HexElement::Incompatible, supports);
  const NodalField u = randomField(op.mesh().nodeCount(), 8);
  NodalField inside = u;
  op.project(inside);
  EXPECT_EQ(inside(0, 3), 0.0);
  EXPECT_EQ(inside(1, 3), u(1, 3));
  NodalField expected = assembledProduct(op, inside);
  expected.col(7) += k * inside.col(7);
  op.project(expected);
  const NodalField y = op.apply(u);
  EXPECT_LE((y - expected).norm(), 1e-13 * expected.norm());
  EXPECT_EQ(op.fixedCount(), 2);
  EXPECT_LE((op.springForce(u).col(7) + k * u.col(7)).norm(), 1e-14);
  EXPECT_EQ(op.prescribed_m().col(3), Eigen::Vector3d(0.1, 0, 0.3));
  const auto blocks = op.blockDiagonals();
  NodalField unit = NodalField::Zero(3, op.mesh().nodeCount());
  unit(1, 7) = 1;
  EXPECT_LE((op.apply(unit).col(7) - blocks[7].col(1)).norm(), 1e-13 * blocks[7].norm());
}

TEST(VoxelOperator, RefusesBadSupports) {
  const VoxelBody body = test::box({2, 2, 2}, {1, 1, 1}, 1e3, 0.3);
  const auto build = [&](const Supports& s) { const VoxelOperator op(body, HexElement::H8, s); };
  Supports s;
  s.fixations = {{27, {true, true, true}, Eigen::Vector3d::Zero()}};
  EXPECT_THROW(build(s), BadInput);
  s.fixations = {{1, {true, true, true}, Eigen::Vector3d(std::nan(""), 0, 0)}};
  EXPECT_THROW(build(s), BadInput);
  s.fixations = {{1, {true, false, false}, Eigen::Vector3d(1, 0, 0)},
                 {1, {true, true, false}, Eigen::Vector3d::Zero()}};
  EXPECT_THROW(build(s), BadInput);
  s.fixations.clear();
  s.springs = {{1, -Eigen::Matrix3d::Identity()}};
  EXPECT_THROW(build(s), BadInput);
  s.springs[0].k_N_m = Eigen::Matrix3d::Identity();
  s.springs[0].k_N_m(0, 1) = 0.5;
  EXPECT_THROW(build(s), BadInput);
}

TEST(VoxelOperator, SameBitsWithAnyNumberOfThreads) {
  const VoxelOperator op(lumpy(41, 23, 29, 6));
  const NodalField u = randomField(op.mesh().nodeCount(), 1);
  setThreadCount(1);
  const NodalField one = op.apply(u);
  for (const int threads : {2, 4}) {
    setThreadCount(threads);
    EXPECT_EQ(op.apply(u), one);
  }
  setThreadCount(0);
}

TEST(VoxelOperator, MassAddsUpToDensityTimesVolume) {
  const VoxelOperator op(lumpy(6, 5, 4, 12));
  const double mass = op.body().density_kg_m3 * op.mesh().cellCount() * op.body().h_m.prod();
  EXPECT_NEAR(op.lumpedMass_kg().sum(), mass, 1e-12 * mass);
  const NodalField ones = NodalField::Ones(3, op.mesh().nodeCount());
  const NodalField m = op.applyMass(ones);
  for (int c = 0; c < 3; ++c) EXPECT_LE((m.row(c).transpose() - op.lumpedMass_kg()).norm(), 1e-12 * mass);
}

}  // namespace
}  // namespace glisson::mechanics
