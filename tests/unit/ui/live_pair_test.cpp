// SPDX-License-Identifier: GPL-3.0-or-later

// A retraction that follows the tool against the full solve of the same scene.
#include "session/live_pair.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "pipeline/models.h"
#include "support/support.h"

namespace glisson::session {
namespace {

/// A block on springs below, hoisted by a bar at one corner: soft as measured, stiffer in the atlas.
std::filesystem::path sceneFile(const test::TemporaryFolder& folder, const std::string& compare,
                                const std::string& contact = "patch") {
  const auto file = folder / "scene.json";
  std::ofstream(file) << R"({ "schema": "glisson/scene/1",
    "geometry": { "kind": "box", "size_mm": [120, 80, 60], "cell_mm": 10 },
    "material": { "youngs_kPa": 4, "poisson": 0.45 },
    "supports": [ { "region": {"surface":"posterior"}, "kind": "spring", "stiffness_kPa_per_mm": 0.1 } ],
    "loads": [ { "kind": "retractor", "diameter_mm": 20, "length_mm": 60, "at": [30, 80, 30], "force": 3, "contact": ")" +
                             contact + R"(", "direction": [0, -1, 0] } ],)" + compare + R"(
    "kinematics": ")" + (contact == "rigid" ? "hyperelastic" : "linear") +
                             R"(", "model": { "kind": "fem-hex" } })";
  return file;
}

constexpr const char* compare = R"("compare": { "against": "atlas", "shear_kPa": 2.4 },)";

render::RetractionScene pictureOf() {
  render::RetractionScene picture;
  picture.liverSurface.vertices_lps_mm.resize(3, 3);
  // Two points of the block, and one a little outside of it.
  picture.liverSurface.vertices_lps_mm << 30, 61, 30, 60, 17, 82, 20, 33, 30;
  picture.vesselSurface.vertices_lps_mm.resize(3, 1);
  picture.vesselSurface.vertices_lps_mm << 55, 45, 25;
  return picture;
}

TEST(LivePair, GivesTheSolvesAnswerUnderTheScenesForceAndIsLinearInTheTool) {
  const test::TemporaryFolder folder;
  const auto file = sceneFile(folder, compare);
  const std::vector<Eigen::Vector3d> landmarks = {{35, 35, 15}, {72, 52, 41}};
  LivePair pair(file, {}, pictureOf(), landmarks);
  ASSERT_EQ(pair.kind(), retraction::LiveKind::Condensed);
  ASSERT_EQ(pair.liverVertices(), 3);
  ASSERT_EQ(pair.vesselVertices(), 1);
  LiveFrame frame;
  pair.follow({Eigen::Vector3d::Zero(), pair.sceneForce_N()}, LiveComparison::EqualForce, frame);
  ASSERT_EQ(frame.mre_mm.cols(), 6);
  EXPECT_NEAR(frame.force_N.norm(), 3.0, 1e-9);

  const pipeline::Models models = pipeline::buildModels(pipeline::readScene(file), false);
  const auto setup = pipeline::readScene(file).setup;
  const std::vector<Eigen::Vector3d> watched = {{30, 60, 20}, {61, 17, 33}, {55, 45, 25}, landmarks[0], landmarks[1]};
  const int column[] = {0, 1, 3, 4, 5};
  const auto mre = retraction::simulate(models.model, setup, watched);
  const auto atlas = retraction::simulate(*models.atlas, setup, watched);
  double mean = 0.0;
  for (std::size_t n = 0; n < watched.size(); ++n) {
    EXPECT_LT((frame.mre_mm.col(column[n]) - mre.probe_u_mm[n]).norm(), 1e-4 * mre.max_displacement_mm);
    EXPECT_LT((frame.atlas_mm.col(column[n]) - atlas.probe_u_mm[n]).norm(), 1e-4 * mre.max_displacement_mm);
    if (n >= 3) mean += 0.5 * (mre.probe_u_mm[n] - atlas.probe_u_mm[n]).norm();
  }
  EXPECT_NEAR(frame.vesselMean_mm, mean, 2e-4 * mre.max_displacement_mm);
  EXPECT_GT(frame.atTool_mm, 0.0);
  EXPECT_GT(frame.toolMre_mm.norm(), frame.toolAtlas_mm.norm());
  // What lies outside by less than two cells moves with the surface beside it.
  EXPECT_GT(frame.mre_mm.col(2).norm(), 0.5 * frame.mre_mm.col(0).norm());

  // The contact goes where the hand is, and twice as far with twice the force: nothing else loads this block.
  LiveFrame there, twice;
  const Eigen::Vector3d hand(4.0, -9.0, 2.5);
  pair.follow({hand, {}}, LiveComparison::EqualForce, there);
  pair.follow({2.0 * hand, {}}, LiveComparison::EqualForce, twice);
  EXPECT_LT((there.toolMre_mm - hand).norm(), 1e-9);
  EXPECT_LT((twice.force_N - 2.0 * there.force_N).norm(), 1e-9 * twice.force_N.norm());
  EXPECT_LT((twice.atlas_mm - 2.0 * there.atlas_mm).norm(), 1e-9 * twice.atlas_mm.norm());
  EXPECT_NEAR(twice.atTool_mm, 2.0 * there.atTool_mm, 1e-9);
}

/// Frames until both livers are at rest.
LiveFrame settled(LivePair& pair, const retraction::LiveTarget& hand, LiveComparison comparison) {
  LiveFrame frame;
  for (int n = 0; n < 300; ++n) {
    pair.follow(hand, comparison, frame);
    if (frame.atRest) return frame;
  }
  ADD_FAILURE() << "not at rest after 300 frames";
  return frame;
}

TEST(LivePair, FollowsARigidBarToTheRunsAnswerAtEqualForce) {
  const test::TemporaryFolder folder;
  const auto file = sceneFile(folder, compare, "rigid");
  LivePair pair(file, {}, pictureOf(), {{35, 35, 15}, {72, 52, 41}});
  ASSERT_EQ(pair.kind(), retraction::LiveKind::Contact);
  const LiveFrame run = settled(pair, {Eigen::Vector3d::Zero(), pair.sceneForce_N()}, LiveComparison::EqualForce);
  EXPECT_NEAR(run.force_N.y(), -3.0, 0.01);
  EXPECT_NEAR(run.forceAtlas_N.y(), -3.0, 0.01);

  const pipeline::Models models = pipeline::buildModels(pipeline::readScene(file), false);
  const auto setup = pipeline::readScene(file).setup;
  const auto mre = retraction::simulate(models.model, setup, {{61, 17, 33}, {35, 35, 15}});
  const auto atlas = retraction::simulate(*models.atlas, setup, {{61, 17, 33}, {35, 35, 15}});
  ASSERT_TRUE(mre.contact && atlas.contact);
  EXPECT_NEAR(run.toolMre_mm.norm(), mre.contact->travel_mm, 0.02 * mre.contact->travel_mm);
  EXPECT_NEAR(run.toolAtlas_mm.norm(), atlas.contact->travel_mm, 0.02 * atlas.contact->travel_mm);
  EXPECT_LT((run.mre_mm.col(1) - mre.probe_u_mm[0]).norm(), 0.02 * mre.max_displacement_mm);
  EXPECT_LT((run.atlas_mm.col(4) - atlas.probe_u_mm[1]).norm(), 0.02 * atlas.max_displacement_mm);

  // Where the hand has it: at equal force the stiffer liver is lifted less, at equal travel it takes more force.
  const retraction::LiveTarget hand{{0, -6, 0}, {}};
  const LiveFrame force = settled(pair, hand, LiveComparison::EqualForce);
  EXPECT_NEAR(force.toolMre_mm.y(), -6, 1e-3);
  EXPECT_NEAR(force.forceAtlas_N.norm(), force.force_N.norm(), 5e-3 * force.force_N.norm());
  EXPECT_LT(force.toolAtlas_mm.norm(), 0.95 * force.toolMre_mm.norm());
  const LiveFrame travel = settled(pair, hand, LiveComparison::EqualTravel);
  EXPECT_NEAR(travel.toolAtlas_mm.y(), -6, 1e-3);
  EXPECT_NEAR(travel.atTool_mm, 0, 2e-3);
  EXPECT_GT(travel.forceAtlas_N.norm(), 1.05 * travel.force_N.norm());
}

TEST(LivePair, CountsTheLandmarksBeyondTheSignificantDistance) {
  const test::TemporaryFolder folder;
  LivePair pair(sceneFile(folder, compare), {}, pictureOf(), {{35, 75, 28}, {110, 10, 5}});
  LiveFrame frame;
  pair.follow({Eigen::Vector3d(0, -1, 0), {}}, LiveComparison::EqualForce, frame);
  const Eigen::Vector2d apart((frame.mre_mm - frame.atlas_mm).col(4).norm(),
                              (frame.mre_mm - frame.atlas_mm).col(5).norm());
  ASSERT_GT(apart[0], apart[1]);
  // The distances are proportional to the tool's: once just below 5 mm, once just above.
  pair.follow({Eigen::Vector3d(0, -4.99 / apart[0], 0), {}}, LiveComparison::EqualForce, frame);
  EXPECT_EQ(frame.vesselsBeyond, 0);
  pair.follow({Eigen::Vector3d(0, -5.01 / apart[0], 0), {}}, LiveComparison::EqualForce, frame);
  EXPECT_EQ(frame.vesselsBeyond, 1);
  EXPECT_NEAR(frame.vesselMax_mm, 5.01, 1e-9);
}

TEST(LivePair, RefusesASceneWithoutAComparison) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(LivePair(sceneFile(folder, ""), {}, pictureOf(), {}), BadInput);
}

}  // namespace
}  // namespace glisson::session
