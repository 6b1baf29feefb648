// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/stability.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "base/error.h"

namespace glisson::study {
namespace {

TEST(Stability, EveryCaseIsAsExpectedAndComplete) {
  StabilityOptions quick;
  quick.quick = true;
  const std::vector<StabilityCase> cases = stabilitySweep(quick);
  EXPECT_GE(cases.size(), 90u);
  std::set<std::string> names;
  for (const StabilityCase& c : cases) {
    EXPECT_NE(c.verdict, "fail") << c.name << ": expected " << c.expectation << "; found " << c.detail;
    EXPECT_TRUE(c.verdict == "pass" || c.verdict == "refused as expected") << c.verdict;
    EXPECT_FALSE(c.expectation.empty());
    EXPECT_FALSE(c.detail.empty()) << c.name;
    EXPECT_TRUE(std::isfinite(c.residual)) << c.name;
    EXPECT_TRUE(names.insert(c.name).second) << c.name << " stands twice";
  }
  EXPECT_TRUE(allAsExpected(cases));
}

TEST(Stability, OneFailureIsEnough) {
  StabilityCase good, bad;
  good.verdict = "refused as expected";
  bad.verdict = "fail";
  EXPECT_TRUE(allAsExpected({good}));
  EXPECT_FALSE(allAsExpected({good, bad}));
}

TEST(Stability, StopsWhenAsked) {
  std::stop_source stop;
  int seen = 0;
  const Progress progress(
      [&](double, const std::string&) {
        if (++seen == 3) stop.request_stop();
      },
      stop.get_token());
  EXPECT_THROW(stabilitySweep({}, progress), Cancelled);
  EXPECT_LT(seen, 10);
}

}  // namespace
}  // namespace glisson::study
