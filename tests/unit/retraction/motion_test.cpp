// SPDX-License-Identifier: GPL-3.0-or-later

// Motions in time: where they end, what they say, condensed and full.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "retraction/simulate.h"

namespace glisson::retraction {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

Model box() {
  image::Grid g;
  g.size = {8, 4, 4};
  g.spacing_mm = Eigen::Vector3d::Constant(5);
  g.origin_lps_mm = Eigen::Vector3d::Constant(2.5);
  return makeModel(image::ScalarVolume(g, 6.0F), 0.45, defaults::liverDensity, false);
}

/// A cantilever that swings under a sudden weight.
retraction::Setup swing(bool condensed) {
  retraction::Setup s;
  SupportSpec clamp;
  clamp.region = FaceRegion{"x-"};
  s.supports = {clamp};
  s.loads = {BodyForce{{0, 0, -3000}}};
  s.analysis.dynamic = true;
  s.analysis.h_ms = 1;
  s.analysis.end_s = 60;
  s.analysis.rayleigh = {1, 0.002};
  s.analysis.stopWhenSteady = 1e-3;
  s.condensed = condensed;
  return s;
}

double tip_mm(const Result& r) {
  return r.nodal_u_m.row(2).minCoeff() * 1e3;
}

TEST(Motion, IsAtRestNeitherAtATurningPointNorInPassing) {
  const Model m = box();
  retraction::Setup still = swing(false);
  still.analysis.dynamic = false;
  const double rest = tip_mm(simulate(m, still, {}));
  for (const double tolerance : {1e-3, 1e-4}) {
    retraction::Setup s = swing(false);
    s.analysis.stopWhenSteady = tolerance;
    const Result full = simulate(m, s, {});
    s.condensed = true;
    const Result condensed = simulate(m, s, {});
    for (const Result* r : {&full, &condensed}) {
      EXPECT_LT(r->steps, 60000);
      EXPECT_NEAR(tip_mm(*r), rest, 20 * tolerance * std::abs(rest));
      EXPECT_THAT(r->notes, Not(Contains(HasSubstr("come to rest"))));
    }
    EXPECT_NEAR(condensed.steps, full.steps, 0.05 * full.steps);
  }
}

TEST(Motion, ThatIsNotAtRestAtItsEndSaysSo) {
  const Model m = box();
  for (const bool condensed : {false, true}) {
    retraction::Setup s = swing(condensed);
    s.analysis.end_s = 0.2;
    EXPECT_THAT(simulate(m, s, {}).notes, Contains(HasSubstr("had not come to rest after 0.2 s")));
    s.analysis.stopWhenSteady = 0;
    EXPECT_THAT(simulate(m, s, {}).notes, Not(Contains(HasSubstr("come to rest"))));
  }
}

TEST(Motion, EndsAtTheTimeAskedForInEverySolver) {
  const Model m = box();
  retraction::Setup s = swing(false);
  s.analysis.stopWhenSteady = 0;
  s.analysis.rayleigh = {0, 0.01};
  for (const auto& [h_ms, end_s, steps] : {std::tuple{30.0, 0.1, 4}, {3.0, 0.1, 34}, {7.0, 0.016, 3}}) {
    s.analysis.h_ms = h_ms;
    s.analysis.end_s = end_s;
    s.condensed = false;
    const Result full = simulate(m, s, {});
    s.condensed = true;
    const Result condensed = simulate(m, s, {});
    EXPECT_EQ(full.steps, steps);
    EXPECT_EQ(condensed.steps, steps);
    EXPECT_NEAR(tip_mm(condensed), tip_mm(full), 0.02 * std::abs(tip_mm(full)));
    for (const Result* r : {&full, &condensed}) EXPECT_THAT(r->notes, Contains(HasSubstr("time step was shortened")));
    s.condensed = false;
    s.analysis.h_ms = 1e3 * end_s / steps;
    const Result even = simulate(m, s, {});
    EXPECT_NEAR(tip_mm(even), tip_mm(full), 1e-6 * std::abs(tip_mm(full)));
    EXPECT_THAT(even.notes, Not(Contains(HasSubstr("shortened"))));
  }
}

TEST(Motion, CondensedReactionsHaveInertiaAndTheErrorIsStated) {
  const Model m = box();
  retraction::Setup s = swing(false);
  s.analysis.stopWhenSteady = 0;
  for (const double end_s : {0.02, 0.05, 0.11}) {
    s.analysis.end_s = end_s;
    s.condensed = false;
    const Result full = simulate(m, s, {});
    s.condensed = true;
    const Result condensed = simulate(m, s, {});
    const double load_N = full.load_N.norm();
    EXPECT_GT((full.reaction_N + full.load_N).norm(), 0.02 * load_N) << "nothing moves here";
    EXPECT_LT((full.reaction_N - condensed.reaction_N).norm(), 0.02 * load_N);
    EXPECT_TRUE(condensed.solver.converged());
    EXPECT_GT(condensed.solver.residual, 0.0);
    const double missed_mm = 1e3 * (full.nodal_u_m - condensed.nodal_u_m).colwise().norm().maxCoeff();
    double said_mm = -1;
    for (const std::string& note : condensed.notes)
      if (const auto at = note.find("misses about "); at != std::string::npos)
        said_mm = std::stod(note.substr(at + 13));
    EXPECT_LE(missed_mm, 3 * said_mm + 1e-6);
    EXPECT_LE(said_mm, 0.2 * full.max_displacement_mm);
  }
}

TEST(Retractors, ThatNoInstrumentIsAreRefused) {
  const Model m = box();
  retraction::Setup s = swing(false);
  s.analysis.dynamic = false;
  Retractor bar;
  bar.at_mm = Eigen::Vector3d(30, 20, 10);
  bar.length_mm = 15;
  bar.force_N = 0.1;
  const auto said = [&](const Retractor& r) -> std::string {
    s.loads = {r};
    try {
      simulate(m, s, {});
    } catch (const BadInput& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(said(bar), "");
  Retractor bad = bar;
  bad.force_N = -10;
  EXPECT_THAT(said(bad), HasSubstr("\"direction\""));
  bad = bar;
  bad.force_N = 1e4;
  EXPECT_THAT(said(bad), HasSubstr("\"force\" is 10000"));
  bad = bar;
  bad.length_mm = 500;
  EXPECT_THAT(said(bad), HasSubstr("\"length_mm\" is 500"));
  bad = bar;
  bad.diameter_mm = 0.1;
  EXPECT_THAT(said(bad), HasSubstr("\"diameter_mm\" is 0.1"));
  bad = bar;
  bad.spread_mm = 1000;
  EXPECT_THAT(said(bad), HasSubstr("\"spread_mm\" is 1000"));
}

}  // namespace
}  // namespace glisson::retraction
