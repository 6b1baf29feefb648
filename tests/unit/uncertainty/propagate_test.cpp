// SPDX-License-Identifier: GPL-3.0-or-later
#include "uncertainty/propagate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/diagnostic.h"
#include "base/error.h"
#include "base/parallel.h"

namespace glisson::uncertainty {
namespace {

/// A block of 100 × 60 × 80 mm on its back, pushed by a bar; modulus grows along L.
retraction::Model block(double youngs_kPa, double slope = 0.0) {
  image::Grid g;
  g.size = {20, 12, 16};
  g.spacing_mm = {5, 5, 5};
  image::ScalarVolume E(g, 0.0f);
  for (int k = 0; k < g.size.z(); ++k)
    for (int j = 0; j < g.size.y(); ++j)
      for (int i = 0; i < g.size.x(); ++i)
        E.at(i, j, k) = static_cast<float>(youngs_kPa * (1 + slope * (i - 9.5) / 10));
  return retraction::makeModel(std::move(E), 0.45, defaults::liverDensity, false);
}

retraction::Setup setupOf(double force_N, retraction::Kinematics kinematics) {
  retraction::Setup s;
  s.supports.emplace_back().region = retraction::FaceRegion{"y-"};
  retraction::SupportSpec& spring = s.supports.emplace_back();
  spring.kind = retraction::SupportSpec::Kind::Spring;
  spring.region = retraction::FaceRegion{"x-"};
  spring.stiffness_kPa_per_mm = 0.1;
  retraction::Retractor bar;
  bar.length_mm = 50;
  bar.at_mm = Eigen::Vector3d(48, 58, 38);
  bar.axis = Eigen::Vector3d(1, 0, 0.2);
  bar.force_N = force_N;
  bar.contact = retraction::ContactKind::Rigid;
  s.loads.emplace_back(bar);
  s.kinematics = kinematics;
  return s;
}

/// Two retractions of the block and what is asked of them.
struct Scene {
  retraction::Model measured = block(9.0, 0.3), textbook = block(6.09);
  retraction::Setup setup;
  retraction::Result result, other;
  std::vector<Eigen::Vector3d> landmarks_mm = {{48, 50, 38}, {30, 40, 30}, {48, 20, 60}, {500, 0, 0}};
  Options options;

  explicit Scene(retraction::Kinematics kinematics = retraction::Kinematics::Hyperelastic, double force_N = 2.0)
      : setup(setupOf(force_N, kinematics)),
        result(retraction::simulate(measured, setup, {})),
        other(retraction::simulate(textbook, setup, {})) {
    options.fields = 8;
    options.checks = 1;
  }
  Case patient() const {
    Elastogram e;
    e.noise = 0.1;
    e.origin = image::Mask(measured.youngs_kPa.grid, 1);
    return {{measured, result, true}, Retracted{textbook, other, true}, setup, landmarks_mm, e, {}};
  }
};

const SourceSpread& sourceOf(const Uncertainty& u, SourceKind kind) {
  for (const SourceSpread& s : u.spread.sources)
    if (s.kind == kind) return s;
  throw std::runtime_error("no such source");
}

class Propagated : public testing::TestWithParam<retraction::Kinematics> {};

TEST_P(Propagated, RepeatabilityIsWhatARunWithAStifferElastogramShows) {
  const Scene scene(GetParam());
  ASSERT_TRUE(scene.result.solver.converged() && scene.other.solver.converged());
  const Uncertainty u = propagate(scene.patient(), scene.options, 3);
  ASSERT_TRUE(u.known) << u.why;
  const double by = scene.options.spreads.repeatability;
  const auto at = [&](double factor) {
    retraction::Model stiffer = scene.measured;
    for (float& v : stiffer.youngs_kPa.values) v *= static_cast<float>(factor);
    return retraction::simulate(stiffer, scene.setup, {});
  };
  const retraction::Result up = at(std::exp(by)), down = at(std::exp(-by));
  const auto rms = [&](const retraction::Result& a, const retraction::Result& b) {
    const auto ua = retraction::displacementAt(scene.measured, a, scene.landmarks_mm);
    const auto ub = retraction::displacementAt(scene.measured, b, scene.landmarks_mm);
    double sum = 0;
    for (int i = 0; i < 3; ++i)
      sum += (ua[static_cast<std::size_t>(i)] - ub[static_cast<std::size_t>(i)]).squaredNorm();
    return std::sqrt(sum / 3);
  };
  const SourceSpread& s = sourceOf(u, SourceKind::ElastogramRepeatability);
  EXPECT_NEAR(s.vessels_sd_mm, 0.5 * rms(up, down), 0.03 * s.vessels_sd_mm);
  const double travel = 0.5 * (down.contact->travel_mm - up.contact->travel_mm);
  EXPECT_NEAR(s.travel_sd_mm, travel, 0.03 * travel);
  // A landmark outside the body has none.
  ASSERT_EQ(u.spread.landmarks.size(), 3u);
  for (const LandmarkSpread& l : u.spread.landmarks) {
    EXPECT_GE(l.sd_mm, 0.0);
    EXPECT_GE(l.difference95_mm->high, l.difference95_mm->low);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinematics, Propagated,
                         testing::Values(retraction::Kinematics::Hyperelastic, retraction::Kinematics::Linear));

TEST(Propagate, IntervalsHoldTheFiguresAndWhatTheFirstOrderMissesIsTold) {
  const Scene scene;
  const Uncertainty u = propagate(scene.patient(), scene.options, 3);
  ASSERT_TRUE(u.known) << u.why;
  const Headline& h = *u.spread.headline;
  const double apart = scene.result.contact->travel_mm - scene.other.contact->travel_mm;
  EXPECT_LT(h.travel_mm.low, apart);
  EXPECT_GT(h.travel_mm.high, apart);
  ASSERT_EQ(u.checks.size(), 1u);
  ASSERT_TRUE(u.checks[0].found);
  EXPECT_GT(u.checks[0].change_mm, 0.1);
  // A bar that moves by 5 mm along itself leaves the first order: its end lies elsewhere on the block.
  const bool told = std::any_of(u.diagnostics.begin(), u.diagnostics.end(),
                                [](const Diagnostic& d) { return d.code == DiagnosticCode::UncertaintyNotLinear; });
  EXPECT_EQ(told, u.checks[0].missed_mm > 0.3 * u.checks[0].change_mm);
  // The clamped block was not measured by an outline.
  EXPECT_THROW(sourceOf(u, SourceKind::Outline), std::runtime_error);
  // A force is no part of the weight here.
  EXPECT_THROW(sourceOf(u, SourceKind::Density), std::runtime_error);
  EXPECT_LT(sourceOf(u, SourceKind::Solver).sd_mm, 0.01);
  EXPECT_GT(sourceOf(u, SourceKind::ElastogramNoise).vessels_sd_mm, 0.0);
  EXPECT_NE(inWords(u.spread).find("95 % probability"), std::string::npos);
}

TEST(Propagate, ATextbookStiffnessIsExactAndAnUnmeasuredOneToo) {
  const Scene scene;
  Case patient = scene.patient();
  patient.elastogram.reset();
  const Uncertainty u = propagate(patient, scene.options, 3);
  ASSERT_TRUE(u.known);
  EXPECT_THROW(sourceOf(u, SourceKind::ElastogramNoise), std::runtime_error);
  EXPECT_THROW(sourceOf(u, SourceKind::ElastogramRepeatability), std::runtime_error);
  EXPECT_EQ(u.fields, 0);
  Case alone{patient.measured, {}, scene.setup, scene.landmarks_mm, scene.patient().elastogram, {}};
  const Uncertainty one = propagate(alone, scene.options, 3);
  ASSERT_TRUE(one.known);
  EXPECT_FALSE(one.spread.headline);
  EXPECT_FALSE(one.spread.landmarks[0].beyond);
  EXPECT_GT(one.spread.landmarks[0].sd_mm, u.spread.landmarks[0].sd_mm);
}

TEST(Propagate, GivesTheSameBitsWithAnyNumberOfThreadsAndStopsWhenTold) {
  const Scene scene;
  setThreadCount(1);
  const Uncertainty one = propagate(scene.patient(), scene.options, 3);
  setThreadCount(3);
  const Uncertainty three = propagate(scene.patient(), scene.options, 3);
  setThreadCount(0);
  ASSERT_TRUE(one.known && three.known);
  EXPECT_EQ(one.spread.headline->at_retractor_mm.low, three.spread.headline->at_retractor_mm.low);
  EXPECT_EQ(one.spread.landmarks[1].sd_mm, three.spread.landmarks[1].sd_mm);
  EXPECT_EQ(one.checks[0].missed_mm, three.checks[0].missed_mm);
  EXPECT_EQ(one.iterations, three.iterations);
  std::stop_source stop;
  const Progress progress(
      [&](double fraction, const std::string&) {
        if (fraction > 0.2) stop.request_stop();
      },
      stop.get_token());
  EXPECT_THROW(propagate(scene.patient(), scene.options, 3, progress), Cancelled);
}

}  // namespace
}  // namespace glisson::uncertainty
