#include "study/tradeoff.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "pipeline/run.h"
#include "retraction/discretisation.h"

namespace glisson::study {
namespace {

pipeline::Scene bar(const std::string& cell_mm, const std::string& extra = "") {
  return pipeline::parseScene(R"({ "schema": "glisson/scene/1",
    "geometry": { "kind": "box", "size_mm": [48,12,12], "cell_mm": )" +
                                  cell_mm + R"( },
    "material": { "youngs_kPa": 12, "poisson": 0.3 },
    "supports": [ { "region": {"face":"x-"}, "kind": "fixed" } ],
    "loads": [ { "kind": "body_force", "N_per_m3": [0,0,-100] } ])" +
                                  extra + "}",
                              ".");
}

TEST(Tradeoff, ErrorsFallTowardsTheReferenceAndRowsAreComplete) {
  TradeoffOptions quick;
  quick.quick = true;
  const TradeoffStudy s = studyTradeoff(bar("2"), quick);
  ASSERT_GE(s.rows.size(), 15u);
  EXPECT_GT(s.largest_mm, 0.1);
  EXPECT_EQ(s.points, 24u * 6u * 6u);
  double ofCells[2] = {0, 0}, tight = 0;
  bool front = false;
  for (const Row& r : s.rows) {
    EXPECT_GT(r.dofs, 0);
    EXPECT_GT(r.total_s(), 0.0);
    EXPECT_EQ(r.reference, s.reference);
    EXPECT_TRUE(std::isfinite(r.max_error_mm)) << r.method;
    EXPECT_LE(r.mean_error_mm, r.max_error_mm);
    front = front || r.pareto;
    if (r.method == "H8-incompatible" && r.resolution.find("of 2 mm") != std::string::npos) ofCells[0] = r.max_error_mm;
    if (r.method == "H8-incompatible" && r.resolution.find("of 4 mm") != std::string::npos) ofCells[1] = r.max_error_mm;
    if (r.resolution.find("tolerance 1e-05") != std::string::npos) tight = r.max_error_mm;
  }
  EXPECT_TRUE(front);
  EXPECT_GT(ofCells[0], 0.0);
  EXPECT_GT(ofCells[1], 1.5 * ofCells[0]);
  // A tighter solve of the same cells moves the answer by less than its tolerance: the error is the cells'.
  EXPECT_NEAR(tight, ofCells[0], 1e-3 * s.largest_mm);
  EXPECT_GT(tight, 0.0);
  EXPECT_LT(ofCells[1], 0.1 * s.largest_mm);
}

TEST(Discretisation, SplittingAndMergingKeepTheBody) {
  const retraction::Model m = pipeline::run(bar("4"), {}).model;
  const retraction::Model fine = refined(m), back = coarsened(fine);
  EXPECT_EQ(fine.cells, 8 * m.cells);
  EXPECT_NEAR(fine.volume_mL, m.volume_mL, 1e-12);
  ASSERT_TRUE(back.youngs_kPa.grid.sameGeometry(m.youngs_kPa.grid, 1e-9));
  EXPECT_EQ(back.youngs_kPa.values, m.youngs_kPa.values);
}

TEST(Discretisation, EstimateCoversTheTrueError) {
  // The truth: the same bar in cells of a quarter of the size.
  const pipeline::RunResult coarse = pipeline::run(bar("2"), {});
  const pipeline::RunResult fine = pipeline::run(bar("0.5"), {});
  const retraction::DiscretisationError e = discretisationError(coarse.model, bar("2").setup, coarse.primary);
  ASSERT_TRUE(e.known) << e.note;
  EXPECT_EQ(e.cell_mm, 2.0);
  EXPECT_EQ(e.coarse_mm, 4.0);
  double worst = 0.0;
  const std::vector<Eigen::Vector3d> tip = {{47.9, 6, 6}, {24, 6, 6}};
  const auto a = retraction::displacementAt(coarse.model, coarse.primary, tip);
  const auto b = retraction::displacementAt(fine.model, fine.primary, tip);
  for (std::size_t i = 0; i < tip.size(); ++i) worst = std::max(worst, (a[i] - b[i]).norm());
  EXPECT_GT(worst, 0.0);
  EXPECT_GE(e.max_mm, worst);
  EXPECT_LE(e.max_mm, 10.0 * worst);
  EXPECT_LE(e.mean_mm, e.p95_mm);
  EXPECT_LE(e.p95_mm, e.max_mm);
}

TEST(Discretisation, FieldsThatBothGridsHoldExactlyHaveNone) {
  // Uniform tension, Poisson 0: linear displacement.
  pipeline::Scene s = bar("2");
  s.setup.poisson = 0.0;
  s.setup.loads = {retraction::Traction{retraction::FaceRegion{"x+"}, {0.01, 0, 0}}};
  s.setup.solver.tolerance = 1e-12;
  const pipeline::RunResult r = pipeline::run(s, {});
  const retraction::DiscretisationError e = discretisationError(r.model, s.setup, r.primary);
  ASSERT_TRUE(e.known) << e.note;
  EXPECT_LE(e.max_mm, 1e-7 * r.primary.max_displacement_mm);
}

TEST(Discretisation, FramesAreHeldAgainstTheirOwnVoxelsToo) {
  const pipeline::Scene s = bar("2", R"(, "model": {"kind":"meshfree","frames":10,"kernel":"voronoi","order":1})");
  const pipeline::RunResult frames = pipeline::run(s, {}), voxels = pipeline::run(bar("2"), {});
  const retraction::DiscretisationError a = discretisationError(frames.model, s.setup, frames.primary);
  const retraction::DiscretisationError b = discretisationError(voxels.model, bar("2").setup, voxels.primary);
  ASSERT_TRUE(a.known && b.known) << a.note << b.note;
  EXPECT_GT(a.max_mm, 2.0 * b.max_mm);
}

TEST(Discretisation, BodyThatCannotBeHalvedIsSaidSo) {
  pipeline::Scene s = bar("12");
  s.setup.supports[0].region = retraction::BoxRegion{{-1, -1, -1}, {1, 13, 13}};
  const pipeline::RunResult r = pipeline::run(s, {});
  // One cell thick: no coarse cell would be half full.
  const retraction::DiscretisationError e = discretisationError(r.model, s.setup, r.primary);
  EXPECT_FALSE(e.known);
  EXPECT_NE(e.note.find("unknown"), std::string::npos);
}

}  // namespace
}  // namespace glisson::study
