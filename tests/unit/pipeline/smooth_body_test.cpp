// SPDX-License-Identifier: GPL-3.0-or-later

// The smooth body behind a mask, and the place of the bar on it, whatever the cells.
#include <gtest/gtest.h>

#include "image/io.h"
#include "pipeline/models.h"
#include "pipeline/scene.h"
#include "retraction/pose.h"
#include "support/support.h"

namespace glisson::pipeline {
namespace {

/// A right lobe 160 mm high with a smaller left lobe above and before it, in voxels of 2 x 2 x 2.5 mm.
image::Mask liver() {
  image::Grid g;
  g.spacing_mm = {2.0, 2.0, 2.5};
  g.size = {100, 64, 76};
  g.origin_lps_mm = {-130.0, -64.0, -95.0};
  image::Mask m(g);
  auto within = [](const Eigen::Vector3d& p, const Eigen::Vector3d& centre, const Eigen::Vector3d& radii) {
    return (p - centre).cwiseQuotient(radii).norm() <= 1.0;
  };
  for (int k = 0; k < g.size.z(); ++k)
    for (int j = 0; j < g.size.y(); ++j)
      for (int i = 0; i < g.size.x(); ++i) {
        const Eigen::Vector3d p = g.indexToLps(Eigen::Vector3d(i, j, k));
        m.at(i, j, k) = within(p, {-65, 0, 0}, {58, 54, 80}) || within(p, {-5, -15, 40}, {65, 30, 32}) ? 1 : 0;
      }
  return m;
}

Scene sceneWith(const test::TemporaryFolder& folder, const std::string& cell, const std::string& loads) {
  return parseScene(R"({ "schema": "glisson/scene/1",
    "geometry": { "kind": "mask", "file": "liver.nrrd")" +
                        cell + R"( },
    "material": { "youngs_kPa": 6 },
    "supports": [ { "region": {"surface":"posterior"}, "kind": "spring", "stiffness_kPa_per_mm": 0.1 } ],
    "loads": [)" + loads +
                        R"(], "compare": { "against": "atlas" } })",
                    folder.path());
}

TEST(SmoothBodyOfAScene, PlaceOfTheBarDoesNotDependOnTheCells) {
  const test::TemporaryFolder folder;
  image::writeVolume(folder / "liver.nrrd", liver());
  std::vector<retraction::Pose> poses;
  for (const char* cell : {R"(, "cell_mm": 6.56)", R"(, "cell_mm": 3.28)", R"(, "cell_mm": 1.64)", ""}) {
    const Models m = buildModels(sceneWith(folder, cell, R"({ "kind": "retractor" })"), false);
    ASSERT_TRUE(m.model.smooth) << cell;
    EXPECT_EQ(m.model.smooth, m.atlas.value().smooth);
    poses.push_back(
        retraction::poseCandidates(*m.model.smooth, m.model.smooth->surface(), retraction::Retractor{}).front());
    EXPECT_EQ(poses.back().centre_mm, poses.front().centre_mm) << cell;
    EXPECT_EQ(poses.back().axis, poses.front().axis) << cell;
  }
}

TEST(SmoothBodyOfAScene, IsThereOnlyForARetractorOnAMask) {
  const test::TemporaryFolder folder;
  image::writeVolume(folder / "liver.nrrd", liver());
  const Scene pushed = sceneWith(folder, "", R"({ "kind": "body_force", "N_per_m3": [0, 0, -10] })");
  EXPECT_FALSE(buildModels(pushed, false).model.smooth);
  const Scene box = parseScene(R"({ "schema": "glisson/scene/1",
    "geometry": { "kind": "box", "size_mm": [120, 80, 120], "cell_mm": 10 }, "material": { "youngs_kPa": 6 },
    "supports": [ { "region": {"face":"y-"}, "kind": "fixed" } ],
    "loads": [ { "kind": "retractor", "at": [60, 80, 60], "force": 1 } ] })",
                               ".");
  EXPECT_FALSE(buildModels(box, false).model.smooth);
}

TEST(RetractorAxis, IsKeptApartFromNoneGiven) {
  const test::TemporaryFolder folder;
  image::writeVolume(folder / "liver.nrrd", liver());
  auto axisOf = [&](const std::string& load) {
    return std::get<retraction::Retractor>(sceneWith(folder, "", load).setup.loads.front()).axis;
  };
  EXPECT_FALSE(axisOf(R"({ "kind": "retractor" })"));
  EXPECT_EQ(axisOf(R"({ "kind": "retractor", "axis": [2, 0, 0] })").value(), Eigen::Vector3d(1, 0, 0));
}

}  // namespace
}  // namespace glisson::pipeline
