// SPDX-License-Identifier: GPL-3.0-or-later

// Every model kind through a whole run: what the plan says beforehand, what the record says afterwards.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "pipeline/run.h"

namespace glisson::pipeline {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

Scene bar(const std::string& model, const std::string& more = "") {
  return parseScene(R"({ "schema": "glisson/scene/1",
    "geometry": { "kind": "box", "size_mm": [40,16,16], "cell_mm": 4 },
    "material": { "youngs_kPa": 12, "poisson": 0.3 },
    "supports": [ { "region": {"face":"x-"}, "kind": "fixed" } ],
    "loads": [ { "kind": "traction", "region": {"face":"x+"}, "kPa": [0, 0, -0.01] } ],
    "outputs": [ { "probe": [[40, 8, 8]] } ],
    "model": )" + model +
                        more + "}",
                    ".");
}

std::string whyOf(const std::vector<PlanStep>& plan, const std::string& step) {
  const auto at = std::find_if(plan.begin(), plan.end(), [&](const PlanStep& s) { return s.step == step; });
  return at == plan.end() ? "no such step" : at->why;
}

TEST(Models, EveryKindTellsItsDiscretisationError) {
  const double truth = run(bar(R"({"kind":"fem-hex"})"), {}).primary.probe_u_mm[0].z();
  ASSERT_LT(truth, -0.01);
  for (const char* model :
       {R"({"kind":"fem-hex","element":"H8"})", R"({"kind":"fem-hex","element":"H8-Bbar"})", R"({"kind":"fem-hex"})",
        R"({"kind":"fem-tet","element":"T4"})", R"({"kind":"fem-tet","element":"T10"})",
        R"({"kind":"meshfree","kernel":"voronoi","frames":8,"order":1})",
        R"({"kind":"meshfree","kernel":"wendland","frames":4,"order":2})",
        R"({"kind":"meshfree","kernel":"mls","frames":24,"order":1})",
        R"({"kind":"meshfree","kernel":"mls","frames":30,"order":2})"}) {
    const RunResult r = run(bar(model), {});
    ASSERT_TRUE(r.discretisation) << model;
    EXPECT_TRUE(r.discretisation->known) << model << ": " << r.discretisation->note;
    EXPECT_GT(r.discretisation->max_mm, 0.0) << model;
    EXPECT_THAT(r.json, HasSubstr("\"discretisation_error\"")) << model;
    // The estimate reaches as far as this model is from the default one at the tip.
    EXPECT_GE(1.5 * r.discretisation->max_mm, std::abs(r.primary.probe_u_mm[0].z() - truth)) << model;
    EXPECT_TRUE(r.primary.solver.converged()) << model;
  }
  const RunResult turned = run(bar(R"({"kind":"fem-hex"})", R"(, "kinematics": "corotational")"), {});
  ASSERT_TRUE(turned.discretisation);
  EXPECT_TRUE(turned.discretisation->known) << turned.discretisation->note;
}

TEST(Models, FramesThatTheVoxelsHaveNoRoomForAreSaidEverywhere) {
  // 11 × 5 × 5 nodes: room for 10 affine frames of 27 nodes.
  const Scene s = bar(R"({"kind":"meshfree","kernel":"wendland","frames":500,"order":1})");
  EXPECT_THAT(whyOf(plan(s), "mesh-free-frames"), testing::AllOf(HasSubstr("at most 10 of the 500"), HasSubstr("27")));
  EXPECT_THAT(whyOf(plan(s), "mesh"), HasSubstr("120 degrees of freedom"));
  const RunResult r = run(s, {});
  EXPECT_GT(r.primary.frames, 0);
  EXPECT_LE(r.primary.frames, 10);
  EXPECT_THAT(whyOf(r.plan, "mesh-free-frames"), testing::AllOf(HasSubstr("500"), HasSubstr("27")));
  EXPECT_THAT(r.primary.validity, Contains(HasSubstr("instead of 500")));
  EXPECT_THAT(r.json, HasSubstr("\"frames_asked\": 500"));
  EXPECT_THAT(r.json, HasSubstr("\"frames\": " + std::to_string(r.primary.frames)));
}

TEST(Models, FramesThatFitRaiseNoWarning) {
  const Scene s = bar(R"({"kind":"meshfree","kernel":"wendland","frames":5,"order":1})");
  EXPECT_THAT(whyOf(plan(s), "mesh-free-frames"), HasSubstr("5 frames, Wendland"));
  const RunResult r = run(s, {});
  EXPECT_EQ(r.primary.frames, 5);
  EXPECT_THAT(r.primary.validity, IsEmpty());
}

TEST(Models, MovingLeastSquaresGoesThereAndBack) {
  const Scene s = bar(R"({"kind":"meshfree","kernel":"mls","frames":20,"order":2})");
  EXPECT_EQ(s.setup.model.meshfree.kernel, mechanics::Kernel::Mls);
  EXPECT_EQ(toJson(s), toJson(parseScene(toJson(s), ".")));
  EXPECT_THAT(whyOf(plan(s), "mesh"), HasSubstr(" 60 degrees of freedom"));
  const RunResult r = run(s, {});
  EXPECT_EQ(r.primary.dofs, 3 * r.primary.frames);
  EXPECT_GE(r.primary.frames, 15);
}

}  // namespace
}  // namespace glisson::pipeline
