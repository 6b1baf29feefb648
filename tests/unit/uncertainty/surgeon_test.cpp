// SPDX-License-Identifier: GPL-3.0-or-later
#include "uncertainty/surgeon.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace glisson::uncertainty {
namespace {

using testing::HasSubstr;

TEST(Surgeon, RadiusThatHolds95PercentOfANormalVector) {
  const auto radius = [](double x, double y, double z) {
    return radius95_mm(Eigen::Vector3d(x * x, y * y, z * z).asDiagonal());
  };
  // Roots of the quantiles of chi squared with 1, 2 and 3 degrees of freedom.
  EXPECT_NEAR(radius(2, 0, 0), 2 * 1.9600, 0.08);
  EXPECT_NEAR(radius(2, 2, 0), 2 * 2.4477, 0.08);
  EXPECT_NEAR(radius(2, 2, 2), 2 * 2.7955, 0.08);
  EXPECT_EQ(radius(0, 0, 0), 0.0);
}

/// Three landmarks; the second is where both answers are furthest apart, and no tip.
struct Places3 {
  FirstOrder first;
  Spread spread;
  explicit Places3(bool compared) {
    first.places.landmark = {4, 5, 8};
    first.measured.resize(9);
    first.measured << 0, 0, 12, 0, 0, 30, 0, 0, 20;
    if (compared) {
      first.textbook.resize(9);
      first.textbook << 0, 0, 10, 0, 0, 10, 0, 0, 12.75f;
      spread.headline.emplace();
      spread.headline->at_retractor_mm = {3.25, 12};
      spread.headline->beyond = 0.4;
    }
    for (const std::size_t l : first.places.landmark) {
      LandmarkSpread& s = spread.landmarks.emplace_back();
      s.landmark = l;
      s.place_mm2 = Eigen::Matrix3d::Identity() * (l == 4 ? 4.0 : 1.0);
      if (!compared) continue;
      s.difference95_mm = Interval{2.5, 11};
      s.beyond = l == 8 ? 0.88 : 0.001;
    }
  }
};

TEST(Surgeon, TheTipThatIsToldIsAnEndWhereBothAreFurthestApart) {
  const Places3 p(true);
  const auto tip = tipOf(p.first, p.spread, {4, 8, 100});
  ASSERT_TRUE(tip && tip->apart_mm);
  EXPECT_EQ(tip->landmark, 8u);
  EXPECT_FLOAT_EQ(static_cast<float>(tip->moves_mm), 20.0f);
  EXPECT_FLOAT_EQ(static_cast<float>(*tip->apart_mm), 7.25f);
  EXPECT_FALSE(tipOf(p.first, p.spread, {100}));
  const std::string english = forSurgeon(tip, p.spread, Language::English);
  for (const char* part : {"moves by 20 mm", "within 2.8 mm", "7.2 mm away", "2.5 to 11 mm", "5 mm or more is 88 %"})
    EXPECT_THAT(english, HasSubstr(part));
  const std::string german = forSurgeon(tip, p.spread, Language::German);
  for (const char* part : {"um 20 mm", "höchstens 2,8 mm", "7,2 mm daneben", "2,5 bis 11 mm", "beträgt 88 %"})
    EXPECT_THAT(german, HasSubstr(part));
  EXPECT_EQ(german.find('@'), std::string::npos);
}

TEST(Surgeon, WithoutAComparisonTheLeastSureEnd) {
  const Places3 p(false);
  const auto tip = tipOf(p.first, p.spread, {4, 8});
  ASSERT_TRUE(tip);
  EXPECT_EQ(tip->landmark, 4u);
  EXPECT_FALSE(tip->apart_mm);
  EXPECT_THAT(forSurgeon(tip, p.spread, Language::English), HasSubstr("moves by 12 mm"));
  EXPECT_EQ(forSurgeon({}, p.spread, Language::English), "");
}

TEST(Surgeon, WithoutAVesselWhatTheRetractorHolds) {
  const Places3 p(true);
  EXPECT_THAT(forSurgeon({}, p.spread, Language::English), HasSubstr("3.2 to 12 mm from where"));
  EXPECT_THAT(forSurgeon({}, p.spread, Language::German), HasSubstr("3,2 bis 12 mm"));
}

TEST(Surgeon, NumbersAreAsExactAsAnEstimateIs) {
  EXPECT_EQ(millimetres(0.02, Language::English), "< 0.1 mm");
  EXPECT_EQ(millimetres(0.0, Language::German), "0 mm");
  EXPECT_EQ(millimetres(7.26, Language::German), "7,3 mm");
  EXPECT_EQ(millimetres(31.4, Language::English), "31 mm");
  EXPECT_EQ(percent(0.0, Language::English), "less than 1 %");
  EXPECT_EQ(percent(1.0, Language::German), "mehr als 99 %");
  EXPECT_EQ(percent(0.505, Language::German), "51 %");
}

TEST(Surgeon, EverySourceHasALabelInBothLanguages) {
  for (int k = 0; k <= static_cast<int>(SourceKind::BeyondFirstOrder); ++k) {
    const auto kind = static_cast<SourceKind>(k);
    EXPECT_FALSE(labelOf(kind, Language::English).empty());
    EXPECT_NE(labelOf(kind, Language::English), "");
    EXPECT_NE(labelOf(kind, Language::German), "");
  }
}

}  // namespace
}  // namespace glisson::uncertainty
