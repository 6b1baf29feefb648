// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/beam.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "mechanics/static_solve.h"

namespace glisson::study {
namespace {

TEST(Beam, ProblemCarriesTheLoadThatBendsEulerBernoulliByTheTip) {
  for (const double nu : {0.0, 0.45}) {
    BeamOptions o;
    o.poisson = nu;
    o.tip_mm = 0.7;
    const mechanics::Cantilever beam = validationBeam(nu);
    const mechanics::Problem p = beamProblem(o, {15, 3, 3}, Root::Clamped);
    const double f = -p.f_N.row(2).sum() / beam.length_m;
    EXPECT_NEAR(1e3 * mechanics::eulerBernoulliDeflection_m(beam, f, beam.length_m), 0.7, 1e-12);
    // With the Poisson-free root the shear traction balances the load.
    const mechanics::Problem free = beamProblem(o, {15, 3, 3}, Root::PoissonFree);
    EXPECT_NEAR(free.f_N.row(2).sum(), 0.0, 1e-15);
  }
}

TEST(Beam, PoissonFreeRootLiesNearTimoshenkoWhateverPoissonsRatio) {
  // The clamp makes the 3-D tip depend on Poisson's ratio in another way than shear does; freed of it, beam theory
  // holds.
  for (const double nu : {0.0, 0.3, 0.45}) {
    BeamOptions o;
    o.poisson = nu;
    const ConvergedBeam c = convergedBeam(o, Root::PoissonFree, 12);
    const mechanics::Cantilever beam = validationBeam(nu);
    const double f = mechanics::loadForTip_N_m(beam, 1e-3);
    EXPECT_NEAR(c.axis_mm.back(), 1e3 * mechanics::timoshenkoDeflection_m(beam, f, beam.length_m), 0.0025) << nu;
    EXPECT_EQ(c.axis_mm.front(), 0.0);
  }
}

TEST(Beam, WithoutPoissonEffectTheClampIsTimoshenkos) {
  BeamOptions o;
  o.poisson = 0.0;
  const ConvergedBeam c = convergedBeam(o, Root::Clamped, 12);
  const mechanics::Cantilever beam = validationBeam(0.0);
  const double f = mechanics::loadForTip_N_m(beam, 1e-3);
  EXPECT_NEAR(c.axis_mm.back(), 1e3 * mechanics::timoshenkoDeflection_m(beam, f, beam.length_m), 0.002);
  EXPECT_NEAR(c.axis_mm.back() - 1.0, 0.032, 0.002);
  EXPECT_LT(c.uncertainty_mm, 0.003);
}

TEST(Beam, DeflectionIsProportionalToTheLoad) {
  BeamOptions one, three;
  three.tip_mm = 3.0;
  const auto axis = [](const BeamOptions& o) {
    const mechanics::Problem p = beamProblem(o, {15, 3, 3}, Root::Clamped);
    return axisDeflection_mm(mechanics::VoxelMesh(p.body), mechanics::solveStatic(p).u_m);
  };
  const std::vector<double> a = axis(one), b = axis(three);
  ASSERT_EQ(a.size(), 31u);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(b[i], 3.0 * a[i], 1e-6);
  EXPECT_TRUE(std::is_sorted(a.begin(), a.end()));
}

TEST(Beam, UnusableOptionsAreRefused) {
  BeamOptions o;
  o.tip_mm = -1;
  EXPECT_THROW(studyBeam(o), BadInput);
  o = {};
  o.poisson = 0.5;
  EXPECT_THROW(studyBeam(o), BadInput);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(studyBeam({}, Progress({}, stop.get_token())), Cancelled);
}

class BeamRows : public testing::Test {
 protected:
  static const BeamStudy& study() {
    static const BeamStudy s = [] {
      BeamOptions o;
      o.poisson = 0.3;
      o.quick = true;
      return studyBeam(o);
    }();
    return s;
  }
  static const Row& find(const std::string& method, int leastDofs, const std::string& reference) {
    for (const Row& r : study().rows)
      if (r.method == method && r.dofs >= leastDofs && r.reference == reference) return r;
    throw BadArgument("no such row: " + method);
  }
};

TEST_F(BeamRows, EveryMethodStandsAgainstEveryReference) {
  ASSERT_FALSE(study().rows.empty());
  std::size_t each[3] = {0, 0, 0};
  for (const Row& r : study().rows) {
    each[r.reference == converged3d ? 0 : r.reference == timoshenko ? 1 : 2] += 1;
    EXPECT_GT(r.dofs, 0);
    EXPECT_GT(r.total_s(), 0.0);
    EXPECT_TRUE(r.step_ms > 0.0 || r.method[0] == 'T') << r.method;  // tetrahedra have no time steps
    EXPECT_TRUE(std::isfinite(r.max_error_mm)) << r.method;
    EXPECT_GE(r.max_error_mm, r.tip_error_mm);
    EXPECT_GE(r.max_error_mm, r.mean_error_mm);
    EXPECT_FALSE(r.resolution.empty());
  }
  EXPECT_EQ(each[0], each[1]);
  EXPECT_EQ(each[0], each[2]);
}

TEST_F(BeamRows, GapsAreThoseOfTheTheories) {
  EXPECT_NEAR(study().eulerBernoulliTip_mm, 1.0, 1e-12);
  EXPECT_NEAR(study().timoshenkoTip_mm, 1.0408, 1e-4);
  EXPECT_NEAR(study().gapEulerBernoulliTip_mm, 0.024, 0.003);
  // A method that is right differs from Euler-Bernoulli by the gap, not by nothing.
  const Row& fem = find("H8-incompatible", 4000, eulerBernoulli);
  EXPECT_NEAR(fem.tip_error_mm, study().gapEulerBernoulliTip_mm, 0.01);
}

TEST_F(BeamRows, TetrahedraAndMovingLeastSquaresStandBesideTheOthers) {
  // Linear tetrahedra lock more than trilinear hexahedra; quadratic ones do not.
  const double hex = find("H8", 4000, converged3d).max_error_mm;
  EXPECT_GT(find("T4", 4000, converged3d).max_error_mm, hex);
  EXPECT_LT(find("T4 mirrored", 4000, converged3d).max_error_mm, find("T4", 4000, converged3d).max_error_mm);
  EXPECT_LT(find("T10", 4000, converged3d).max_error_mm, 0.5 * hex);
  // With the root that beam theory assumes, quadratic tetrahedra find Timoshenko's tip.
  EXPECT_LT(find("T10", 4000, timoshenko).tip_error_mm, 0.01);
  const double linear = find("MLS linear", 600, converged3d).max_error_mm;
  EXPECT_LT(find("MLS quadratic", 600, converged3d).max_error_mm, 0.5 * linear);
  EXPECT_LE(find("MLS quadratic", 600, converged3d).max_error_mm, study().allowed_mm);
}

TEST_F(BeamRows, GoalsSayWhatWasMeasured) {
  ASSERT_EQ(study().goals.size(), 10u);
  for (const BeamGoal& g : study().goals) {
    EXPECT_EQ(g.poisson, 0.3);
    EXPECT_GT(g.value, 0.0) << g.what;
    EXPECT_EQ(g.line().rfind(g.met() ? "met" : "missed", 0), 0u);
    EXPECT_EQ(g.line().find("missed by") == std::string::npos, g.met());
    EXPECT_NE(study().summary().find(g.line()), std::string::npos);
  }
  // The same figure as in the rows.
  EXPECT_NEAR(study().goals[0].value, find("H8-incompatible", 4000, converged3d).max_error_mm, 1e-3);
}

TEST_F(BeamRows, GoalsAtVoxelSizeAndWithFrames) {
  EXPECT_LE(find("H8-incompatible", 4000, converged3d).max_error_mm, study().allowed_mm);
  EXPECT_LE(find("H8-Bbar", 4000, converged3d).max_error_mm, study().allowed_mm);
  EXPECT_LE(find("Wendland quadratic", 700, converged3d).max_error_mm, study().allowed_mm);
  EXPECT_GT(find("Voronoi, factorised", 700, converged3d).max_error_mm,
            3.0 * find("Wendland quadratic", 700, converged3d).max_error_mm);
}

}  // namespace
}  // namespace glisson::study
