// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/arrows.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "scene_fixture.h"

namespace glisson::render {
namespace {

/// A ball on an oblique grid that both answers move as a whole.
RetractionScene ball() {
  image::Grid grid;
  grid.size = {48, 48, 24};
  grid.spacing_mm = {2.0, 2.0, 4.0};
  grid.direction =
      (Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()) * Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ())).matrix();
  grid.origin_lps_mm = {-20.0, 30.0, -10.0};
  const Eigen::Vector3d centre = grid.indexToLps({23.5, 23.5, 11.5});
  return test::sceneFrom(grid, {.inLiver = [centre](const Eigen::Vector3d& p) { return (p - centre).norm() < 38.0; },
                                .brightness = [](const Eigen::Vector3d&) { return 100.0F; },
                                .u_mre_mm = [](const Eigen::Vector3d&) { return Eigen::Vector3d(3.0, -7.0, 2.0); },
                                .u_atlas_mm = [](const Eigen::Vector3d&) { return Eigen::Vector3d(1.0, -4.0, 0.5); }});
}

TEST(DisplacementArrows, AreTheDisplacementsWellInsideTheLiver) {
  const RetractionScene scene = ball();
  const auto arrows = displacementArrows(scene, 8.0, 2000);
  ASSERT_GT(arrows.size(), 100U);
  const Eigen::Vector3d centre = scene.mri.grid.indexToLps({23.5, 23.5, 11.5});
  int inside = 0;
  for (const DisplacementArrow& a : arrows) {
    if ((a.rest - centre).norm() > 30.0) continue;
    ++inside;
    EXPECT_LT((a.mre - a.rest - Eigen::Vector3d(3.0, -7.0, 2.0)).norm(), 1e-5);
    EXPECT_LT((a.atlas - a.rest - Eigen::Vector3d(1.0, -4.0, 0.5)).norm(), 1e-5);
  }
  EXPECT_GT(inside, 50);
}

TEST(DisplacementArrows, StandFurtherApartWhereThereWouldBeTooMany) {
  const RetractionScene scene = ball();
  const auto many = displacementArrows(scene, 4.0, 100000), few = displacementArrows(scene, 4.0, 60);
  EXPECT_GT(many.size(), 60U);
  EXPECT_LE(few.size(), 60U);
  EXPECT_GT(few.size(), 15U);
}

TEST(DisplacementArrows, OfASliceLieInItsPlane) {
  const RetractionScene scene = ball();
  const auto arrows = displacementArrows(scene, 8.0, mostArrows, 11);
  ASSERT_GT(arrows.size(), 20U);
  for (const DisplacementArrow& a : arrows)
    for (const Eigen::Vector3d& p : {a.rest, a.mre, a.atlas}) EXPECT_NEAR(scene.mri.grid.lpsToIndex(p).z(), 11.0, 1e-6);
}

TEST(DisplacementArrows, ColourASliceByAnswerAndNeedASpacing) {
  RetractionScene scene = ball();
  SliceOverlayOptions o;
  o.slice = 11;
  o.decorate = o.outlines = false;
  const Picture bare = sliceOverlay(scene, o);
  o.arrows = true;
  const Picture with = sliceOverlay(scene, o);
  ASSERT_EQ(bare.rgb.size(), with.rgb.size());
  int differs = 0;
  for (std::size_t n = 0; n < bare.rgb.size(); n += 3)
    if (bare.rgb[n] != with.rgb[n] || bare.rgb[n + 2] != with.rgb[n + 2]) ++differs;
  EXPECT_GT(differs, 300);
  EXPECT_THROW(displacementArrows(scene, 0.0, 10), BadArgument);
  EXPECT_THROW(displacementArrows(scene, 5.0, 0), BadArgument);
}

}  // namespace
}  // namespace glisson::render
