// SPDX-License-Identifier: GPL-3.0-or-later
#include "anatomy/tetrahedra.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <numbers>

#include "anatomy/surface.h"
#include "base/error.h"
#include "base/parallel.h"
#include "image/morphology.h"
#include "lattices.h"
#include "support/support.h"

namespace glisson::anatomy {
namespace {

using namespace test;
const Eigen::Vector3d centre(-40, 20, 300);

double voxelVolume_mm3(const image::Mask& m) {
  return static_cast<double>(image::count(m)) * m.grid.voxelVolume_mm3();
}

TEST(MeshQuality, RegularAndFlatTetrahedra) {
  Eigen::Matrix3Xd p(3, 4);
  p << 1, 1, -1, -1, 1, -1, 1, -1, 1, -1, -1, 1;  // corners of a cube: regular, edge 2 √2
  Eigen::Matrix4Xi t(4, 1);
  t << 0, 2, 1, 3;
  MeshQuality q = qualityOf(p, t);
  if (q.flatOrInverted > 0) {
    t << 0, 1, 2, 3;
    q = qualityOf(p, t);
  }
  const double regular_deg = std::acos(1.0 / 3.0) * 180.0 / std::numbers::pi;
  EXPECT_NEAR(q.leastDihedral_deg, regular_deg, 1e-9);
  EXPECT_NEAR(q.largestDihedral_deg, regular_deg, 1e-9);
  EXPECT_NEAR(q.worstRadiusEdge, std::sqrt(6.0) / 4.0, 1e-12);
  EXPECT_NEAR(q.volume_mm3, 8.0 / 3.0, 1e-12);
  EXPECT_NEAR(q.longestEdge_mm, 2.0 * std::numbers::sqrt2, 1e-12);
  EXPECT_EQ(q.flatOrInverted, 0);
  EXPECT_TRUE(isClosed({p, boundaryOf(t)}));
  EXPECT_GT(volume_mm3({p, boundaryOf(t)}), 0.0);  // outward
  std::swap(t(0, 0), t(1, 0));
  EXPECT_EQ(qualityOf(p, t).flatOrInverted, 1);
  p.col(3) = (p.col(0) + p.col(1) + p.col(2)) / 3.0;
  EXPECT_EQ(qualityOf(p, t).flatOrInverted, 1);
  t(0, 0) = 4;
  EXPECT_THROW(qualityOf(p, t), BadArgument);
  EXPECT_THROW(qualityOf(p, Eigen::Matrix4Xi(4, 0)), BadArgument);
}

TEST(Tetrahedra, EllipsoidOnEveryLattice) {
  const Eigen::Vector3d semi(60, 45, 38);
  const double volume = 4.0 / 3.0 * std::numbers::pi * semi.prod();
  for (const Eigen::Vector3d& spacing : {Eigen::Vector3d(1.64, 1.64, 10.0), Eigen::Vector3d(1, 2, 3)})
    for (const Lattice& l : lattices(centre, 70, spacing)) {
      const image::Mask m =
          maskOf(l.grid, [&](const Eigen::Vector3d& p) { return (p - centre).cwiseQuotient(semi).norm() < 1.0; });
      const TetrahedralMesh t = tetrahedra(m, {});
      std::printf("  %-22s %.2f %.2f %.1f: %s\n", l.name.c_str(), spacing.x(), spacing.y(), spacing.z(),
                  t.note.c_str());
      EXPECT_TRUE(isClosed(t.boundary)) << l.name;
      EXPECT_EQ(t.quality.flatOrInverted, 0);
      EXPECT_GE(t.quality.leastDihedral_deg, 5.0);
      EXPECT_NEAR(t.quality.volume_mm3 / voxelVolume_mm3(m), 1.0, 2e-3) << l.name;
      EXPECT_NEAR(volume_mm3(t.boundary) / t.quality.volume_mm3, 1.0, 1e-9) << l.name;
      EXPECT_NEAR(t.quality.volume_mm3 / volume, 1.0, 0.02) << l.name;
      double worst = 0.0, sum = 0.0, area = 0.0;
      for (Eigen::Index v = 0; v < t.boundary.triangles.cols(); ++v) {
        const Eigen::Vector3d a = t.points_lps_mm.col(t.boundary.triangles(0, v)),
                              b = t.points_lps_mm.col(t.boundary.triangles(1, v)),
                              c = t.points_lps_mm.col(t.boundary.triangles(2, v));
        const Eigen::Vector3d d = (a + b + c) / 3.0 - centre;
        const double r = d.cwiseQuotient(semi).norm();
        const double off = std::abs(r - 1.0) / (d.cwiseQuotient(semi.cwiseAbs2()).norm() / r);
        const double size = 0.5 * (b - a).cross(c - a).norm();
        worst = std::max(worst, off);
        sum += size * off;
        area += size;
      }
      std::printf("      off %.2f mean, %.2f max mm\n", sum / area, worst);
      EXPECT_LT(worst, 0.5 * spacing.norm()) << l.name;
    }
}

TEST(Tetrahedra, AreFinerNearTheTool) {
  const Eigen::Vector3d semi(60, 45, 38);
  const image::Mask m = maskOf(lattices(centre, 70, {2, 2, 3})[0].grid,
                               [&](const Eigen::Vector3d& p) { return (p - centre).cwiseQuotient(semi).norm() < 1.0; });
  TetrahedraOptions o;
  o.cell_mm = 14.0;
  o.tool = {{centre + Eigen::Vector3d(-20, -40, -20), centre + Eigen::Vector3d(20, -40, -20)}};
  o.toolCell_mm = 4.0;
  const TetrahedralMesh t = tetrahedra(m, o);
  std::printf("  %s\n", t.note.c_str());
  // Circumradii keep what was asked for at the circumcentre, before slivers are removed: edges a quarter longer at
  // most.
  int near = 0;
  for (Eigen::Index c = 0; c < t.cells.cols(); ++c) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (int v = 0; v < 4; ++v) middle += t.points_lps_mm.col(t.cells(v, c)) / 4.0;
    const double away = distanceToSegment(middle, (*o.tool)[0], (*o.tool)[1]);
    double longest = 0.0;
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < a; ++b)
        longest = std::max(longest, (t.points_lps_mm.col(t.cells(a, c)) - t.points_lps_mm.col(t.cells(b, c))).norm());
    const double allowed = std::min(14.0, 4.0 + 0.3 * std::max(0.0, away - 10.0));
    EXPECT_LT(longest, 2.0 * 0.7 * allowed * 1.35) << "at " << away << " mm";
    if (away < 10.0) ++near;
  }
  EXPECT_GT(near, 200);
}

TEST(Tetrahedra, CavitiesIslandsAndThinSheets) {
  // A thick shell: its cavity stays.
  const image::Grid g = lattices(centre, 42, {2, 2, 2})[2].grid;
  const image::Mask shell = maskOf(g, [](const Eigen::Vector3d& p) {
    const double r = (p - centre).norm();
    return r < 40 && r > 16;
  });
  const TetrahedralMesh t = tetrahedra(shell, {});
  std::printf("  shell: %s\n", t.note.c_str());
  EXPECT_NEAR(t.quality.volume_mm3 / voxelVolume_mm3(shell), 1.0, 2e-3);
  bool inner = false;
  for (Eigen::Index v = 0; v < t.boundary.triangles.cols(); ++v)
    inner = inner || (t.points_lps_mm.col(t.boundary.triangles(0, v)) - centre).norm() < 20;
  EXPECT_TRUE(inner);

  // Two islands, a crumb and a pinhole: both islands stay, the crumb goes, the pinhole is filled, with their volumes.
  image::Grid flat;
  flat.size = {60, 40, 40};
  flat.spacing_mm = {1.5, 1.5, 2};
  image::Mask two = maskOf(flat, [](const Eigen::Vector3d& p) {
    return (p - Eigen::Vector3d(25, 30, 40)).norm() < 18 || (p - Eigen::Vector3d(66, 30, 40)).norm() < 14;
  });
  const double whole = voxelVolume_mm3(two);
  two.at(1, 1, 1) = two.at(2, 1, 1) = 1;
  two.at(16, 20, 20) = 0;
  const TetrahedralMesh s = tetrahedra(two, {.cell_mm = 7.0});
  std::printf("  two: %s\n", s.note.c_str());
  EXPECT_NEAR(s.dropped_mL, 2 * 4.5e-3, 1e-12);
  EXPECT_NEAR(s.filled_mL, 4.5e-3, 1e-12);
  EXPECT_THAT(s.note, testing::HasSubstr("left out: 0.009 mL"));
  EXPECT_NEAR(s.quality.volume_mm3 / whole, 1.0, 2e-3);

  image::Mask one(flat);
  EXPECT_THROW(tetrahedra(one, {}), BadInput);
  one.at(5, 5, 5) = 1;
  const TetrahedralMesh voxel = tetrahedra(one, {});
  std::printf("  one voxel: %s\n", voxel.note.c_str());
  EXPECT_NEAR(voxel.quality.volume_mm3, 4.5, 0.03);

  image::Mask sheet(flat);
  for (int j = 5; j < 35; ++j)
    for (int i = 5; i < 45; ++i) sheet.at(i, j, 20) = 1;
  try {
    tetrahedra(sheet, {});
    FAIL() << "a sheet of 2 mm does not hold cells of 10 mm";
  } catch (const BadInput& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr("too thin"));
  }
  const TetrahedralMesh thin = tetrahedra(sheet, {.cell_mm = 2.5});
  std::printf("  sheet: %s\n", thin.note.c_str());
  EXPECT_NEAR(thin.quality.volume_mm3 / voxelVolume_mm3(sheet), 1.0, 5e-3);
  const image::Mask full(flat, 1);  // touches the border of the image everywhere
  const TetrahedralMesh box = tetrahedra(full, {.cell_mm = 14.0});
  std::printf("  full image: %s\n", box.note.c_str());
  EXPECT_NEAR(box.quality.volume_mm3 / voxelVolume_mm3(full), 1.0, 2e-3);
}

TEST(Tetrahedra, SameBitsEveryTimeAndRefusals) {
  const image::Mask m = maskOf(lattices(centre, 40, {2, 2, 5})[3].grid,
                               [&](const Eigen::Vector3d& p) { return (p - centre).norm() < 36; });
  setThreadCount(1);
  const TetrahedralMesh a = tetrahedra(m, {});
  setThreadCount(2);
  const TetrahedralMesh b = tetrahedra(m, {});
  setThreadCount(0);
  EXPECT_EQ(a.points_lps_mm, b.points_lps_mm);
  EXPECT_EQ(a.cells, b.cells);
  EXPECT_THROW(tetrahedra(m, {.cell_mm = 0.0}), BadInput);
  EXPECT_THROW(tetrahedra(m, {.cell_mm = 0.1}), BadInput);
  try {
    tetrahedra(m, {.leastDihedral_deg = 60.0});
    FAIL();
  } catch (const BadInput& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr("dihedral angle of"));
  }
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(tetrahedra(m, {}, Progress({}, stop.get_token())), Cancelled);
}

TEST(LiverSurface, ByDelaunayRefinement) {
  const Eigen::Vector3d semi(60, 45, 38);
  const image::Mask m = maskOf(lattices(centre, 70, {1.64, 1.64, 3})[2].grid,
                               [&](const Eigen::Vector3d& p) { return (p - centre).cwiseQuotient(semi).norm() < 1.0; });
  const TriangleMesh s = liverSurface(m, {.method = SurfaceMethod::Delaunay});
  EXPECT_TRUE(isClosed(s));
  EXPECT_NEAR(volume_mm3(s) / voxelVolume_mm3(m), 1.0, 1e-3);
  const TriangleMesh iso = liverSurface(m);
  std::printf("  %ld triangles, area %.1f against %.1f mm²\n", static_cast<long>(s.triangles.cols()), area_mm2(s),
              area_mm2(iso));
  EXPECT_NEAR(area_mm2(s) / area_mm2(iso), 1.0, 0.01);
  EXPECT_LT(s.triangles.cols(), iso.triangles.cols() / 4);
}

}  // namespace
}  // namespace glisson::anatomy
