// SPDX-License-Identifier: GPL-3.0-or-later

// Surfaces and volume meshes from files, and the voxels inside them.
#include "anatomy/surface_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "anatomy/surface.h"
#include "anatomy/voxelise.h"
#include "base/error.h"
#include "lattices.h"
#include "support/support.h"

namespace glisson::anatomy {
namespace {

namespace fs = std::filesystem;

/// Reads a file of that name and text.
SurfaceFile readText(const std::string& name, const std::string& text) {
  const ::glisson::test::TemporaryFolder folder;
  std::ofstream(folder / name, std::ios::binary) << text;
  return readSurface(folder / name);
}

/// A box from (0, 0, 0) to (2, 3, 4) as OBJ: six rectangles, outwards.
const std::string box =
    "v 0 0 0\nv 2 0 0\nv 2 3 0\nv 0 3 0\nv 0 0 4\nv 2 0 4\nv 2 3 4\nv 0 3 4\n"
    "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

TEST(SurfaceFile, BoxIsClosedAndTurnedOutwards) {
  const SurfaceFile a = readText("box.obj", box);
  EXPECT_TRUE(a.closed);
  EXPECT_NEAR(volume_mm3(a.mesh), 24.0, 1e-12);
  EXPECT_EQ(a.mesh.triangles.cols(), 12);
  EXPECT_EQ(a.mesh.vertices_lps_mm.cols(), 8);
}

TEST(SurfaceFile, RasIsTurnedIntoLps) {
  const SurfaceFile a = readText("box.obj", "# 3D Slicer output. SPACE=RAS\n" + box);
  ASSERT_EQ(a.warnings.size(), 1u);
  EXPECT_EQ(a.mesh.vertices_lps_mm.rowwise().minCoeff(), Eigen::Vector3d(-2, -3, 0));
  EXPECT_NEAR(volume_mm3(a.mesh), 24.0, 1e-12);
}

TEST(SurfaceFile, StlPointsAreMerged) {
  // A tetrahedron of volume 1/6, each facet with points of its own; normals left to the reader.
  std::string text = "solid t\n";
  for (const char* f : {"0 0 0 0 1 0 1 0 0", "0 0 0 1 0 0 0 0 1", "0 0 0 0 0 1 0 1 0", "1 0 0 0 1 0 0 0 1"}) {
    double p[9];
    std::istringstream in(f);
    for (double& v : p) in >> v;
    std::ostringstream out;
    out << "facet normal 0 0 0\nouter loop\n";
    for (int c = 0; c < 3; ++c) out << "vertex " << p[3 * c] << ' ' << p[3 * c + 1] << ' ' << p[3 * c + 2] << '\n';
    text += out.str() + "endloop\nendfacet\n";
  }
  const SurfaceFile a = readText("t.stl", text + "endsolid t\n");
  EXPECT_TRUE(a.closed);
  EXPECT_EQ(a.mesh.vertices_lps_mm.cols(), 4);
  EXPECT_NEAR(volume_mm3(a.mesh), 1.0 / 6, 1e-7);
}

TEST(SurfaceFile, BadFilesAreRefusedWithTheReason) {
  const auto why = [](const std::string& name, const std::string& text) {
    try {
      readText(name, text);
    } catch (const BadInput& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  EXPECT_NE(why("a.msh", "$NOD\n1\n1 0 0 0\n$ENDNOD\n$ELM\n1\n1 4 1 1 4 1 2 3 4\n").find("node 2"), std::string::npos);
  EXPECT_NE(why("a.msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n").find("version 2"), std::string::npos);
  EXPECT_NE(why("a.vtk",
                "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 1 float\n0 0 0\nPOLYGONS 1 4\n"
                "3 0 1 2\n")
                .find("not there"),
            std::string::npos);
  EXPECT_NE(why("a.vtk", "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 99999999999999 float\n0 0 0\n")
                .find("not a usable surface"),
            std::string::npos);
  EXPECT_NE(why("a.obj", "v 0 0 0\n").find("no triangles"), std::string::npos);
  EXPECT_NE(why("a.stl", "").find("not a usable surface"), std::string::npos);
  EXPECT_NE(why("a.vtp", "<VTKFile>").find("not a usable surface"), std::string::npos);
  EXPECT_NE(why("a.vtu", "no XML at all").find("not a usable surface"), std::string::npos);
}

TEST(SurfaceFile, KnownLiverMeshes) {
  GLISSON_NEEDS_DATA("liver_meshes");
  const fs::path folder = ::glisson::test::sharedData() / "liver_meshes";
  const SurfaceFile surface = readSurface(folder / "liver.obj");
  EXPECT_TRUE(surface.closed);
  EXPECT_NEAR(volume_mm3(surface.mesh), 36.5685, 5e-5);
  const SurfaceFile volume = readSurface(folder / "liver.msh");
  EXPECT_TRUE(volume.closed);
  EXPECT_EQ(volume.volumeCells, 596u);
  EXPECT_EQ(volume.points, 181u);
  EXPECT_NEAR(volume_mm3(volume.mesh), 36.5609, 5e-5);
  EXPECT_THROW(readSurface(folder / "liver_for_test_broken.vtk"), BadInput);
}

// Every voxel of every lattice is inside the box exactly where its centre is.
TEST(Voxelise, BoxOnAllLattices) {
  SurfaceFile a = readText("box.obj", box);
  a.mesh.vertices_lps_mm *= 7.0;
  for (const test::Lattice& l : test::lattices({7, 10.5, 14}, 20, {1.1, 0.9, 2.3})) {
    const image::Mask m = voxelise(a.mesh, l.grid);
    for (int k = 0; k < l.grid.size.z(); ++k)
      for (int j = 0; j < l.grid.size.y(); ++j)
        for (int i = 0; i < l.grid.size.x(); ++i) {
          const Eigen::Vector3d p = l.grid.indexToLps(Eigen::Vector3d(i, j, k));
          const bool inside = p.minCoeff() > 0 && (p.array() < Eigen::Array3d(14, 21, 28)).all();
          ASSERT_EQ(m.at(i, j, k) != 0, inside) << l.name << ' ' << p.transpose();
        }
  }
}

// Centres exactly on faces, edges and corners: two boxes side by side share none and leave none out.
TEST(Voxelise, NeighboursTileTheLattice) {
  SurfaceFile a = readText("box.obj", box), b = a;
  b.mesh.vertices_lps_mm.row(0).array() += 2.0;
  image::Grid g;
  g.size = {9, 9, 9};
  g.origin_lps_mm = {-2, -2, -2};
  const image::Mask left = voxelise(a.mesh, g), right = voxelise(b.mesh, g);
  std::size_t inLeft = 0, inRight = 0;
  for (std::size_t i = 0; i < left.values.size(); ++i) {
    EXPECT_FALSE(left.values[i] && right.values[i]);
    inLeft += left.values[i];
    inRight += right.values[i];
  }
  EXPECT_EQ(inLeft, 24u);
  EXPECT_EQ(inRight, 24u);
}

TEST(Voxelise, ThereAndBack) {
  image::Grid g;
  g.size = {60, 60, 60};
  const Eigen::Vector3d c(29.3, 30.1, 28.7);
  const image::Mask ball = test::maskOf(g, [&](const Eigen::Vector3d& p) { return (p - c).norm() < 22; });
  const TriangleMesh surface = liverSurface(ball);
  const image::Mask back = voxelise(surface, g);
  std::size_t differ = 0, all = 0;
  for (std::size_t i = 0; i < ball.values.size(); ++i) {
    differ += ball.values[i] != back.values[i];
    all += ball.values[i];
  }
  EXPECT_LT(static_cast<double>(differ), 0.02 * static_cast<double>(all));
  const image::Grid around = gridAround(surface);
  std::size_t inside = 0;
  for (const auto v : voxelise(surface, around).values) inside += v;
  EXPECT_NEAR(static_cast<double>(inside) * around.spacing_mm.prod(), volume_mm3(surface), 1e-3 * volume_mm3(surface));
}

TEST(Voxelise, AnOpenSurfaceHasNoInside) {
  SurfaceFile a = readText("box.obj", box);
  a.mesh.triangles.conservativeResize(3, 11);
  EXPECT_THROW(voxelise(a.mesh, image::Grid{}), BadInput);
}

}  // namespace
}  // namespace glisson::anatomy
