// SPDX-License-Identifier: GPL-3.0-or-later
#include "anatomy/surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <numbers>

#include "anatomy/regions.h"
#include "base/error.h"
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

/// Surface area of an ellipsoid (Knud Thomsen's formula, error at most 1.061 %).
double ellipsoidArea(double a, double b, double c) {
  const double p = 1.6075;
  return 4.0 * std::numbers::pi *
         std::pow((std::pow(a * b, p) + std::pow(a * c, p) + std::pow(b * c, p)) / 3.0, 1.0 / p);
}

TEST(Mesh, TetrahedronHasItsAreaAndVolume) {
  TriangleMesh t;
  t.vertices_lps_mm.resize(3, 4);
  t.vertices_lps_mm << 0, 2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 4;
  t.vertices_lps_mm.colwise() += Eigen::Vector3d(100, -200, 900);
  t.triangles.resize(3, 4);
  t.triangles << 0, 0, 0, 1, 2, 1, 3, 2, 1, 3, 2, 3;
  EXPECT_NEAR(volume_mm3(t), 4.0, 1e-12);
  EXPECT_NEAR(area_mm2(t), 3.0 + 4.0 + 6.0 + 0.5 * std::sqrt(12 * 12 + 8 * 8 + 6 * 6), 1e-12);
  EXPECT_TRUE(isClosed(t));
  t.triangles.conservativeResize(3, 3);
  EXPECT_FALSE(isClosed(t));
}

TEST(LiverSurface, EllipsoidOnEveryLattice) {
  const Eigen::Vector3d semi(60, 45, 38);
  const double area = ellipsoidArea(60, 45, 38), volume = 4.0 / 3.0 * std::numbers::pi * semi.prod();
  for (const Eigen::Vector3d& spacing : {Eigen::Vector3d(1.64, 1.64, 3.0), Eigen::Vector3d(1.64, 1.64, 10.0),
                                         Eigen::Vector3d(2.5, 2.5, 2.5), Eigen::Vector3d(1.2, 2.0, 6.0)})
    for (const Lattice& l : lattices(centre, 75, spacing)) {
      const image::Mask m =
          maskOf(l.grid, [&](const Eigen::Vector3d& p) { return (p - centre).cwiseQuotient(semi).norm() < 1.0; });
      const TriangleMesh s = liverSurface(m);
      EXPECT_TRUE(isClosed(s)) << l.name;
      EXPECT_NEAR(volume_mm3(s) / voxelVolume_mm3(m), 1.0, 1e-3) << l.name;
      EXPECT_NEAR(volume_mm3(s) / volume, 1.0, 0.02) << l.name;
      EXPECT_NEAR(area_mm2(s) / area, 1.0, 0.04) << l.name;
      double sum = 0.0, worst = 0.0;
      for (Eigen::Index v = 0; v < s.vertices_lps_mm.cols(); ++v) {
        const Eigen::Vector3d d = s.vertices_lps_mm.col(v) - centre;
        const double r = d.cwiseQuotient(semi).norm();
        // First-order distance to the ellipsoid: level divided by the length of its gradient.
        const double off_mm = std::abs(r - 1.0) / (d.cwiseQuotient(semi.cwiseAbs2()).norm() / r);
        sum += off_mm;
        worst = std::max(worst, off_mm);
      }
      const double mean = sum / static_cast<double>(s.vertices_lps_mm.cols());
      std::printf(
          "  %-22s spacing %.2f %.2f %.1f: volume %+.3f %% of voxels, %+.2f %% of truth; area %+.2f %%; off %.2f "
          "mean %.2f max mm; %ld triangles\n",
          l.name.c_str(), spacing.x(), spacing.y(), spacing.z(), 100 * (volume_mm3(s) / voxelVolume_mm3(m) - 1),
          100 * (volume_mm3(s) / volume - 1), 100 * (area_mm2(s) / area - 1), mean, worst,
          static_cast<long>(s.triangles.cols()));
      EXPECT_LT(mean, 0.1 * spacing.maxCoeff()) << l.name;
      EXPECT_LT(worst, 0.5 * spacing.norm()) << l.name;  // a mask knows its surface to half a voxel diagonal
    }
}

TEST(LiverSurface, KeepsPlaceAndHandOfTheLetterF) {
  const image::Mask f = glisson::test::letterF();
  const TriangleMesh s = liverSurface(f, {1.0, 5});
  EXPECT_TRUE(isClosed(s));
  EXPECT_NEAR(volume_mm3(s) / voxelVolume_mm3(f), 1.0, 1e-3);
  // First moments of the enclosed solid against those of the voxels: place and hand.
  Eigen::Vector3d voxels = Eigen::Vector3d::Zero(), mesh = Eigen::Vector3d::Zero();
  for (int k = 0; k < f.grid.size.z(); ++k)
    for (int j = 0; j < f.grid.size.y(); ++j)
      for (int i = 0; i < f.grid.size.x(); ++i)
        if (f.at(i, j, k) != 0) voxels += f.grid.indexToLps(Eigen::Vector3d(i, j, k));
  voxels /= static_cast<double>(image::count(f));
  double volume = 0.0;
  const Eigen::Vector3d o = f.grid.origin_lps_mm;
  for (Eigen::Index t = 0; t < s.triangles.cols(); ++t) {
    const Eigen::Vector3d a = s.vertices_lps_mm.col(s.triangles(0, t)) - o,
                          b = s.vertices_lps_mm.col(s.triangles(1, t)) - o,
                          c = s.vertices_lps_mm.col(s.triangles(2, t)) - o;
    const double v = a.dot(b.cross(c)) / 6.0;
    volume += v;
    mesh += v * (a + b + c) / 4.0;
  }
  EXPECT_LT((mesh / volume + o - voxels).norm(), 0.3);
}

TEST(LiverSurface, PartsAndBordersOfTheImage) {
  image::Grid g;
  g.size = {20, 20, 20};
  g.spacing_mm = {2, 2, 2};
  image::Mask m(g, 1);  // fills the image to its border
  EXPECT_TRUE(isClosed(liverSurface(m)));
  EXPECT_NEAR(volume_mm3(liverSurface(m)), 64000.0, 64.0);
  std::fill(m.values.begin(), m.values.end(), std::uint8_t{0});
  EXPECT_THROW(liverSurface(m), BadInput);
  for (int k = 2; k < 8; ++k)
    for (int j = 2; j < 8; ++j)
      for (int i = 2; i < 8; ++i) m.at(i, j, k) = m.at(i + 10, j + 10, k + 10) = 1;
  EXPECT_TRUE(isClosed(liverSurface(m)));
  EXPECT_NEAR(volume_mm3(liverSurface(m)), 2 * 216 * 8.0, 10.0);
}

TEST(Regions, HoistPointIsUnderTheRightLobe) {
  // An ellipsoid long in x: its right third, lowest part.
  const Eigen::Vector3d semi(90, 60, 50);
  for (const Eigen::Vector3d& spacing : {Eigen::Vector3d(1.64, 1.64, 3.0), Eigen::Vector3d(1.64, 1.64, 10.0)})
    for (const Lattice& l : lattices(centre, 110, spacing)) {
      const image::Mask m =
          maskOf(l.grid, [&](const Eigen::Vector3d& p) { return (p - centre).cwiseQuotient(semi).norm() < 1.0; });
      const Eigen::Vector3d p = inferiorRightLobePoint(m) - centre;
      EXPECT_LT(p.x(), -30.0) << l.name;  // right of the border of the right third
      EXPECT_GT(p.x(), -60.0) << l.name;
      EXPECT_LT(std::abs(p.y()), 6.0) << l.name;
      const double surface = -semi.z() * std::sqrt(1.0 - std::pow(p.x() / semi.x(), 2) - std::pow(p.y() / semi.y(), 2));
      const double voxel = l.grid.direction.row(2).cwiseAbs().dot(spacing);
      EXPECT_NEAR(p.z(), surface, 0.75 * voxel) << l.name;
    }
  EXPECT_THROW(inferiorRightLobePoint(image::Mask(lattices(centre, 10, {1, 1, 1})[0].grid)), BadInput);
}

TEST(Regions, RightLobeHangsLowerAndANotchIsAvoided) {
  // Two legs of a horseshoe: right (x < 0) down to z = 10, left down to z = 0; the right leg is split by a notch.
  image::Grid g;
  g.size = {90, 40, 60};
  g.origin_lps_mm = {-45, 0, 0};
  const image::Mask m = maskOf(g, [](const Eigen::Vector3d& p) {
    const bool body = p.z() > 30;
    const bool right = p.x() < -20 && p.z() > 9.5 && std::abs(p.y() - 19.5) > 5;
    const bool left = p.x() > 25;
    return body || right || left;
  });
  const Eigen::Vector3d p = inferiorRightLobePoint(m);
  EXPECT_NEAR(p.z(), 9.5, 0.01);
  EXPECT_LT(p.x(), -15.0);
  EXPECT_GT(std::abs(p.y() - 19.5), 4.9);
}

}  // namespace
}  // namespace glisson::anatomy
