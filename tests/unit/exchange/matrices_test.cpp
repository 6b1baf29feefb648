// SPDX-License-Identifier: GPL-3.0-or-later
#include "exchange/detail/matrices.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/Geometry>

#include "bodies.h"
#include "mechanics/loads.h"
#include "mechanics/voxel_operator.h"
#include "support/support.h"

namespace glisson::exchange {
namespace {

using namespace testing_bodies;

/// Reads a symmetric Matrix Market file as a full matrix.
Eigen::MatrixXd readMatrixMarket(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  EXPECT_EQ(line, "%%MatrixMarket matrix coordinate real symmetric");
  while (in.peek() == '%') std::getline(in, line);
  int rows = 0, columns = 0;
  std::size_t count = 0, seen = 0;
  in >> rows >> columns >> count;
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(rows, columns);
  int i = 0, j = 0;
  double v = 0.0;
  while (in >> i >> j >> v) {
    EXPECT_LE(j, i) << "upper triangle";
    EXPECT_EQ(A(i - 1, j - 1), 0.0) << "entry given twice";
    A(i - 1, j - 1) = A(j - 1, i - 1) = v;
    ++seen;
  }
  EXPECT_EQ(seen, count);
  return A;
}

class Matrices : public testing::TestWithParam<bool> {
 protected:
  Eigen::Matrix3d direction() const { return GetParam() ? oblique() : Eigen::Matrix3d::Identity(); }
};

TEST_P(Matrices, AreTheOperatorsThatAreSolvedWith) {
  const retraction::Body body(lBody(direction()));
  const test::TemporaryFolder folder;
  const auto files = writeMatrices(folder.path(), body, mechanics::HexElement::Incompatible);
  ASSERT_EQ(files.size(), 2u);
  const Eigen::MatrixXd K = readMatrixMarket(files[0]), M = readMatrixMarket(files[1]);

  const mechanics::VoxelOperator op(body.voxels());
  const Eigen::Index n = body.mesh().nodeCount();
  mechanics::NodalField u(3, n);
  for (Eigen::Index c = 0; c < n; ++c)
    for (Eigen::Index a = 0; a < 3; ++a) u(a, c) = std::sin(1.0 + 0.7 * static_cast<double>(3 * c + a));
  const mechanics::NodalField f = op.applyFree(u), p = op.applyMass(u);
  Eigen::VectorXd uLps(3 * n), fLps(3 * n), pLps(3 * n);
  for (Eigen::Index c = 0; c < n; ++c) {
    uLps.segment<3>(3 * c) = body.vectorToLps(u.col(c));
    fLps.segment<3>(3 * c) = body.vectorToLps(f.col(c));
    pLps.segment<3>(3 * c) = body.vectorToLps(p.col(c));
  }
  EXPECT_LT((K * uLps - fLps).norm(), 1e-12 * fLps.norm());
  EXPECT_LT((M * uLps - pLps).norm(), 1e-12 * pLps.norm());
}

TEST_P(Matrices, HaveSixZeroModesAndTheMass) {
  const retraction::Model model = lBody(direction());
  const retraction::Body body(model);
  const test::TemporaryFolder folder;
  const auto files = writeMatrices(folder.path(), body, mechanics::HexElement::H8);
  const Eigen::MatrixXd K = readMatrixMarket(files[0]), M = readMatrixMarket(files[1]);
  const Eigen::VectorXd modes = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K).eigenvalues();
  const double largest = modes.maxCoeff();
  EXPECT_LT(modes.head(6).cwiseAbs().maxCoeff(), 1e-12 * largest);
  EXPECT_GT(modes[6], 1e-6 * largest);
  EXPECT_NEAR(M.sum(), 3.0 * model.mass_kg, 1e-12 * model.mass_kg);
}

TEST_P(Matrices, SpringsAddUpToTheFoundation) {
  const retraction::Body body(lBody(direction()));
  std::vector<mechanics::Face> faces;
  for (const retraction::SurfaceFace& f : body.surface()) faces.push_back(f.face);
  mechanics::Supports supports;
  supports.springs = mechanics::faceSprings(body.mesh(), faces, 2e5, mechanics::SpringDirection::Every);
  const test::TemporaryFolder folder;
  const auto files = writeSpringMatrix(folder.path(), body, supports);
  ASSERT_EQ(files.size(), 1u);
  double area_m2 = 0.0;
  for (const retraction::SurfaceFace& f : body.surface()) area_m2 += f.area_m2;
  EXPECT_NEAR(readMatrixMarket(files[0]).sum(), 3.0 * 2e5 * area_m2, 1e-9 * 2e5 * area_m2);
  EXPECT_TRUE(writeSpringMatrix(folder.path(), body, {}).empty());
}

INSTANTIATE_TEST_SUITE_P(Grids, Matrices, testing::Values(false, true),
                         [](const auto& p) { return p.param ? "oblique" : "straight"; });

}  // namespace
}  // namespace glisson::exchange
