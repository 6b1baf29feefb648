// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/tradeoff.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "base/error.h"
#include "pipeline/run.h"
#include "retraction/discretisation.h"
#include "study/detail/tradeoff_variants.h"

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
  ASSERT_GE(s.rows.size(), 25u);
  EXPECT_GT(s.largest_mm, 0.1);
  EXPECT_EQ(s.points, 24u * 6u * 6u);
  std::map<std::string, double> error;
  std::set<std::string> methods, seen;
  bool front = false;
  for (const Row& r : s.rows) {
    EXPECT_GT(r.dofs, 0);
    EXPECT_GT(r.total_s(), 0.0);
    EXPECT_TRUE(std::isfinite(r.max_error_mm)) << r.method;
    EXPECT_LE(r.mean_error_mm, r.max_error_mm);
    front = front || r.pareto;
    methods.insert(r.method);
    error[r.method + ", " + r.resolution] = r.max_error_mm;
    EXPECT_TRUE(seen.insert(r.method + ", " + r.resolution).second) << r.method << ", " << r.resolution << " twice";
    if (r.method == "Corotational") {
      EXPECT_EQ(r.reference, linearTheory);
      EXPECT_FALSE(r.pareto);
      EXPECT_LT(r.max_error_mm, 0.05 * s.largest_mm);  // the bar hardly turns
    } else {
      EXPECT_EQ(r.reference, s.reference);
    }
  }
  EXPECT_TRUE(front);
  for (const char* name : {"H8-incompatible", "H8-Bbar", "H8", "T4", "T10", "H8-incompatible, CG",
                           "H8-incompatible, CG stopped", "Condensed", "Corotational", "Voronoi, CG 200 (published)",
                           "Wendland affine", "Wendland quadratic", "MLS linear", "MLS quadratic"})
    EXPECT_TRUE(methods.count(name)) << name;
  const double fine = error.at("H8-incompatible, 864 cells of 2 mm"),
               rough = error.at("H8-incompatible, 108 cells of 4 mm");
  EXPECT_GT(fine, 0.0);
  EXPECT_GT(rough, 1.5 * fine);
  EXPECT_LT(rough, 0.1 * s.largest_mm);
  EXPECT_GT(error.at("T4, 864 cells of 2 mm"), error.at("T10, 864 cells of 2 mm"));
  // Condensation is exact: the error is that of the cells. So is a tight iterative solve; a loose one is worse.
  EXPECT_NEAR(error.at("Condensed, 864 cells of 2 mm, every node"), fine, 1e-6 * s.largest_mm);
  EXPECT_NEAR(error.at("H8-incompatible, CG, 864 cells of 2 mm, tolerance 1e-06"), fine, 1e-3 * s.largest_mm);
  EXPECT_GT(error.at("H8-incompatible, CG stopped, 864 cells of 2 mm, 25 iterations at most"), 3.0 * fine);
}

TEST(Tradeoff, FramesThatTheVoxelsHaveNoRoomForAppearOnce) {
  std::vector<std::string> leftOut;
  const std::vector<Variant> all = tradeoffVariants(false, 864, 25 * 7 * 7, 1, leftOut);
  std::set<std::string> names;
  for (const Variant& v : all)
    if (v.kind == Variant::Kind::Frames) {
      EXPECT_TRUE(names.insert(v.method + std::to_string(v.meshfree.frames)).second) << v.method;
      EXPECT_LE(v.meshfree.frames * mechanics::leastNodesOf(v.meshfree.kernel, v.meshfree.order), 25 * 7 * 7);
    }
  EXPECT_FALSE(leftOut.empty());
}

TEST(Tradeoff, EndsWithItsBudgetAndWhenAsked) {
  TradeoffOptions none;
  none.budget_s = 0.0;
  const TradeoffStudy s = studyTradeoff(bar("4"), none);
  EXPECT_TRUE(s.rows.empty());
  EXPECT_NE(s.skipped.back().find("budget"), std::string::npos);
  std::stop_source stop;
  const Progress progress(
      [&](double done, const std::string&) {
        if (done > 0.4) stop.request_stop();
      },
      stop.get_token());
  EXPECT_THROW(studyTradeoff(bar("4"), {}, progress), Cancelled);
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

TEST(Discretisation, BodyThatCannotBeMergedIsSplit) {
  pipeline::Scene s = bar("12");
  s.setup.supports[0].region = retraction::BoxRegion{{-1, -1, -1}, {1, 13, 13}};
  const pipeline::RunResult r = pipeline::run(s, {});
  // One cell thick: no coarse cell would be half full, so cells of half the edge are taken.
  const retraction::DiscretisationError e = discretisationError(r.model, s.setup, r.primary);
  EXPECT_TRUE(e.known) << e.note;
  EXPECT_EQ(e.coarse_mm, 0.5 * e.cell_mm);
  EXPECT_GT(e.max_mm, 0.0);
  // Frames are told from the voxels under them, and these from cells of half the edge.
  s.setup.model.kind = retraction::ModelKind::Meshfree;
  const retraction::DiscretisationError f = discretisationError(r.model, s.setup, r.primary);
  EXPECT_TRUE(f.known) << f.note;
  EXPECT_GE(f.max_mm, e.max_mm);
}

}  // namespace
}  // namespace glisson::study
