// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "base/error.h"
#include "base/parallel.h"
#include "image/io.h"
#include "pipeline/run.h"
#include "pipeline/write_again.h"
#include "support/support.h"

namespace glisson::pipeline {
namespace {

using testing::HasSubstr;
using testing::Not;

/// A scene on the letter F as a mask, with a map of one modulus, springs all round and a push.
std::string letterScene(const std::string& material, const std::string& outputs) {
  return R"({ "schema": "glisson/scene/1", "geometry": { "kind": "mask", "file": "F.nii.gz" }, "material": )" +
         material +
         R"(, "supports": [ { "region": {"surface":"all"}, "kind": "spring", "stiffness_kPa_per_mm": 0.05 } ],
      "loads": [ { "kind": "traction", "region": {"surface":"inferior"}, "kPa": [0.05,-0.02,0.2] } ],
      "compare": { "against": "atlas" }, "outputs": )" +
         outputs + "}";
}

class LetterRun : public testing::Test {
 protected:
  void SetUp() override {
    mask_ = test::letterF();
    image::writeVolume(folder_ / "F.nii.gz", mask_);
    image::ScalarVolume map(mask_.grid, 0.0f);
    for (std::size_t i = 0; i < map.values.size(); ++i) map.values[i] = mask_.values[i] ? 2100.0f : 0.0f;
    image::writeVolume(folder_ / "mu.nrrd", map);
    for (std::size_t i = 0; i < map.values.size(); ++i)
      map.values[i] = mask_.values[i] ? 3000.0f + 50.0f * static_cast<float>(i % 20) : 0.0f;
    image::writeVolume(folder_ / "stiff.nrrd", map);
  }
  Scene scene(const std::string& map, const std::string& outputs = R"(["displacement-field"])") {
    return parseScene(letterScene(R"({"map":")" + map + R"(","quantity":"shear","unit":"Pa"})", outputs),
                      folder_.path());
  }
  test::TemporaryFolder folder_;
  image::Mask mask_;
};

TEST_F(LetterRun, WrittenAgainInOtherColoursIsWhatARunInTheseColoursWrites) {
  const Scene all = scene("stiff.nrrd", R"(["displacement-field","overlay","report"])");
  test::TemporaryFolder red, orange, again;
  const auto outputsIn = [](const std::filesystem::path& folder) {
    std::ifstream in(folder / "run.json");
    const std::string record{std::istreambuf_iterator<char>(in), {}};
    return record.substr(record.find("\"palette\""));
  };
  const RunResult first = run(all, {.output = red.path()});
  run(all, {.output = orange.path(), .palette = render::Palette::ColourBlind});
  std::vector<std::filesystem::path> written;
  writeAgain(first, {red.path(), again.path(), render::Palette::ColourBlind}, written);
  EXPECT_THAT(outputsIn(again.path()), HasSubstr("report.html"));
  EXPECT_EQ(outputsIn(again.path()), outputsIn(orange.path()));  // names and digests
  EXPECT_NE(outputsIn(again.path()), outputsIn(red.path()));
  for (const auto& entry : std::filesystem::directory_iterator(again.path()))
    EXPECT_THAT(written, testing::Contains(entry.path()));
  EXPECT_THROW(writeAgain(first, {red.path(), red.path()}, written), BadInput);
}

TEST_F(LetterRun, MapEqualToTheAtlasGivesExactlyNoDifference) {
  const RunResult r = run(scene("mu.nrrd"), {});
  ASSERT_TRUE(r.difference.has_value());
  EXPECT_EQ(r.difference->max_mm, 0.0);
  EXPECT_EQ(r.difference->mean_mm, 0.0);
  EXPECT_GT(r.primary.max_displacement_mm, 0.01);
  for (const PlanStep& s : r.plan)
    if (s.step == "atlas-solve") {
      EXPECT_FALSE(s.needed) << s.why;
    }
}

TEST_F(LetterRun, StifferLiverMovesLess) {
  const RunResult r = run(scene("stiff.nrrd"), {});
  EXPECT_LT(r.primary.energy_J, r.atlas->energy_J);
  EXPECT_GT(r.difference->max_mm, 0.0);
  EXPECT_TRUE(r.primary.solver.converged());
}

TEST_F(LetterRun, SameBitsWithAnyNumberOfThreads) {
  setThreadCount(1);
  const RunResult one = run(scene("stiff.nrrd"), {});
  for (const int threads : {2, 4}) {
    setThreadCount(threads);
    const RunResult more = run(scene("stiff.nrrd"), {});
    EXPECT_EQ(one.primary.nodal_u_m, more.primary.nodal_u_m) << threads << " threads";
    EXPECT_EQ(one.difference->mean_mm, more.difference->mean_mm);
  }
  setThreadCount(0);
}

TEST_F(LetterRun, LetterKeepsItsShapeAndPlaceThroughTheModel) {
  // Cells of the model are the voxels of the file, at the same place in the patient.
  const RunResult r = run(scene("stiff.nrrd"), {});
  std::size_t cells = 0;
  const image::Grid& g = r.model.youngs_kPa.grid;
  for (int k = 0; k < g.size.z(); ++k)
    for (int j = 0; j < g.size.y(); ++j)
      for (int i = 0; i < g.size.x(); ++i) {
        const Eigen::Vector3d index = mask_.grid.lpsToIndex(g.indexToLps(Eigen::Vector3d(i, j, k)));
        const Eigen::Vector3i at = index.array().round().cast<int>();
        ASSERT_LT((index - at.cast<double>()).norm(), 1e-4);
        ASSERT_EQ(r.model.youngs_kPa.at(i, j, k) > 0, mask_.at(at) != 0) << at.transpose();
        cells += r.model.youngs_kPa.at(i, j, k) > 0 ? 1 : 0;
      }
  EXPECT_EQ(cells, r.model.cells);
  EXPECT_GT(cells, 100u);
}

TEST_F(LetterRun, WhatIsNotAskedForChangesNoBitOfWhatIs) {
  const RunResult lean = run(scene("stiff.nrrd", "[]"), {});
  const test::TemporaryFolder out;
  RunOptions options;
  options.output = out.path();
  const RunResult full = run(scene("stiff.nrrd", R"(["displacement-field","overlay","report"])"), options);
  EXPECT_EQ(lean.primary.nodal_u_m, full.primary.nodal_u_m);
  EXPECT_EQ(lean.difference->p95_mm, full.difference->p95_mm);
  EXPECT_FALSE(lean.picture.has_value());
  EXPECT_TRUE(std::filesystem::exists(out / "run.json"));
  EXPECT_TRUE(std::filesystem::exists(out / "report.html"));
  EXPECT_TRUE(std::filesystem::exists(out / "displacement-mre.nrrd"));
}

TEST_F(LetterRun, RecordHoldsNoPath) {
  const RunResult r = run(scene("stiff.nrrd"), {});
  EXPECT_THAT(r.json, Not(HasSubstr(folder_.path().string())));
  EXPECT_THAT(r.json, HasSubstr("\"sha256\""));
}

TEST_F(LetterRun, VoxelWithoutStiffnessIsNamed) {
  image::ScalarVolume map(mask_.grid, 3000.0f);
  map.at(4, 5, 3) = 0.0f;
  image::writeVolume(folder_ / "hole.nrrd", map);
  try {
    run(scene("hole.nrrd"), {});
    FAIL() << "a voxel without stiffness was accepted";
  } catch (const BadInput& e) {
    EXPECT_THAT(e.what(), HasSubstr("slice 3"));
  }
}

TEST_F(LetterRun, CancelStopsTheRun) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(run(scene("stiff.nrrd"), {}, Progress({}, stop.get_token())), Cancelled);
}

TEST(Run, SceneWithoutSupportOrLoadIsRefused) {
  const Scene s = parseScene(R"({"schema":"glisson/scene/1","geometry":{"kind":"box","size_mm":[10,10,10]},
    "material":{"youngs_kPa":12}})",
                             ".");
  EXPECT_THROW(run(s, {}), BadInput);
}

/// A block under a bar: soft as measured, stiffer in the atlas.
Scene blockUnderABar() {
  return parseScene(R"({ "schema": "glisson/scene/1",
    "geometry": { "kind": "box", "size_mm": [100, 60, 60], "cell_mm": 7.5 },
    "material": { "shear_kPa": 2, "poisson": 0.45 },
    "supports": [ { "region": {"face":"y-"}, "kind": "fixed" } ],
    "loads": [ { "kind": "retractor", "diameter_mm": 12, "length_mm": 40, "at": [50, 60, 30], "axis": [1, 0, 0],
                 "direction": [0, -1, 0], "contact": "rigid", "force": 4 } ],
    "compare": { "against": "atlas", "shear_kPa": 4 }, "outputs": ["overlay"] })",
                    ".");
}

TEST(Significance, IsOpenWhereCellsOrIntervalReachOverTheLine) {
  RunResult r;
  r.difference.emplace();
  const auto with = [&r](double at_mm, double cells_mm, std::optional<uncertainty::Interval> interval) {
    r.difference->at_retractor_mm = at_mm;
    r.difference->clinically_significant = at_mm >= 5.0;
    r.discretisation.emplace().difference.emplace().at_retractor_mm = cells_mm;
    r.uncertainty.reset();
    if (interval) {
      r.uncertainty.emplace().known = true;
      r.uncertainty->spread.headline.emplace().at_retractor_mm = *interval;
    }
    return significanceOf(r);
  };
  EXPECT_EQ(with(4.2, 0.5, {}), Significance::Below);
  EXPECT_EQ(with(4.2, 0.9, {}), Significance::Open);
  EXPECT_EQ(with(6.1, 0.9, {}), Significance::Beyond);
  EXPECT_EQ(with(6.1, 0.9, uncertainty::Interval{4.9, 7.6}), Significance::Open);
  EXPECT_EQ(with(6.1, 0.9, uncertainty::Interval{5.1, 7.0}), Significance::Beyond);
  EXPECT_EQ(with(3.0, 0.1, uncertainty::Interval{1.0, 5.2}), Significance::Open);
  // What cannot be told of the patient says nothing.
  r.uncertainty->known = false;
  EXPECT_EQ(significanceOf(r), Significance::Below);
}

TEST(RigidBar, IsDrawnInContactWithBothBodiesAndPassesThroughNeither) {
  RunOptions options;
  options.discretisation = false;
  const RunResult r = run(blockUnderABar(), options);
  ASSERT_TRUE(r.picture && r.picture->bar && r.picture->bar->atlas);
  const render::RigidBar& bar = *r.picture->bar;
  EXPECT_EQ(bar.asked_N, 4.0);
  EXPECT_EQ(bar.mre.travel_mm, r.primary.contact->travel_mm);
  EXPECT_GT(bar.mre.travel_mm, bar.atlas->travel_mm + 1.0);
  for (const render::BarContact* c : {&bar.mre, &*bar.atlas}) {
    EXPECT_NEAR(c->force_N, 4.0, 0.01);
    EXPECT_GT(c->path.size(), 2U);
    const Eigen::Matrix3Xd at = render::movedSurface(bar, *c, 1.0).vertices_lps_mm;
    const Eigen::Vector3d way = c->travel_mm * r.picture->retractorDirection.normalized();
    const Eigen::Vector3d a = bar.centreline_lps_mm.front() + way, b = bar.centreline_lps_mm.back() + way;
    double nearest = 1e9;
    int pressed = 0;
    for (Eigen::Index n = 0; n < at.cols(); ++n) {
      const double s = std::clamp((at.col(n) - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
      const double gap = (at.col(n) - a - s * (b - a)).norm() - 6.0;
      nearest = std::min(nearest, gap);
      if (!(c->pressure_kPa[n] > 0.0F)) continue;
      ++pressed;
      EXPECT_LT(gap, 4.0) << "pressure where nothing touches";
    }
    EXPECT_GT(nearest, 0.0);
    EXPECT_LT(nearest, 1.0);
    EXPECT_GT(pressed, 10);
  }
}

}  // namespace
}  // namespace glisson::pipeline
