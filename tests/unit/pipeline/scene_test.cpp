// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "pipeline/plan.h"
#include "pipeline/scene.h"

namespace glisson::pipeline {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const char* beam = R"({ "schema": "glisson/scene/1", // a comment
  "geometry": { "kind": "box", "size_mm": [50,10,10], "cell_mm": 1.6667 },
  "material": { "youngs_kPa": 12, "poisson": 0.45 },
  "supports": [ { "region": {"face":"x-"}, "kind": "fixed" } ],
  "loads": [ { "kind": "body_force", "N_per_m3": [0,0,-40] } ],
  "outputs": [ { "probe": [[50,5,5]] } ]
})";

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  const auto at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), with);
}

std::string messageOf(const std::string& text) {
  try {
    parseScene(text, ".");
  } catch (const BadInput& e) {
    return e.what();
  }
  return "accepted";
}

TEST(Scene, SmallestSceneAndDefaults) {
  const Scene s = parseScene(beam, ".");
  EXPECT_EQ(s.geometry.kind, GeometrySpec::Kind::Box);
  EXPECT_DOUBLE_EQ(s.setup.poisson, 0.45);
  EXPECT_DOUBLE_EQ(s.setup.density.kgPerM3(), 1060.0);
  EXPECT_EQ(s.setup.model.kind, retraction::ModelKind::FemHex);
  EXPECT_FALSE(s.setup.analysis.dynamic);
  EXPECT_FALSE(s.compare.has_value());
  ASSERT_EQ(s.outputs.probes_mm.size(), 1u);
}

TEST(Scene, ComplaintsNameKeyAndLine) {
  EXPECT_THAT(messageOf(replaced(beam, "\"poisson\"", "\"poison\"")), AllOf(HasSubstr("line 3"), HasSubstr("poison")));
  EXPECT_THAT(messageOf(replaced(beam, "\"x-\"", "\"w-\"")), AllOf(HasSubstr("line 4"), HasSubstr("w-")));
  EXPECT_THAT(messageOf(replaced(beam, "0.45", "0.5")), AllOf(HasSubstr("line 3"), HasSubstr("poisson")));
  EXPECT_THAT(messageOf(replaced(beam, "12", "-12")), HasSubstr("youngs_kPa"));
  EXPECT_THAT(messageOf(replaced(beam, "12", "\"12\"")), HasSubstr("number"));
  EXPECT_THAT(messageOf(replaced(beam, "[50,5,5]", "[50,5]")), HasSubstr("line 6"));
  EXPECT_THAT(messageOf(replaced(beam, "scene/1", "scene/7")), HasSubstr("glisson/scene/1"));
  EXPECT_THAT(messageOf(replaced(beam, "\"fixed\" }", "\"fixed\", \"kind\": \"fixed\" }")), HasSubstr("twice"));
  EXPECT_THAT(messageOf(replaced(beam, "} ]\n}", "} ]")), AllOf(HasSubstr("not JSON"), HasSubstr("line")));
  EXPECT_THAT(messageOf("[]"), HasSubstr("object"));
  EXPECT_THAT(messageOf(""), HasSubstr("not JSON"));
}

TEST(Scene, MissingFilesAreNamed) {
  const std::string mask = replaced(beam, R"("kind": "box", "size_mm": [50,10,10], "cell_mm": 1.6667)",
                                    R"("kind": "mask", "file": "nowhere.nii.gz", "label": 5)");
  EXPECT_THAT(messageOf(mask), AllOf(HasSubstr("file"), HasSubstr("does not exist")));
  EXPECT_THAT(messageOf(replaced(beam, R"({ "youngs_kPa": 12, "poisson": 0.45 })", "\"mre\"")), HasSubstr("mre"));
}

TEST(Scene, JsonOfASceneGivesTheSameScene) {
  std::string text =
      replaced(beam, "\"outputs\"", R"("analysis": {"kind":"dynamic","h_ms":0.5,"end_s":0.25,"rayleigh":[0.1,0.002]},
    "model": {"kind":"meshfree","frames":50,"kernel":"voronoi","order":1},
    "solver": {"kind":"cg","iterations":200,"tolerance":1e-6,"preconditioner":"none"},
    "compare": {"against":"atlas"}, "seed": 7, "outputs")");
  const std::string once = toJson(parseScene(text, "."));
  EXPECT_EQ(once, toJson(parseScene(once, ".")));
  EXPECT_THAT(once, HasSubstr("\"iterations\": 200"));
  EXPECT_THAT(once, HasSubstr("voronoi"));
}

TEST(Scene, AToleranceThatIsNamedIsAskedForEvenWhereItIsTheUsualOneAndStaysSoInWriting) {
  const std::string moving =
      replaced(beam, "\"outputs\"", R"("analysis": {"kind":"dynamic","h_ms":1,"end_s":0.01}, "outputs")");
  const Scene own = parseScene(moving, ".");
  EXPECT_FALSE(own.setup.solver.keepsTolerance());
  EXPECT_FALSE(parseScene(toJson(own), ".").setup.solver.keepsTolerance());
  for (const char* tolerance : {"1e-8", "1e-5"}) {
    const Scene asked =
        parseScene(replaced(moving, "\"outputs\"",
                            std::string(R"("solver": {"kind": "auto", "tolerance": )") + tolerance + R"(}, "outputs")"),
                   ".");
    EXPECT_TRUE(asked.setup.solver.keepsTolerance()) << tolerance;
    const Scene again = parseScene(toJson(asked), ".");
    EXPECT_TRUE(again.setup.solver.keepsTolerance()) << tolerance;
    EXPECT_DOUBLE_EQ(again.setup.solver.tolerance, std::stod(tolerance));
  }
}

TEST(Scene, ACapsuleIsADefaultWhereABarIsAndElseOnlyWhereItIsAskedFor) {
  const std::string bar = R"({ "schema": "glisson/scene/1",
  "geometry": { "kind": "box", "size_mm": [50,50,50], "cell_mm": 10 },
  "material": { "youngs_kPa": 12 },
  "supports": [ { "region": {"face":"y-"}, "kind": "fixed" } ],
  "capsule": true,
  "loads": [ { "kind": "retractor", "at": [25,50,25], "force": 1, "contact": "patch" } ] })";
  const Scene asked = parseScene(bar, ".");
  EXPECT_TRUE(asked.capsuleAsked);
  EXPECT_TRUE(asked.setup.capsule.has_value());
  const Scene again = parseScene(toJson(asked), ".");
  EXPECT_TRUE(again.capsuleAsked && again.setup.capsule.has_value());
  const Scene plain = parseScene(replaced(bar, "\"capsule\": true,", ""), ".");
  EXPECT_FALSE(plain.setup.capsule.has_value());
  EXPECT_FALSE(parseScene(toJson(plain), ".").capsuleAsked);
}

TEST(Scene, LigamentsAndOneSidedSpringsAreReadAndWritten) {
  const std::string held = replaced(beam, "\"fixed\" }", R"("fixed" },
    { "region": {"face":"z+"}, "kind": "ligament", "name": "left-triangular", "slack_mm": 2, "towards": [0,0,2] },
    { "region": {"face":"z-"}, "kind": "spring", "stiffness_kPa_per_mm": 0.1, "unilateral": true, "tangential": 0.2 })");
  const Scene s = parseScene(toJson(parseScene(held, ".")), ".");
  ASSERT_EQ(s.setup.supports.size(), 3u);
  const retraction::LigamentSpec& l = s.setup.supports[1].ligament;
  EXPECT_EQ(l.name, retraction::LigamentName::LeftTriangular);
  EXPECT_FALSE(l.stiffness_N_per_mm.has_value());
  EXPECT_DOUBLE_EQ(l.length_mm, retraction::LigamentSpec::otherLength_mm);
  EXPECT_DOUBLE_EQ(l.slack_mm, 2.0);
  EXPECT_EQ(l.towards.value(), Eigen::Vector3d(0, 0, 1));
  EXPECT_DOUBLE_EQ(s.setup.supports[2].tangential, 0.2);
  EXPECT_THAT(messageOf(replaced(held, "\"unilateral\": true, ", "")), HasSubstr("tangential"));
  EXPECT_THAT(messageOf(replaced(held, "left-triangular", "middle")), HasSubstr("falciform"));
  EXPECT_THAT(messageOf(replaced(held, "\"slack_mm\": 2", "\"slack_mm\": -2")), HasSubstr("slack_mm"));
}

TEST(Plan, LeavesOutWhatTheSceneDoesNotNeed) {
  const std::vector<PlanStep> steps = plan(parseScene(beam, "."));
  for (const PlanStep& s : steps) {
    EXPECT_FALSE(s.why.empty()) << s.step;
    if (s.step == "mass-matrix" || s.step == "time-steps" || s.step == "vessels" || s.step == "3d-overlay" ||
        s.step == "atlas-solve" || s.step == "assembled-stiffness-matrix" || s.step == "ligaments" ||
        s.step == "loads-that-follow") {
      EXPECT_FALSE(s.needed) << s.step;
    }
    if (s.step == "solve" || s.step == "mesh") {
      EXPECT_TRUE(s.needed) << s.step;
    }
  }
}

}  // namespace
}  // namespace glisson::pipeline
