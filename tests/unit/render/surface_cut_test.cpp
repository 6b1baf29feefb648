// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/surface_cut.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <numeric>

#include "render/overlay.h"
#include "render/rigid_bar.h"
#include "scene_fixture.h"

namespace glisson::render {
namespace {

SlicePlane planeAt(double z_mm) {
  SlicePlane plane;
  plane.corner_lps = {-30.0, -30.0, z_mm};
  plane.right = Eigen::Vector3d::UnitX();
  plane.down = Eigen::Vector3d::UnitY();
  plane.mmPerPixel = 0.25;
  plane.width = plane.height = 240;
  return plane;
}

double area_mm2(const SurfaceCut& cut, const SlicePlane& plane) {
  return std::accumulate(cut.inside.begin(), cut.inside.end(), 0.0) * plane.mmPerPixel * plane.mmPerPixel;
}

TEST(SurfaceCut, HoldsWhatLiesInsideAClosedSurface) {
  const double radius = 6.0;
  const anatomy::TriangleMesh bar = barMesh({{-15.0, 4.0, 0.0}, {15.0, 4.0, 0.0}}, radius);
  for (const double z : {0.03, 2.0, -4.5, 5.9, 7.0}) {
    const SlicePlane plane = planeAt(z);
    const SurfaceCut cut = cutSurface(plane, bar);
    const double half = z * z < radius * radius ? std::sqrt(radius * radius - z * z) : 0.0;
    EXPECT_NEAR(area_mm2(cut, plane), 60.0 * half + std::numbers::pi * half * half, 0.02 * 60.0 * radius) << z;
    EXPECT_EQ(std::count(cut.closed.begin(), cut.closed.end(), 0), 0) << z;
    EXPECT_EQ(cut.lines.empty(), half == 0.0) << z;
  }
}

TEST(SurfaceCut, CountsAPlaceThatTheSurfaceCoversTwice) {
  anatomy::TriangleMesh both = barMesh({{-15.0, 0.0, 0.0}, {5.0, 0.0, 0.0}}, 5.0);
  const anatomy::TriangleMesh other = barMesh({{-5.0, 0.0, 0.0}, {15.0, 0.0, 0.0}}, 5.0);
  const Eigen::Index n = both.vertices_lps_mm.cols(), t = both.triangles.cols();
  both.vertices_lps_mm.conservativeResize(3, n + other.vertices_lps_mm.cols());
  both.vertices_lps_mm.rightCols(other.vertices_lps_mm.cols()) = other.vertices_lps_mm;
  both.triangles.conservativeResize(3, t + other.triangles.cols());
  both.triangles.rightCols(other.triangles.cols()) = other.triangles.array() + static_cast<int>(n);
  const SlicePlane plane = planeAt(0.03);
  EXPECT_NEAR(area_mm2(cutSurface(plane, both), plane), 300.0 + std::numbers::pi * 25.0, 4.0);
}

TEST(SurfaceCut, SaysWhereASurfaceIsOpen) {
  anatomy::TriangleMesh open = barMesh({{-15.0, 0.0, 0.0}, {15.0, 0.0, 0.0}}, 5.0);
  open.triangles.conservativeResize(3, open.triangles.cols() / 2);
  const SurfaceCut cut = cutSurface(planeAt(0.03), open);
  EXPECT_GT(std::count(cut.closed.begin(), cut.closed.end(), 0), 10);
}

TEST(SurfaceCut, HolesAreFilledFromTheirBorder) {
  std::vector<float> values(25, 2.0F);
  std::vector<std::uint8_t> unknown(25, 0);
  for (const std::size_t n : {6U, 7U, 8U, 11U, 12U, 13U, 16U, 17U, 18U}) unknown[n] = 1, values[n] = 99.0F;
  fillFromBeside(unknown, 5, values);
  for (const float v : values) EXPECT_FLOAT_EQ(v, 2.0F);
}

/// The cells' field and the surface in contact say different things: the liver ends where its surface does.
TEST(SliceOverlay, theLiverInContactEndsAtItsSurface) {
  image::Grid grid;
  grid.size = {60, 60, 5};
  grid.spacing_mm = {1.0, 1.0, 2.0};
  grid.origin_lps_mm = {-30.0, -30.0, -4.0};
  const test::SceneForms forms{[](const Eigen::Vector3d& p) { return std::abs(p.x()) < 15 && std::abs(p.y()) < 6; },
                               [](const Eigen::Vector3d&) { return 100.0F; },
                               [](const Eigen::Vector3d&) { return Eigen::Vector3d(0, 1, 0); },
                               [](const Eigen::Vector3d&) { return Eigen::Vector3d(0, 1, 0); }};
  RetractionScene scene = test::sceneFrom(grid, forms);
  RigidBar bar;
  bar.surface = barMesh({{-15.0, 0.0, 0.0}, {15.0, 0.0, 0.0}}, 5.0);
  bar.centreline_lps_mm = {{-15.0, -20.0, 0.0}, {15.0, -20.0, 0.0}};
  bar.mre.u_mm = Eigen::Vector3f(0, 1, 0).replicate(1, bar.surface.vertices_lps_mm.cols());
  bar.mre.pressure_kPa = Eigen::VectorXf::Zero(bar.surface.vertices_lps_mm.cols());
  scene.bar = bar;
  const SliceOverlayOptions options{.slice = 2, .pixelsPerVoxel = 4, .decorate = false, .outlines = false};
  const Picture picture = sliceOverlay(scene, options);
  std::size_t lit = 0, steel = 0;
  for (std::size_t n = 0; n + 2 < picture.rgb.size(); n += 3) {
    EXPECT_EQ(picture.rgb[n], picture.rgb[n + 2]);
    if (picture.rgb[n] > 150) ++lit;
    if (picture.rgb[n] == 140) ++steel;
  }
  EXPECT_NEAR(static_cast<double>(steel) / 16.0, 300.0 + std::numbers::pi * 25.0, 15.0) << "the bar, where it ends";
  EXPECT_NEAR(static_cast<double>(lit) / 16.0, 300.0 + std::numbers::pi * 25.0, 15.0)
      << "not the 30 mm × 12 mm of the cells";
}

}  // namespace
}  // namespace glisson::render
