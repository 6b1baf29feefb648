// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/measures.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "base/error.h"
#include "scenes.h"

namespace glisson::mechanics {
namespace {

const VoxelBody block = test::box({4, 3, 2}, {0.04, 0.06, 0.05}, 1e3, 0.45);

/// u = (F − I) x.
NodalField linear(const VoxelMesh& mesh, const Eigen::Matrix3d& F) {
  NodalField u(3, mesh.nodeCount());
  for (int node = 0; node < mesh.nodeCount(); ++node)
    u.col(node) = (F - Eigen::Matrix3d::Identity()) * mesh.position_m(node);
  return u;
}

Eigen::Matrix3d turn(double angle_deg) {
  return Eigen::AngleAxisd(angle_deg * std::numbers::pi / 180, Eigen::Vector3d(1, 2, -1).normalized())
      .toRotationMatrix();
}

bool mentions(const Validity& v, const std::string& words) {
  for (const std::string& w : v.warnings)
    if (w.find(words) != std::string::npos) return true;
  return false;
}

TEST(Measures, LinearFieldsAreMeasuredExactly) {
  const VoxelMesh mesh(block);
  Eigen::Matrix3d stretch;
  stretch << 1.03, 0.01, 0, 0.01, 0.98, -0.02, 0, -0.02, 1.01;
  const Eigen::Matrix3d F = turn(5) * stretch;
  const CellMeasures m = measureCells(mesh, linear(mesh, F));
  const Eigen::Matrix3d strain = 0.5 * (F + F.transpose()) - Eigen::Matrix3d::Identity();
  for (int e = 0; e < mesh.cellCount(); ++e) {
    EXPECT_NEAR(m.rotation_deg[e], 5, 1e-9);
    EXPECT_NEAR(m.volumeRatio[e], F.determinant(), 1e-12);
    EXPECT_NEAR(m.strain(0, e), strain(0, 0), 1e-12);
    EXPECT_NEAR(m.strain(4, e), strain(1, 2), 1e-12);
  }
}

TEST(Measures, WhatIsCrushedCountsByTheVolumeOfCellsThatCount) {
  const VoxelMesh mesh(block);
  NodalField u = linear(mesh, turn(40) * Eigen::Vector3d(0.9, 0.6, 1.0).asDiagonal());
  const CellMeasures even = measureCells(mesh, u, StrainMeasure::Biot);
  EXPECT_NEAR(even.meanVolumeRatio.minCoeff(), 0.54, 1e-12);
  EXPECT_EQ(summarise(even, u).fractionCrushed, 0);
  // A corner pushed inwards by half an edge: its cell loses an eighth of its volume, the corner half of it.
  u.col(0) += turn(40) * Eigen::Vector3d(0.9 * 0.005, 0, 0);
  const CellMeasures pushed = measureCells(mesh, u, StrainMeasure::Biot);
  EXPECT_NEAR(pushed.meanVolumeRatio.minCoeff(), 0.54 * (1 - 0.5 / 4), 1e-12);
  EXPECT_NEAR(pushed.volumeRatio.minCoeff(), 0.54 * 0.5, 1e-12);
  EXPECT_NEAR(summarise(pushed, u).fractionCrushed, 1.0 / 24, 1e-12);
  std::vector<float> covered(static_cast<std::size_t>(mesh.cellCount()), 1.0f);
  covered[0] = 0.1f;
  EXPECT_EQ(summarise(pushed, u, covered).fractionCrushed, 0);
  // An hourglass turns corners inside and takes no volume.
  NodalField twisted = NodalField::Zero(3, mesh.nodeCount());
  for (int node = 0; node < mesh.nodeCount(); ++node) {
    const Eigen::Vector3i at = mesh.latticeOf(node);
    twisted(0, node) = (at.x() + at.y()) % 2 == 0 ? 0.002 : -0.002;
  }
  EXPECT_NEAR(measureCells(mesh, twisted).meanVolumeRatio.minCoeff(), 1.0, 1e-12);
  EXPECT_LT(measureCells(mesh, twisted).volumeRatio.minCoeff(), 0.7);
}

TEST(Measures, BiotStrainSeesNoRotation) {
  const VoxelMesh mesh(block);
  Eigen::Matrix3d stretch;
  stretch << 1.3, 0.1, 0, 0.1, 0.8, -0.2, 0, -0.2, 1.1;
  const CellMeasures m = measureCells(mesh, linear(mesh, turn(110) * stretch), StrainMeasure::Biot);
  for (int e = 0; e < mesh.cellCount(); ++e) {
    EXPECT_NEAR(m.strain(0, e), 0.3, 1e-12);
    EXPECT_NEAR(m.strain(4, e), -0.2, 1e-12);
    EXPECT_NEAR(m.rotation_deg[e], 110, 1e-9);
  }
  EXPECT_LE(summarise(mesh, linear(mesh, turn(75)), StrainMeasure::Biot).maxStrain, 1e-13);
  // Both measures agree where displacements are tiny, to their own digits.
  const NodalField tiny = 1e-12 * linear(mesh, stretch);
  EXPECT_NEAR(summarise(mesh, tiny, StrainMeasure::Biot).maxStrain, summarise(mesh, tiny).maxStrain, 1e-23);
}

TEST(Measures, RotationMakesSpuriousStrainAndIsFlagged) {
  const VoxelMesh mesh(block);
  // About 1 % at 8 degrees: cos θ − 1.
  const DeformationSummary eight = summarise(mesh, linear(mesh, turn(8)));
  EXPECT_NEAR(eight.maxStrain, 1 - std::cos(8 * std::numbers::pi / 180), 1e-12);
  EXPECT_NEAR(eight.maxRotation_deg, 8, 1e-9);
  EXPECT_TRUE(validity(mesh, summarise(mesh, linear(mesh, turn(7)))).warnings.empty());
  const Validity nine = validity(mesh, summarise(mesh, linear(mesh, turn(9))));
  EXPECT_TRUE(mentions(nine, "spurious strain"));
  EXPECT_TRUE(nine.linearTrusted);
  const Validity twenty = validity(mesh, summarise(mesh, linear(mesh, turn(20))));
  EXPECT_FALSE(twenty.linearTrusted);
  EXPECT_TRUE(mentions(twenty, "turns by up to 20"));
}

TEST(Measures, LargeStrainIsOutsideLinearTheory) {
  const VoxelMesh mesh(block);
  const DeformationSummary s = summarise(mesh, linear(mesh, Eigen::Vector3d(1.12, 1, 1).asDiagonal()));
  EXPECT_NEAR(s.p95Strain, 0.12, 1e-12);
  EXPECT_NEAR(s.p99Strain, 0.12, 1e-12);
  EXPECT_EQ(s.fractionAbove10, 1.0);
  const Validity v = validity(mesh, s);
  EXPECT_FALSE(v.linearTrusted);
  EXPECT_FALSE(v.invalid);
  EXPECT_TRUE(mentions(v, "outside linear elasticity"));
}

TEST(Measures, NonsenseIsInvalid) {
  const VoxelMesh mesh(block);
  NodalField u = linear(mesh, Eigen::Vector3d(-1, 1, 1).asDiagonal());
  Validity v = validity(mesh, summarise(mesh, u));
  EXPECT_TRUE(v.invalid);
  EXPECT_TRUE(mentions(v, "cells turned inside out: 24"));
  u.setConstant(0.2);
  v = validity(mesh, summarise(mesh, u));
  EXPECT_TRUE(v.invalid);
  EXPECT_TRUE(mentions(v, "exceeds the body"));
  // One corner pushed through its cell: the centre alone would not show it.
  u.setZero();
  u.col(mesh.nodeAt(0, 0, 0)) = 1.5 * mesh.h_m();
  EXPECT_EQ(summarise(mesh, u).invertedCells, 1U);
  u(3) = std::nan("");
  EXPECT_THROW(summarise(mesh, u), BadInput);
  EXPECT_THROW(summarise(mesh, NodalField::Zero(3, 4)), BadArgument);
}

TEST(Measures, CellsWithLittleTissueAreLeftOutAndTheOthersCountForWhatTheyHold) {
  const VoxelMesh mesh(test::box({10, 1, 1}, {0.1, 0.01, 0.01}, 1, 0));
  NodalField u = NodalField::Zero(3, mesh.nodeCount());
  for (int node = 0; node < mesh.nodeCount(); ++node) {
    const double i = mesh.latticeOf(node).x();  // cell i strains by (i + 1) / 100
    u(0, node) = 0.01 * (0.5 * i * (i + 1)) / 100;
    if (mesh.latticeOf(node).x() == 10) u(0, node) -= 0.05;  // the last cell is turned inside out
  }
  const CellMeasures cells = measureCells(mesh, u);
  EXPECT_EQ(summarise(cells, u).invertedCells, 1U);
  EXPECT_EQ(summarise(cells, u).maxRotation_deg, 180.0);
  std::vector<float> covered(10, 1.0f);
  covered[9] = 0.4f;
  covered[8] = 0.5f;
  const DeformationSummary s = summarise(cells, u, covered);
  EXPECT_EQ(s.cellsLeftOut, 1U);
  EXPECT_EQ(s.invertedCells, 0U);
  EXPECT_NEAR(s.maxRotation_deg, 0.0, 1e-9);
  EXPECT_NEAR(s.maxStrain, 0.09, 1e-12);
  EXPECT_NEAR(s.p95Strain, 0.09, 1e-12);  // the last 5 % lie in the half cell, 1 of 17 parts of the volume
  covered[8] = 0.4f;
  EXPECT_NEAR(summarise(cells, u, covered).maxStrain, 0.08, 1e-12);
  EXPECT_THROW(summarise(cells, u, {1.0f}), BadArgument);
}

TEST(Measures, WhatIsSaidHasCodesAndValues) {
  const VoxelMesh mesh(block);
  const Validity v = validity(mesh, summarise(mesh, linear(mesh, turn(20))));
  ASSERT_FALSE(v.said.empty());
  EXPECT_TRUE(v.said.contains(DiagnosticCode::RotationBeyondLinear));
  EXPECT_EQ(v.warnings, v.said.texts());
  for (const Diagnostic& d : v.said)
    if (d.code == DiagnosticCode::RotationBeyondLinear) {
      EXPECT_NEAR(std::get<double>(d.arguments[0].second), 20.0, 1e-9);
    }
}

TEST(Measures, QuantilesCountVolume) {
  const VoxelMesh mesh(test::box({100, 1, 1}, {1, 0.01, 0.01}, 1, 0));
  NodalField u = NodalField::Zero(3, mesh.nodeCount());
  for (int node = 0; node < mesh.nodeCount(); ++node) {
    const double i = mesh.latticeOf(node).x();  // cell i strains by (i + 1) / 1000
    u(0, node) = 0.01 * (0.5 * i * (i + 1)) / 1000;
  }
  const DeformationSummary s = summarise(mesh, u);
  EXPECT_NEAR(s.maxStrain, 0.1, 1e-12);
  EXPECT_NEAR(s.p95Strain, 0.095, 1e-12);
  EXPECT_NEAR(s.p99Strain, 0.099, 1e-12);
}

TEST(Measures, DisplacementIsTrilinearAndReachesHalfACellOut) {
  const VoxelMesh mesh(block);
  Eigen::Matrix3d F;
  F << 1.1, 0.2, 0, 0, 0.9, 0.1, 0.3, 0, 1;
  const NodalField u = linear(mesh, F);
  for (const Eigen::Vector3d& p :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.013, 0.041, 0.02), Eigen::Vector3d(0.04, 0.06, 0.05)}) {
    const auto found = displacementAt(mesh, u, p);
    ASSERT_TRUE(found);
    EXPECT_LE((*found - (F - Eigen::Matrix3d::Identity()) * p).norm(), 1e-15);
  }
  const auto outside = displacementAt(mesh, u, {-0.004, 0.03, 0.02});
  ASSERT_TRUE(outside);
  EXPECT_LE((*outside - (F - Eigen::Matrix3d::Identity()) * Eigen::Vector3d(0, 0.03, 0.02)).norm(), 1e-15);
  EXPECT_FALSE(displacementAt(mesh, u, {-0.006, 0.03, 0.02}));
  EXPECT_FALSE(displacementAt(mesh, u, {std::nan(""), 0, 0}));
  VoxelBody holed = block;
  holed.E_Pa[holed.cell(1, 1, 0)] = 0;  // all its corners are nodes of neighbours
  const VoxelMesh around(holed);
  EXPECT_FALSE(around.isFilled(1, 1, 0));
  EXPECT_TRUE(around.isFilled(1, 1, 1));
  EXPECT_TRUE(displacementAt(around, linear(around, F), {0.0101, 0.03, 0.0125}));
}

}  // namespace
}  // namespace glisson::mechanics
