// SPDX-License-Identifier: GPL-3.0-or-later

// What is said of a run: both answers, each reason once, what to do about it and what the window does itself.
#include "session/trust.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace glisson::session {
namespace {

/// A run whose answers both converged, on cells of 4 mm.
struct JudgedRun {
  JudgedRun() {
    image::Grid grid;
    grid.size = {4, 4, 4};
    grid.spacing_mm.setConstant(4.0);
    r.model.youngs_kPa = image::ScalarVolume(grid, 6.0F);
    r.primary.solver.status = mechanics::SolveStatus::Converged;
    r.primary.kinematics = retraction::Kinematics::Hyperelastic;
    r.atlas = r.primary;
    r.difference.emplace();
  }
  std::vector<Doubt> doubts() const { return doubtsAbout(r); }
  std::size_t count(const char* part) const {
    const auto all = doubts();
    return static_cast<std::size_t>(std::count_if(
        all.begin(), all.end(), [part](const Doubt& d) { return d.text.contains(QString::fromUtf8(part)); }));
  }
  pipeline::RunResult r;
};

TEST(Trust, WithoutADoubtNothingIsSaid) {
  EXPECT_TRUE(JudgedRun().doubts().empty());
}

TEST(Trust, TheAtlasIsJudgedAsTheMeasuredAnswerIs) {
  JudgedRun run;
  run.r.atlas->doubt(DiagnosticCode::CellsInsideOut, {{"cells", std::int64_t{1}}});
  const auto doubts = run.doubts();
  ASSERT_EQ(doubts.size(), 1u);
  EXPECT_EQ(doubts[0].severity, Severity::Error);
  EXPECT_TRUE(doubts[0].text.startsWith("Atlas:")) << doubts[0].text.toStdString();
  EXPECT_FALSE(doubts[0].text.contains("converge"));
  EXPECT_FALSE(doubts[0].advice.isEmpty());
  EXPECT_EQ(doubts[0].remedy, Remedy::SmallerCells);
}

TEST(Trust, AReasonOfBothIsSaidOnce) {
  JudgedRun run;
  for (retraction::Result* answer : {&run.r.primary, &*run.r.atlas})
    answer->doubt(DiagnosticCode::CellsInsideOut, {{"cells", std::int64_t{2}}});
  ASSERT_EQ(run.doubts().size(), 1u);
  EXPECT_TRUE(run.doubts()[0].text.startsWith("MRE and atlas:"));
  // Another number is another fact.
  run.r.atlas->doubts = {};
  run.r.atlas->doubt(DiagnosticCode::CellsInsideOut, {{"cells", std::int64_t{7}}});
  EXPECT_EQ(run.doubts().size(), 2u);
}

TEST(Trust, WhatRunAndAnswerBothSayIsSaidOnceWithItsStiffness) {
  JudgedRun run;
  const std::vector<std::pair<std::string, DiagnosticValue>> slip = {{"capacity_N", 5.0},
                                                                     {"capacity_travel_mm", 20.0},
                                                                     {"travel_mm", 21.0},
                                                                     {"stiffness", std::string("atlas")},
                                                                     {"asked_N", 15.0},
                                                                     {"asked_mm", 0.0},
                                                                     {"asked", std::string("15 N")}};
  run.r.atlas->doubt(DiagnosticCode::RetractorSlips, slip);
  run.r.diagnostics.add(DiagnosticCode::RetractorSlips, slip);
  run.r.diagnostics.add(DiagnosticCode::DifferenceWithheld,
                        {{"stiffness", std::string("atlas")}, {"reason", std::string("slips")}});
  run.r.difference.reset();
  EXPECT_EQ(run.count("slips at"), 1u);
  EXPECT_EQ(run.count("atlas stiffness"), 2u);
  EXPECT_TRUE(isNoAnswer(run.r));
}

TEST(Trust, WarningsOfTheAtlasAreNotRepeatedAsTexts) {
  JudgedRun run;
  run.r.atlas->doubt(DiagnosticCode::StrainLocallyLarge, {{"percent", 2.0}});
  run.r.warnings = {"atlas: " + run.r.atlas->doubts.texts().front(), "something without a code"};
  EXPECT_EQ(run.count("strains by more than"), 1u);
  EXPECT_EQ(run.count("something without a code"), 1u);
}

TEST(Trust, ErrorsComeFirst) {
  JudgedRun run;
  run.r.primary.doubt(DiagnosticCode::StrainLocallyLarge, {{"percent", 2.0}});
  run.r.atlas->doubt(DiagnosticCode::CellsInsideOut, {{"cells", std::int64_t{1}}});
  const auto doubts = run.doubts();
  ASSERT_EQ(doubts.size(), 2u);
  EXPECT_EQ(doubts[0].severity, Severity::Error);
  EXPECT_EQ(doubts[1].severity, Severity::Note);
}

TEST(Remedies, HalveTheCellsDownToWhatTheModelPageOffers) {
  JudgedRun run;
  const auto halved = remedied(Remedy::SmallerCells, Parameters{}, run.r);
  ASSERT_TRUE(halved);
  EXPECT_DOUBLE_EQ(halved->cell_mm, 2.0);
  run.r.model.youngs_kPa.grid.spacing_mm.setConstant(1.5);
  EXPECT_FALSE(remedied(Remedy::SmallerCells, Parameters{}, run.r));
}

TEST(Remedies, LargeDeformationTakesAModelThatOffersIt) {
  JudgedRun run;
  EXPECT_FALSE(remedied(Remedy::LargeDeformation, Parameters{}, run.r)) << "the run was in large deformation";
  run.r.primary.kinematics = retraction::Kinematics::Linear;
  Parameters meshfree;
  meshfree.method = Method::Voronoi;
  meshfree.dynamic = true;
  const auto large = remedied(Remedy::LargeDeformation, meshfree, run.r);
  ASSERT_TRUE(large);
  EXPECT_EQ(large->kinematics, retraction::Kinematics::Hyperelastic);
  EXPECT_TRUE(isHex(large->method) && !large->dynamic);
}

TEST(Remedies, AForceThatBothLiversBear) {
  JudgedRun run;
  EXPECT_FALSE(remedied(Remedy::BorneForce, Parameters{}, run.r)) << "nothing slipped";
  for (auto [answer, capacity_N] : {std::pair(&run.r.primary, 8.0), std::pair(&*run.r.atlas, 5.0)}) {
    answer->contact.emplace();
    answer->contact->outcome = mechanics::ContactOutcome::Slips;
    answer->contact->capacity_N = capacity_N;
  }
  const auto less = remedied(Remedy::BorneForce, Parameters{}, run.r);
  ASSERT_TRUE(less);
  EXPECT_EQ(less->drive, Drive::Force);
  EXPECT_NEAR(less->force_N, 4.5, 1e-12);
}

}  // namespace
}  // namespace glisson::session
