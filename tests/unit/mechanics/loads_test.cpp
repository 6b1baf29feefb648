// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/loads.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "scenes.h"

namespace glisson::mechanics {
namespace {

/// A block with one enclosed cavity cell and one notch that reaches the outside.
VoxelBody swiss() {
  VoxelBody body = test::box({5, 5, 5}, {0.05, 0.1, 0.15}, 1e3, 0.45);
  body.E_Pa[body.cell(2, 2, 2)] = 0;
  body.E_Pa[body.cell(4, 1, 1)] = 0;
  return body;
}

Eigen::Vector3d moment(const VoxelMesh& mesh, const NodalField& f) {
  Eigen::Vector3d m = Eigen::Vector3d::Zero();
  for (int node = 0; node < mesh.nodeCount(); ++node) m += mesh.position_m(node).cross(f.col(node));
  return m;
}

TEST(Loads, CavitiesAreToldFromTheOutside) {
  const VoxelMesh mesh(swiss());
  EXPECT_EQ(cavityFaces(mesh).size(), 6U);
  EXPECT_EQ(exteriorFaces(mesh).size(), 150U - 1U + 5U);
}

TEST(Loads, ClosedSurfacesCloseUp) {
  const VoxelMesh mesh(swiss());
  for (const auto& faces : {exteriorFaces(mesh), cavityFaces(mesh)}) {
    Eigen::Vector3d area = Eigen::Vector3d::Zero();
    double volume = 0;
    for (const Face& face : faces) {
      area += faceArea_m2(mesh, face.side) * faceNormal(face.side);
      volume += faceArea_m2(mesh, face.side) * faceNormal(face.side).dot(faceCentre_m(mesh, face)) / 3;
    }
    EXPECT_LE(area.norm(), 1e-16);
    const double cell = mesh.h_m().prod();
    EXPECT_NEAR(volume, faces.size() == 6 ? -cell : 124 * cell, 1e-12 * 125 * cell);
    // Uniform pressure: neither force nor moment.
    const NodalField f = pressureForce(mesh, faces, 100);
    EXPECT_LE(f.rowwise().sum().norm(), 1e-12 * f.norm());
    EXPECT_LE(moment(mesh, f).norm(), 1e-12 * f.norm());
  }
}

TEST(Loads, TractionKeepsForceMomentAndWork) {
  const VoxelMesh mesh(swiss());
  const auto top = test::facesWhere(mesh, 5, [](const auto& c) { return c.z() > 0.149; });
  const Eigen::Vector3d t(3, -2, 7);
  const NodalField f = tractionForce(mesh, top, t);
  EXPECT_LE((f.rowwise().sum() - t * 0.05 * 0.1).norm(), 1e-15);
  EXPECT_LE((moment(mesh, f) - Eigen::Vector3d(0.025, 0.05, 0.15).cross(t * 0.005)).norm(), 1e-15);
  EXPECT_THROW(tractionForce(mesh, top, Eigen::Matrix3Xd(Eigen::Matrix3Xd::Zero(3, 2))), BadArgument);
}

TEST(Loads, BodyForceKeepsForceAndMoment) {
  const VoxelBody body = swiss();
  const VoxelMesh mesh(body);
  const Eigen::Vector3d b(1, 2, -3);
  const NodalField f = bodyForce(mesh, b);
  EXPECT_LE((f.rowwise().sum() - 123 * mesh.h_m().prod() * b).norm(), 1e-15);
  Eigen::Vector3d expected = Eigen::Vector3d::Zero();
  for (int e = 0; e < mesh.cellCount(); ++e)
    expected += mesh.h_m().prod() *
                (mesh.cellOf(e).cast<double>() + Eigen::Vector3d::Constant(0.5)).cwiseProduct(mesh.h_m()).cross(b);
  EXPECT_LE((moment(mesh, f) - expected).norm(), 1e-15);
}

TEST(Loads, SpringsSumToStiffnessTimesArea) {
  const VoxelMesh mesh(swiss());
  const auto faces = exteriorFaces(mesh);
  Eigen::Matrix3d every = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  for (const Spring& s : faceSprings(mesh, faces, 0.2 * N_m3_per_kPa_mm)) every += s.k_N_m;
  for (const Spring& s : faceSprings(mesh, faces, 0.2 * N_m3_per_kPa_mm, SpringDirection::Normal)) normal += s.k_N_m;
  double area = 0;
  Eigen::Vector3d perAxis = Eigen::Vector3d::Zero();
  for (const Face& face : faces) {
    area += faceArea_m2(mesh, face.side);
    perAxis[face.side / 2] += faceArea_m2(mesh, face.side);
  }
  EXPECT_LE((every - 0.2e6 * area * Eigen::Matrix3d::Identity()).norm(), 1e-12 * every.norm());
  EXPECT_LE((normal - 0.2e6 * Eigen::Matrix3d(perAxis.asDiagonal())).norm(), 1e-12 * every.norm());
  EXPECT_THROW(faceSprings(mesh, faces, -1), BadInput);
  EXPECT_TRUE(faceSprings(mesh, faces, 0).empty());
}

TEST(Loads, FaceNodesLieOnTheFace) {
  const VoxelMesh mesh(swiss());
  for (const Face& face : exteriorFaces(mesh)) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const int node : faceNodes(mesh, face)) mean += mesh.position_m(node) / 4;
    EXPECT_LE((mean - faceCentre_m(mesh, face)).norm(), 1e-16);
  }
}

}  // namespace
}  // namespace glisson::mechanics
