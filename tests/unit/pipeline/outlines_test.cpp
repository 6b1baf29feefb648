// SPDX-License-Identifier: GPL-3.0-or-later

// A reader outlines the liver on some slices only: what lies between is interpolated by shape, once, for the body and
// for the elastogram alike, and the record says so.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "image/io.h"
#include "image/morphology.h"
#include "pipeline/inputs.h"
#include "pipeline/sources.h"
#include "roi/contour_io.h"
#include "support/support.h"

namespace glisson::pipeline {
namespace {

using testing::HasSubstr;

constexpr double radius_mm = 40.0;

image::Grid mriGrid() {
  image::Grid g;
  g.size = {80, 80, 21};
  g.spacing_mm = {1.5, 1.5, 4.0};
  g.origin_lps_mm = {-60, -60, -40};
  return g;
}

/// A ball, outlined on every step-th slice from 1 to 19.
roi::ContourStack ball(int step) {
  const image::Grid g = mriGrid();
  roi::ContourStack contours;
  for (int k = 1; k < 20; k += step) {
    const double z_mm = g.origin_lps_mm.z() + k * g.spacing_mm.z();
    const double r_mm = std::sqrt(radius_mm * radius_mm - z_mm * z_mm);
    roi::Polygon p;
    p.points_lps_mm.resize(3, 120);
    for (int v = 0; v < 120; ++v) {
      const double a = v * std::numbers::pi / 60;
      p.points_lps_mm.col(v) = Eigen::Vector3d(r_mm * std::cos(a), r_mm * std::sin(a), z_mm);
    }
    contours.polygons.push_back(p);
  }
  return contours;
}

class SparseOutlines : public testing::Test {
 protected:
  Inputs load(const roi::ContourStack& contours) {
    image::writeVolume(folder_ / "mri.nrrd", image::ScalarVolume(mriGrid(), 100.0F));
    roi::writeContours(folder_ / "roi.json", contours);
    return loadInputs(parseScene(R"({ "schema": "glisson/scene/1",
      "geometry": { "kind": "patient", "mri": "mri.nrrd", "roi": "roi.json" }, "material": "atlas",
      "supports": [ { "region": {"surface":"all"}, "kind": "spring", "stiffness_kPa_per_mm": 0.05 } ],
      "loads": [ { "kind": "pressure", "region": {"surface":"inferior"}, "kPa": 0.1 } ] })",
                                 folder_.path()));
  }
  test::TemporaryFolder folder_;
};

TEST_F(SparseOutlines, EveryThirdSliceGivesTheBallAndSaysSo) {
  const Inputs all = load(ball(1)), some = load(ball(3));
  EXPECT_THAT(all.warnings, testing::Not(testing::Contains(HasSubstr("interpolated"))));
  EXPECT_THAT(some.warnings,
              testing::Contains("outlines on 7 of 19 slices; 12 slices between them were interpolated by shape"));
  const double whole = static_cast<double>(image::count(*all.liver)),
               filled = static_cast<double>(image::count(*some.liver));
  // Chords of a ball lie inside it: linear radii lose volume, here r'' h²/12 on average, well below a tenth.
  EXPECT_LT(filled, whole);
  EXPECT_GT(filled, 0.9 * whole);
}

TEST_F(SparseOutlines, InterpolatedBeforeOrNowIsTheSame) {
  LoadedRoi roi;
  roi.contours = ball(3);
  const auto said = completeOutlines(roi, mriGrid());
  ASSERT_TRUE(said.has_value());
  const Inputs before = load(*roi.contours), now = load(ball(3));
  EXPECT_EQ(before.liver->values, now.liver->values);
  EXPECT_THAT(before.warnings, testing::Contains(*said));
}

TEST_F(SparseOutlines, ElastogramSliceOnAnUndrawnSliceGetsTheInterpolatedRegion) {
  LoadedRoi roi;
  roi.contours = ball(9);  // slices 1, 10, 19
  image::Grid g = mriGrid();
  g.origin_lps_mm = g.indexToLps({0, 0, 5});  // where no outline was drawn
  g.size.z() = 1;
  const auto map = elastography::makeStiffnessMap(image::ScalarVolume(g, 2.0F), StiffnessQuantity::Shear, "kPa");
  const elastography::MappedRoi mapped = mapRoi(roi, mriGrid(), map);
  EXPECT_THAT(mapped.warnings, testing::Contains(HasSubstr("outlines on 3 of 19 slices")));
  const auto drawn = load(ball(9));
  std::size_t onSlice = 0;
  for (int j = 0; j < 80; ++j)
    for (int i = 0; i < 80; ++i) onSlice += drawn.liver->at(i, j, 5);
  EXPECT_EQ(image::count(mapped.mask), onSlice);
  EXPECT_GT(onSlice, 1000u);
}

TEST_F(SparseOutlines, OutlinesThatDoNotOverlapLeaveAGapThatIsNamed) {
  roi::ContourStack contours = ball(18);  // slices 1 and 19
  contours.polygons[0].points_lps_mm.row(0).array() -= 40.0;
  contours.polygons[1].points_lps_mm.row(0).array() += 40.0;
  EXPECT_THAT(load(contours).warnings, testing::Contains(HasSubstr("stay empty")));
}

}  // namespace
}  // namespace glisson::pipeline
