// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "base/error.h"
#include "phantom/phantom.h"

namespace glisson::phantom {
namespace {

class PaperCohort : public testing::TestWithParam<int> {};

TEST_P(PaperCohort, HoldsItsQuotasExactly) {
  PhantomOptions o;
  o.cases = GetParam();
  o.paperCohort = true;
  for (const std::uint64_t seed : {1, 2, 99}) {
    o.seed = seed;
    const auto draws = drawCohort(o);
    ASSERT_EQ(static_cast<int>(draws.size()), o.cases);
    const auto above = [&](double kPa) {
      return std::count_if(draws.begin(), draws.end(), [&](const CaseDraw& d) { return d.shear_kPa > kPa; });
    };
    EXPECT_EQ(above(3.1), std::lround(0.3 * o.cases));
    EXPECT_EQ(above(4.2), std::lround(0.2 * o.cases));
    double healthy = 0.0;
    for (const CaseDraw& d : draws)
      if (d.shear_kPa <= 3.1) healthy += d.shear_kPa;
    EXPECT_NEAR(healthy / static_cast<double>(o.cases - std::lround(0.3 * o.cases)), 2.1, 0.1);
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, PaperCohort, testing::Values(10, 30, 120));

TEST(Cohort, HasNoTwoEqualPatientsAndIsShuffled) {
  PhantomOptions o;
  o.cases = 120;
  o.paperCohort = true;
  const auto draws = drawCohort(o);
  std::set<std::uint64_t> seeds;
  for (const CaseDraw& d : draws) seeds.insert(d.seed);
  EXPECT_EQ(seeds.size(), draws.size());
  EXPECT_FALSE(std::is_sorted(draws.begin(), draws.end(),
                              [](const auto& a, const auto& b) { return a.shear_kPa < b.shear_kPa; }));
  EXPECT_FALSE(std::is_sorted(draws.begin(), draws.end(),
                              [](const auto& a, const auto& b) { return a.shear_kPa > b.shear_kPa; }));
  const auto firstHalf =
      std::count_if(draws.begin(), draws.begin() + 60, [](const CaseDraw& d) { return d.shear_kPa > 3.1; });
  EXPECT_GT(firstHalf, 5);
  EXPECT_LT(firstHalf, 31);
}

TEST(Cohort, DefaultDrawsLieBetweenTwoAndSixKilopascal) {
  PhantomOptions o;
  o.cases = 200;
  for (const CaseDraw& d : drawCohort(o)) {
    EXPECT_GE(d.shear_kPa, 2.0);
    EXPECT_LE(d.shear_kPa, 6.0);
  }
}

TEST(Cohort, RefusesAnEmptyOne) {
  PhantomOptions o;
  o.cases = 0;
  EXPECT_THROW(drawCohort(o), BadArgument);
}

}  // namespace
}  // namespace glisson::phantom
