// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/rigid_bar.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <numbers>

#include "anatomy/triangle_mesh.h"
#include "base/error.h"
#include "render/overlay.h"
#include "scene_fixture.h"

namespace glisson::render {
namespace {

using Line = std::vector<Eigen::Vector3d>;

/// A quarter of a circle.
Line arc(double radius, int points) {
  Line line;
  for (int n = 0; n < points; ++n) {
    const double a = 0.5 * std::numbers::pi * n / (points - 1);
    line.emplace_back(radius * std::cos(a), radius * std::sin(a), 3.0);
  }
  return line;
}

double distanceTo(const Line& line, const Eigen::Vector3d& p) {
  double least = 1e9;
  for (std::size_t n = 1; n < line.size(); ++n) {
    const Eigen::Vector3d d = line[n] - line[n - 1];
    const double s = std::clamp((p - line[n - 1]).dot(d) / d.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (p - line[n - 1] - s * d).norm());
  }
  return least;
}

TEST(BarMesh, IsRoundAndHasTheVolumeOfACapsule) {
  const Line straight{{0, 0, 0}, {60, 20, 10}};
  const double length = (straight[1] - straight[0]).norm(), r = 5.0;
  const anatomy::TriangleMesh mesh = barMesh(straight, r);
  const double whole = std::numbers::pi * r * r * (length + 4.0 / 3.0 * r);
  EXPECT_NEAR(anatomy::volume_mm3(mesh), whole, 0.01 * whole);
  for (const Line& line : {straight, arc(50.0, 17)}) {
    const anatomy::TriangleMesh bar = barMesh(line, r);
    EXPECT_GT(anatomy::volume_mm3(bar), 0.0);
    for (Eigen::Index n = 0; n < bar.vertices_lps_mm.cols(); ++n)
      ASSERT_NEAR(distanceTo(line, bar.vertices_lps_mm.col(n)), r, 0.02) << n;
  }
  EXPECT_THROW(barMesh({{0, 0, 0}}, r), BadArgument);
  EXPECT_THROW(barMesh({{0, 0, 0}, {0, 0, 0}}, r), BadArgument);
}

TEST(Pressure, HasOneScaleForBothAndTheLiversOwnColourWhereNothingTouches) {
  RigidBar bar;
  EXPECT_EQ(pressureScale_kPa(bar), 1.0);
  bar.mre.pressure_kPa = Eigen::VectorXf::LinSpaced(4, 0.0F, 13.0F);
  EXPECT_EQ(pressureScale_kPa(bar), 20.0);
  bar.atlas.emplace().pressure_kPa = Eigen::VectorXf::Constant(4, 43.0F);
  EXPECT_EQ(pressureScale_kPa(bar), 60.0);
  const std::vector<Rgb> colours = pressureColours(bar.mre, 20.0);
  ASSERT_EQ(colours.size(), 4U);
  const auto sum = [](Rgb c) { return int{c.r} + int{c.g} + int{c.b}; };
  EXPECT_EQ(sum(colours[0]), sum(pressureColour(0.0)));
  // Lightness grows with the pressure.
  EXPECT_LT(sum(colours[1]), sum(colours[2]));
  EXPECT_LT(sum(colours[2]), sum(colours[3]));
}

TEST(RigidBar, SurfaceAndLineAreMovedByTheFraction) {
  RigidBar bar;
  bar.surface.vertices_lps_mm = Eigen::Matrix3Xd::Zero(3, 2);
  bar.mre.u_mm = Eigen::Matrix3Xf::Constant(3, 2, 4.0F);
  EXPECT_EQ(movedSurface(bar, bar.mre, 0.25).vertices_lps_mm(1, 1), 1.0);
  EXPECT_EQ(movedLine({{1, 2, 3}}, {0, -10, 0}).front(), Eigen::Vector3d(1, -8, 3));
}

/// A liver under a bar that moves its underside by 20 mm with MRE, by 10 mm with the atlas.
RetractionScene withBar() {
  RetractionScene scene = test::retractionScene(1.6, 64);
  RigidBar& bar = scene.bar.emplace();
  bar.centreline_lps_mm = {*scene.retractorPoint_lps_mm - 40.0 * scene.retractorAxis,
                           *scene.retractorPoint_lps_mm + 40.0 * scene.retractorAxis};
  bar.surface = scene.liverSurface;
  const Eigen::Index n = bar.surface.vertices_lps_mm.cols();
  const auto contact = [&](double travel_mm) {
    BarContact c;
    c.travel_mm = travel_mm;
    c.u_mm = Eigen::Matrix3Xf::Zero(3, n);
    c.u_mm.row(1).setConstant(-static_cast<float>(travel_mm));
    c.pressure_kPa = Eigen::VectorXf::Zero(n);
    for (Eigen::Index i = 0; i < n; ++i)
      if ((bar.surface.vertices_lps_mm.col(i) - *scene.retractorPoint_lps_mm).norm() < 25.0) c.pressure_kPa[i] = 8.0F;
    return c;
  };
  bar.mre = contact(20.0);
  bar.atlas = contact(10.0);
  return scene;
}

std::size_t apart(const Picture& a, const Picture& b) {
  std::size_t found = 0;
  for (std::size_t i = 0; i < a.rgb.size(); i += 3) found += std::abs(a.rgb[i] - b.rgb[i]) > 40 ? 1 : 0;
  return found;
}

TEST(Pressure, IsDrawnOnTheLiverAndNeedsABar) {
  unsetenv("DISPLAY");
  unsetenv("WAYLAND_DISPLAY");
  const RetractionScene scene = withBar();
  SceneOptions3D options{
      .shown = Shown3D::PressureMre, .camera = barCamera, .width = 400, .height = 300, .decorate = false};
  const Picture pressed = overlay3D(scene, options);
  RetractionScene none = scene;
  none.bar->mre.pressure_kPa.setZero();
  none.bar->atlas->pressure_kPa.setZero();
  EXPECT_GT(apart(pressed, overlay3D(none, options)), 300U);
  EXPECT_EQ(pressed.rgb, overlay3D(scene, options).rgb);
  none.bar->atlas.reset();
  options.shown = Shown3D::PressureAtlas;
  EXPECT_THROW(overlay3D(none, options), BadArgument);
  none.bar.reset();
  options.shown = Shown3D::PressureMre;
  EXPECT_THROW(overlay3D(none, options), BadArgument);
}

TEST(RigidBar, IsDrawnWhereItEndsUnderEitherStiffness) {
  unsetenv("DISPLAY");
  unsetenv("WAYLAND_DISPLAY");
  const RetractionScene scene = withBar();
  SceneOptions3D options{.view = View3D::Inferior, .width = 400, .height = 300, .decorate = false};
  const Picture with = overlay3D(scene, options);
  options.retractor = false;
  const Picture without = overlay3D(scene, options);
  // Bars and ways: 80 mm of steel, the atlas's bar ahead or behind, the ghost at first touch.
  std::size_t differ = 0;
  for (std::size_t i = 0; i < with.rgb.size(); i += 3) differ += with.rgb[i] != without.rgb[i] ? 1 : 0;
  EXPECT_GT(differ, 1500U);
  RetractionScene further = scene;
  further.bar->atlas->travel_mm = 12.0;
  options.retractor = true;
  EXPECT_NE(overlay3D(further, options).rgb, with.rgb);
}

}  // namespace
}  // namespace glisson::render
