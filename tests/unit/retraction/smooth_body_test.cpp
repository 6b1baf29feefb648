// SPDX-License-Identifier: GPL-3.0-or-later
#include "retraction/smooth_body.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "../anatomy/lattices.h"
#include "anatomy/triangle_mesh.h"
#include "base/error.h"
#include "base/parallel.h"
#include "image/morphology.h"

namespace glisson::retraction {
namespace {

using anatomy::test::lattices;
using anatomy::test::maskOf;
using Eigen::Vector3d;

const Vector3d fine(1.5, 1.5, 1.5), thick(1.6, 1.6, 5.0);
const Vector3d centre(-40, 25, 110);

anatomy::TriangleMesh meshOf(const mechanics::TriangleSurface& s) {
  anatomy::TriangleMesh m;
  m.vertices_lps_mm.resize(3, static_cast<Eigen::Index>(s.vertices.size()));
  m.triangles.resize(3, static_cast<Eigen::Index>(s.triangles.size()));
  for (Eigen::Index v = 0; v < m.vertices_lps_mm.cols(); ++v)
    m.vertices_lps_mm.col(v) = s.vertices[static_cast<std::size_t>(v)];
  for (Eigen::Index t = 0; t < m.triangles.cols(); ++t)
    for (Eigen::Index a = 0; a < 3; ++a)
      m.triangles(a, t) = s.triangles[static_cast<std::size_t>(t)][static_cast<std::size_t>(a)];
  return m;
}

double volumeOf(const image::Mask& mask) {
  return static_cast<double>(image::count(mask)) * mask.grid.voxelVolume_mm3();
}

double sum(const image::ScalarVolume& v) {
  double s = 0.0;
  for (const float f : v.values) s += static_cast<double>(f);
  return s;
}

double smallestTriangle_mm2(const mechanics::TriangleSurface& s) {
  double least = 1e9;
  for (const auto& t : s.triangles) {
    auto at = [&](std::size_t a) { return s.vertices[static_cast<std::size_t>(t[a])]; };
    least = std::min(least, 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).norm());
  }
  return least;
}

image::Mask ball(const image::Grid& g, double radius_mm) {
  return maskOf(g, [&](const Vector3d& p) { return (p - centre).norm() <= radius_mm; });
}

constexpr double a_mm = 60, b_mm = 42, c_mm = 30;
image::Mask ellipsoid(const image::Grid& g) {
  return maskOf(
      g, [&](const Vector3d& p) { return (p - centre).cwiseQuotient(Vector3d(a_mm, b_mm, c_mm)).norm() <= 1.0; });
}

/// By quadrature: the closed form needs elliptic integrals.
double ellipsoidArea_mm2() {
  double area = 0.0;
  constexpr int n = 2000;
  for (int i = 0; i < n; ++i) {
    const double theta = std::numbers::pi * (i + 0.5) / n;
    for (int j = 0; j < 400; ++j) {
      const double phi = 2.0 * std::numbers::pi * (j + 0.5) / 400;
      const Vector3d dTheta(a_mm * std::cos(theta) * std::cos(phi), b_mm * std::cos(theta) * std::sin(phi),
                            -c_mm * std::sin(theta));
      const Vector3d dPhi(-a_mm * std::sin(theta) * std::sin(phi), b_mm * std::sin(theta) * std::cos(phi), 0.0);
      area += dTheta.cross(dPhi).norm();
    }
  }
  return area * (std::numbers::pi / n) * (2.0 * std::numbers::pi / 400);
}

TEST(SmoothBody, SphereAndEllipsoidHaveTheirVolumeAndArea) {
  const double r = 45.0, ellipsoidArea = ellipsoidArea_mm2();
  for (const Vector3d& spacing : {fine, thick})
    for (const auto& [name, grid] : lattices(centre, 75.0, spacing)) {
      SCOPED_TRACE(name + ", slices of " + std::to_string(spacing.z()) + " mm");
      const anatomy::TriangleMesh s = meshOf(SmoothBody(ball(grid, r)).surface());
      EXPECT_TRUE(anatomy::isClosed(s));
      const double sphere = 4.0 / 3.0 * std::numbers::pi * r * r * r;
      EXPECT_NEAR(anatomy::volume_mm3(s), sphere, 0.01 * sphere);
      EXPECT_NEAR(anatomy::area_mm2(s), 4.0 * std::numbers::pi * r * r, 0.01 * 4.0 * std::numbers::pi * r * r);

      const image::Mask mask = ellipsoid(grid);
      const anatomy::TriangleMesh e = meshOf(SmoothBody(mask).surface());
      EXPECT_TRUE(anatomy::isClosed(e));
      const double body = 4.0 / 3.0 * std::numbers::pi * a_mm * b_mm * c_mm;
      EXPECT_NEAR(anatomy::volume_mm3(e), body, 0.01 * body);
      EXPECT_NEAR(anatomy::volume_mm3(e), volumeOf(mask), 0.005 * body);
      EXPECT_NEAR(anatomy::area_mm2(e), ellipsoidArea, 0.01 * ellipsoidArea);
    }
}

TEST(SmoothBody, SurfaceIsCloseToTheShapeAndOnOtherSpacingsToo) {
  const image::Grid grid = lattices(centre, 60.0, fine)[2].grid;
  const SmoothBody body(ball(grid, 45.0));
  for (const double spacing_mm : {1.5, 2.2, 3.0}) {
    const mechanics::TriangleSurface s = body.surface(spacing_mm);
    EXPECT_TRUE(anatomy::isClosed(meshOf(s)));
    EXPECT_GT(smallestTriangle_mm2(s), 1e-5);
    double worst = 0.0;
    for (const Vector3d& v : s.vertices) worst = std::max(worst, std::abs((v - centre).norm() - 45.0));
    EXPECT_LT(worst, 0.75) << spacing_mm;  // half a voxel
  }
  EXPECT_THROW(body.surface(0.0), BadArgument);
}

TEST(SmoothBody, FractionsAddUpToTheVolumeOnAnyGrid) {
  for (const Vector3d& spacing : {fine, thick})
    for (const auto& [name, grid] : lattices(centre, 70.0, spacing)) {
      const image::Mask mask = ellipsoid(grid);
      const SmoothBody body(mask);
      for (const auto& [cellsName, cells] : lattices(centre, 66.0, Vector3d(6.56, 4.0, 5.0))) {
        const image::ScalarVolume f = body.fractions(cells);
        EXPECT_TRUE(f.grid.sameGeometry(cells));
        EXPECT_NEAR(sum(f) * cells.voxelVolume_mm3(), volumeOf(mask), 0.005 * volumeOf(mask)) << name << cellsName;
        for (const float v : f.values) EXPECT_TRUE(v >= 0.0f && v <= 1.0f);
      }
    }
}

TEST(SmoothBody, FractionsGrowTheGridWhereTheBodyWouldBeCut) {
  const image::Mask mask = ball(lattices(centre, 60.0, fine)[0].grid, 40.0);
  const SmoothBody body(mask);
  image::Grid cells;
  cells.spacing_mm = Vector3d(5, 5, 5);
  cells.size = Eigen::Vector3i(15, 15, 15);  // ±37.5 mm
  cells.origin_lps_mm = centre - Vector3d::Constant(35.0);
  const image::ScalarVolume f = body.fractions(cells);
  EXPECT_EQ(f.grid.size, Eigen::Vector3i(17, 17, 17));
  EXPECT_NEAR((f.grid.indexToLps(Vector3d(1, 1, 1)) - cells.origin_lps_mm).norm(), 0.0, 1e-9);
  EXPECT_NEAR(sum(f) * 125.0, volumeOf(mask), 0.005 * volumeOf(mask));
}

TEST(SmoothBody, FractionsOfAHalfSpaceAreTheShareThatTheFaceCutsOff) {
  image::Grid g;
  g.size = Eigen::Vector3i(60, 60, 60);
  const SmoothBody body(maskOf(g, [](const Vector3d& p) { return (p.array() >= 10).all() && (p.array() < 50).all(); }));
  image::Grid cells;  // the block's face at x = 9.5 cuts the first cell at a quarter of its width
  cells.spacing_mm = Vector3d(8, 8, 8);
  cells.size = Eigen::Vector3i(6, 6, 6);
  cells.origin_lps_mm = Vector3d(7.5, 11.5, 11.5);
  const image::ScalarVolume f = body.fractions(cells);
  const Eigen::Vector3i extra = (f.grid.size - cells.size) / 2;
  EXPECT_NEAR(static_cast<double>(f.at(extra + Eigen::Vector3i(0, 2, 2))), 0.25, 1.0 / 64.0 + 0.01);
  EXPECT_EQ(f.at(extra + Eigen::Vector3i(2, 2, 2)), 1.0f);
}

TEST(SmoothBody, ThinLobesDoNotVanish) {
  for (const auto& [name, grid] : lattices(centre, 60.0, Vector3d(1.6, 1.6, 5.0))) {
    SCOPED_TRACE(name);
    // A lobe of 8 mm, 30 mm wide, that leaves a ball by 25 mm.
    const image::Mask mask = maskOf(grid, [&](const Vector3d& p) {
      const Vector3d d = p - centre;
      return d.norm() <= 30.0 || (d.x() > 0.0 && d.x() < 55.0 && std::abs(d.y()) <= 4.0 && std::abs(d.z()) <= 15.0);
    });
    const SmoothBody body(mask);
    EXPECT_EQ(body.leftOut_mm3(), 0.0);
    const mechanics::TriangleSurface s = body.surface();
    EXPECT_TRUE(anatomy::isClosed(meshOf(s)));
    double reach = 0.0;
    for (const Vector3d& v : s.vertices) reach = std::max(reach, v.x() - centre.x());
    EXPECT_GT(reach, 52.0);
    for (const double x : {35.0, 42.0, 48.0})
      for (const double z : {-8.0, 0.0, 8.0}) EXPECT_TRUE(body.inside(centre + Vector3d(x, 0, z))) << x << " " << z;
  }
}

TEST(SmoothBody, KeepsTheLargestPieceAndLeavesCavitiesOutOfTheSurface) {
  const image::Grid grid = lattices(centre, 70.0, fine)[1].grid;
  const Vector3d other = centre + Vector3d(56, 0, 0);
  const image::Mask mask = maskOf(grid, [&](const Vector3d& p) {
    const double r = (p - centre).norm();
    return (r <= 40.0 && r >= 10.0) || (p - other).norm() <= 12.0;
  });
  const SmoothBody body(mask);
  const double islet = 4.0 / 3.0 * std::numbers::pi * 12 * 12 * 12;
  EXPECT_NEAR(body.leftOut_mm3(), islet, 0.1 * islet);
  EXPECT_FALSE(body.inside(other));
  EXPECT_FALSE(body.inside(centre));
  const mechanics::TriangleSurface s = body.surface();
  EXPECT_TRUE(anatomy::isClosed(meshOf(s)));
  for (const Vector3d& v : s.vertices) ASSERT_NEAR((v - centre).norm(), 40.0, 1.0);
  const double shell = 4.0 / 3.0 * std::numbers::pi * (40.0 * 40 * 40 - 10.0 * 10 * 10);
  EXPECT_NEAR(sum(body.fractions(grid)) * grid.voxelVolume_mm3(), shell, 0.01 * shell);
}

TEST(SmoothBody, ValueIsTheGaussianOfAHalfSpaceAndItsGradientPointsInwards) {
  image::Grid g;
  g.spacing_mm = Vector3d(1.0, 1.0, 1.0);
  g.size = Eigen::Vector3i(60, 60, 60);
  const SmoothBody body(maskOf(g, [](const Vector3d&) { return true; }));
  EXPECT_GT(body.level(), 0.45);  // rounding takes volume from the block's edges, a lower level gives it back
  EXPECT_LT(body.level(), 0.5);
  EXPECT_NEAR(body.value(Vector3d(30, 30, 30)), 1.0, 1e-4);
  EXPECT_EQ(body.value(Vector3d(-30, 30, 30)), 0.0);
  for (const double x : {-4.0, -2.0, -0.5, 1.0, 3.0}) {
    const double smoothed = 0.5 * std::erfc(-(x + 0.5) / (2.0 * std::numbers::sqrt2));
    EXPECT_NEAR(body.value(Vector3d(x, 30, 30)), smoothed, 0.02) << x;
  }
  const Vector3d gradient = body.gradient(Vector3d(-0.5, 30, 30));
  EXPECT_NEAR(gradient.x(), 1.0 / (2.0 * std::sqrt(2.0 * std::numbers::pi)), 0.03);
  EXPECT_NEAR(gradient.tail<2>().norm(), 0.0, 1e-6);
}

TEST(SmoothBody, SameBitsWithAnyNumberOfThreads) {
  const image::Mask mask = ellipsoid(lattices(centre, 70.0, thick)[3].grid);
  const int before = threadCount();
  setThreadCount(1);
  const SmoothBody one(mask);
  const auto fractions = one.fractions(mask.grid).values;
  setThreadCount(5);
  const SmoothBody five(mask);
  EXPECT_EQ(one.level(), five.level());
  EXPECT_EQ(fractions, five.fractions(mask.grid).values);
  const auto a = one.surface(), b = five.surface();
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_TRUE(a.vertices == b.vertices);
  setThreadCount(before);
}

TEST(SmoothBody, RefusesWhatHasNoBody) {
  image::Grid g;
  g.size = Eigen::Vector3i(5, 5, 5);
  EXPECT_THROW(SmoothBody{image::Mask(g)}, BadInput);
}

}  // namespace
}  // namespace glisson::retraction
