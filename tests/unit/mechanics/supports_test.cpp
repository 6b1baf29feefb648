// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/supports.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "scenes.h"

namespace glisson::mechanics {
namespace {

const VoxelBody block = test::box({4, 3, 2}, {0.04, 0.03, 0.02}, 1e3, 0.45);

int freeModes(const VoxelBody& body, const Supports& supports) {
  const auto free = findUnsupported(VoxelMesh(body), supports);
  return free.empty() ? 0 : free[0].freeModes;
}

TEST(Supports, CountTheFreeRigidModes) {
  const VoxelMesh mesh(block);
  Supports s;
  EXPECT_EQ(freeModes(block, s), 6);
  s.fixations = fix({mesh.nodeAt(0, 0, 0)});
  EXPECT_EQ(freeModes(block, s), 3);
  s.fixations = fix({mesh.nodeAt(0, 0, 0), mesh.nodeAt(4, 0, 0)});
  EXPECT_EQ(freeModes(block, s), 1);
  s.fixations = fix({mesh.nodeAt(0, 0, 0), mesh.nodeAt(2, 0, 0), mesh.nodeAt(4, 0, 0)});
  EXPECT_EQ(freeModes(block, s), 1);
  s.fixations = fix({mesh.nodeAt(0, 0, 0), mesh.nodeAt(4, 0, 0), mesh.nodeAt(0, 3, 0)});
  EXPECT_EQ(freeModes(block, s), 0);
  s.fixations =
      fix(nodesOfFaces(mesh, test::facesWhere(mesh, 0, [](const auto&) { return true; })), {true, false, false});
  EXPECT_EQ(freeModes(block, s), 3);
}

TEST(Supports, FoundationsHold) {
  const VoxelMesh mesh(block);
  const auto below = test::facesWhere(mesh, 4, [](const auto&) { return true; });
  Supports s;
  s.springs = faceSprings(mesh, below, 1e5);
  EXPECT_EQ(freeModes(block, s), 0);
  s.springs = faceSprings(mesh, below, 1e5, SpringDirection::Normal);
  EXPECT_EQ(freeModes(block, s), 3);  // slides along x and y, turns about z
  s.springs = faceSprings(mesh, exteriorFaces(mesh), 1e5, SpringDirection::Normal);
  EXPECT_EQ(freeModes(block, s), 0);
}

TEST(Supports, SizeAndUnitDoNotMatter) {
  for (const double scale : {1e-6, 1.0, 1e6}) {
    VoxelBody body = block;
    body.h_m *= scale;
    const VoxelMesh mesh(body);
    Supports s;
    s.fixations = fix({mesh.nodeAt(0, 0, 0), mesh.nodeAt(4, 0, 0), mesh.nodeAt(0, 3, 0)});
    EXPECT_EQ(freeModes(body, s), 0);
    for (Fixation& f : s.fixations) f.node = mesh.nodeAt(mesh.latticeOf(f.node).x(), 0, 0);
    EXPECT_EQ(freeModes(body, s), 1);
  }
}

/// Two blocks of 2 × 2 × 2 cells that share one edge.
VoxelBody hinge() {
  VoxelBody body = test::box({4, 4, 2}, {0.04, 0.04, 0.02}, 1e3, 0.3);
  test::paint(body, [](const Eigen::Vector3d& c, double E) { return (c.x() < 0.02) == (c.y() < 0.02) ? E : 0.0; });
  return body;
}

TEST(Supports, AnEdgeIsAHingeAndCarriesNothing) {
  const VoxelBody body = hinge();
  const VoxelMesh mesh(body);
  const Components components = findComponents(mesh);
  EXPECT_EQ(components.count(), 2);
  Supports s;
  s.fixations = fix(test::nodesWhere(mesh, [](const auto& x) { return x.x() < 1e-9; }));
  const auto free = findUnsupported(mesh, s);
  ASSERT_EQ(free.size(), 1U);
  EXPECT_TRUE(free[0].hinged);
  EXPECT_EQ(free[0].cells, 8U);
  EXPECT_NEAR(free[0].volume_m3, 8e-6, 1e-18);
  EXPECT_LE((free[0].centre_m - Eigen::Vector3d(0.03, 0.03, 0.01)).norm(), 1e-12);
  double dropped = 0;
  const VoxelBody kept = dropComponents(body, mesh, free, &dropped);
  EXPECT_NEAR(dropped, 8e-6, 1e-18);
  EXPECT_EQ(VoxelMesh(kept).cellCount(), 8);
  EXPECT_EQ(findComponents(VoxelMesh(kept)).count(), 1);
}

TEST(Supports, RefusalNamesPieceSizePlaceAndRemedy) {
  const VoxelBody body = hinge();
  const VoxelMesh mesh(body);
  Supports s;
  s.fixations = fix(test::nodesWhere(mesh, [](const auto& x) { return x.x() < 1e-9; }));
  try {
    requireSupported(mesh, s);
    FAIL();
  } catch (const BadInput& e) {
    const std::string what = e.what();
    for (const char* part : {"8 mL", "(30 30 10) mm", "free rigid modes", "hinge", "drop"})
      EXPECT_NE(what.find(part), std::string::npos) << what;
  }
  for (const int node : test::nodesWhere(mesh, [](const auto& x) { return x.x() > 0.0399; }))
    s.fixations.push_back({node, {true, true, true}, Eigen::Vector3d::Zero()});
  EXPECT_NO_THROW(requireSupported(mesh, s));
}

TEST(Supports, LargestComponentComesFirst) {
  VoxelBody body = test::box({9, 2, 2}, {0.09, 0.02, 0.02}, 1e3, 0.3);
  test::paint(body, [](const Eigen::Vector3d& c, double E) { return c.x() > 0.01 && c.x() < 0.03 ? 0.0 : E; });
  const Components components = findComponents(VoxelMesh(body));
  EXPECT_EQ(components.cells, (std::vector<std::size_t>{24, 4}));
}

}  // namespace
}  // namespace glisson::mechanics
