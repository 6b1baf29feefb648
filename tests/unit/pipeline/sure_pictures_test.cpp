// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/random.h"
#include "pipeline/detail/outputs.h"
#include "pipeline/pictures.h"
#include "pipeline/plan.h"
#include "support/support.h"
#include "uncertainty/surgeon.h"

namespace glisson::pipeline {
namespace {

using uncertainty::SourceKind;

SureNumbers numbers() {
  SureNumbers n;
  n.at_retractor_mm = 4.0;
  n.vessels = true;
  n.headline.emplace();
  n.headline->at_retractor_mm = {1.5, 9.25};
  n.headline->beyond = 0.37;
  n.headline->vessels = {{1, 2}, {6, 12}, {0, 0.5}, 3, 8.0, {6, 11}, 0.97};
  n.sources = {{SourceKind::Outline, 0.5, 0.1, 0.2, 3.0, 0.25},
               {SourceKind::BarPlace, 6.0, 0.1, 0.2, 1.0, 0.75},
               {SourceKind::Supports, 1.0, 0.1, 0.2, 2.0, 1.25}};
  return n;
}

TEST(SurePictures, BarsAreTheSourcesNumbersTheLargestFirst) {
  const SureNumbers n = numbers();
  const render::Tornado t = retractorTornado(n, Language::English).value();
  ASSERT_EQ(t.bars.size(), 4u);
  EXPECT_EQ(t.here, 4.0);
  std::vector<double> sd;
  for (const auto& s : n.sources) sd.push_back(s.sd_mm);
  std::sort(sd.rbegin(), sd.rend());
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_DOUBLE_EQ(t.bars[i].high - t.here, sd[i]);
    EXPECT_DOUBLE_EQ(t.bars[i].low, std::max(0.0, t.here - sd[i]));  // a length has no negative half
    EXPECT_FALSE(t.bars[i].sum);
  }
  EXPECT_EQ(t.bars[0].label, uncertainty::labelOf(SourceKind::BarPlace, Language::English));
  EXPECT_EQ(t.bars[0].note, "± 6 mm");
  EXPECT_TRUE(t.bars[3].sum);
  EXPECT_EQ(t.bars[3].low, 1.5);
  EXPECT_EQ(t.bars[3].high, 9.25);
  ASSERT_EQ(t.lines.size(), 1u);
  EXPECT_EQ(t.lines[0].value, 5.0);
  EXPECT_THAT(t.caption, testing::HasSubstr("37 %"));
}

TEST(SurePictures, TheVesselsChartIsAboutTheOneFurthestApart) {
  SureNumbers n = numbers();
  const render::Tornado t = vesselTornado(n, Language::German).value();
  EXPECT_EQ(t.here, 8.0);
  EXPECT_DOUBLE_EQ(t.bars[0].high - t.here, 1.25);
  EXPECT_EQ(t.bars[0].label, uncertainty::labelOf(SourceKind::Supports, Language::German));
  EXPECT_EQ(t.bars[3].note, "6 bis 11 mm");
  // One answer: how far the vessels may be off.
  n.headline.reset();
  EXPECT_FALSE(retractorTornado(n, Language::English));
  const render::Tornado alone = vesselTornado(n, Language::English).value();
  EXPECT_EQ(alone.here, 0.0);
  EXPECT_DOUBLE_EQ(alone.bars[0].high, 3.0);
  EXPECT_EQ(alone.bars.size(), 3u);
  n.vessels = false;
  EXPECT_FALSE(vesselTornado(n, Language::English));
}

/// Solid angle of a closed surface from a point over 4 π: 1 inside, 0 outside.
double winding(const anatomy::TriangleMesh& mesh, const Eigen::Vector3d& p) {
  double sum = 0;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    const Eigen::Vector3d a = mesh.vertices_lps_mm.col(mesh.triangles(0, t)) - p,
                          b = mesh.vertices_lps_mm.col(mesh.triangles(1, t)) - p,
                          c = mesh.vertices_lps_mm.col(mesh.triangles(2, t)) - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (4 * std::numbers::pi);
}

/// The places of a short vessel in a block that is pulled, with a spread that is not the same in all directions.
TEST(SurePictures, TheTubeHoldsEachPlaceOfAVesselWith95Percent) {
  const Scene scene = parseScene(R"({ "schema": "glisson/scene/1",
    "geometry": { "kind": "box", "size_mm": [100, 60, 60], "cell_mm": 10 },
    "material": { "shear_kPa": 2, "poisson": 0.45 }, "supports": [ { "region": {"face":"y-"}, "kind": "fixed" } ],
    "loads": [ { "kind": "traction", "region": {"face":"y+"}, "kPa": [0, 0.3, 0] } ] })",
                                 ".");
  RunResult r = run(scene, {});
  anatomy::VesselModel vessels;
  Eigen::Matrix3d covariance;
  covariance << 9, 3, 0, 3, 4, 0, 0, 0, 0.25;
  r.uncertainty.emplace().known = true;
  for (int i = 0; i < 5; ++i) {
    vessels.centreline_lps_mm.emplace_back(30 + 2 * i, 30, 30);
    vessels.radius_mm.push_back(0.1);  // below the cells of the tube: what is left is the spread
    uncertainty::LandmarkSpread& s = r.uncertainty->spread.landmarks.emplace_back();
    s.landmark = static_cast<std::size_t>(i);
    s.place_mm2 = covariance;
  }
  vessels.surface.vertices_lps_mm = Eigen::Vector3d(30, 30, 31);
  const render::HowSure sure = detail::howSureOf(r, vessels).value();
  EXPECT_NEAR(static_cast<double>(sure.vessel95_mm[0]), uncertainty::radius95_mm(covariance), 1e-5);
  ASSERT_GT(sure.tube.triangles.cols(), 100);
  const auto u = retraction::displacementAt(r.model, r.primary, vessels.centreline_lps_mm);
  ASSERT_GT(u[0].norm(), 1.0);
  const Eigen::Matrix3d root = covariance.llt().matrixL();
  Random random(5);
  constexpr int count = 400;
  int inside = 0, far = 0;
  for (int n = 0; n < count; ++n) {
    const Eigen::Vector3d z(random.normal(), random.normal(), random.normal());
    const Eigen::Vector3d end = vessels.centreline_lps_mm[0] + u[0];
    inside += winding(sure.tube, end + root * z) > 0.5;
    far += winding(sure.tube, end + 4 * root * z.normalized() - Eigen::Vector3d(6, 0, 0)) > 0.5;
  }
  // The tube goes on along the vessel, so a little more than 95 %.
  EXPECT_GT(inside, 0.94 * count);
  EXPECT_LT(inside, count);
  EXPECT_LT(far, 0.7 * count);
}

std::string step(const std::string& scene, const char* name, bool& needed) {
  for (const PlanStep& s : plan(parseScene(scene, ".")))
    if (s.step == name) {
      needed = s.needed;
      return s.why;
    }
  return "no such step";
}

TEST(SurePictures, ThePlanSaysWhyTheyAreLeftOut) {
  const auto scene = [](const std::string& more) {
    return R"({ "schema": "glisson/scene/1", "geometry": { "kind": "box", "size_mm": [100, 60, 60], "cell_mm": 10 },
      "material": { "shear_kPa": 2, "poisson": 0.45 }, "supports": [ { "region": {"face":"y-"}, "kind": "fixed" } ],
      "loads": [ { "kind": "retractor", "diameter_mm": 12, "length_mm": 40, "at": [50, 60, 30], "axis": [1, 0, 0],
                   "direction": [0, -1, 0], "contact": "rigid", "force": 4 } ])" +
           more + " }";
  };
  bool needed = true;
  EXPECT_THAT(step(scene(R"(, "outputs": ["report"])"), "uncertainty-pictures", needed),
              testing::HasSubstr("does not say how sure"));
  EXPECT_FALSE(needed);
  EXPECT_THAT(step(scene(R"(, "uncertainty": true)"), "uncertainty-pictures", needed),
              testing::HasSubstr("no picture"));
  EXPECT_FALSE(needed);
  step(scene(R"(, "uncertainty": true, "outputs": ["overlay"])"), "uncertainty-pictures", needed);
  EXPECT_TRUE(needed);
}

}  // namespace
}  // namespace glisson::pipeline
