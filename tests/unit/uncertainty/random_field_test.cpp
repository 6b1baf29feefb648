// SPDX-License-Identifier: GPL-3.0-or-later
#include "uncertainty/random_field.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"
#include "base/random.h"
#include "uncertainty/elastogram.h"

namespace glisson::uncertainty {
namespace {

TEST(RandomField, HasTheVarianceAndTheCorrelationThatItSaysUpToTheBorder) {
  const Eigen::Vector3i n(12, 10, 8);
  const Eigen::Vector3d h(3, 4, 5);
  const double length = 12;
  const auto at = [&](int i, int j, int k) { return static_cast<std::size_t>((k * n.y() + j) * n.x() + i); };
  double corner = 0, middle = 0, x = 0, z = 0, sum = 0;
  const int count = 4000;
  for (int s = 0; s < count; ++s) {
    const std::vector<float> f = randomField(n, h, length, static_cast<std::uint64_t>(s));
    ASSERT_EQ(f.size(), static_cast<std::size_t>(n.prod()));
    const double c = static_cast<double>(f[at(0, 0, 0)]), m = static_cast<double>(f[at(6, 5, 4)]);
    sum += c;
    corner += c * c;
    middle += m * m;
    x += m * static_cast<double>(f[at(10, 5, 4)]);  // 12 mm away: 1/e
    z += m * static_cast<double>(f[at(6, 5, 6)]);   // 10 mm away
  }
  const double four = 4 / std::sqrt(static_cast<double>(count));  // standard errors, generously
  EXPECT_NEAR(sum / count, 0, four);
  EXPECT_NEAR(corner / count, 1, 1.5 * four);
  EXPECT_NEAR(middle / count, 1, 1.5 * four);
  EXPECT_NEAR(x / count, std::exp(-1.0), 1.2 * four);
  EXPECT_NEAR(z / count, std::exp(-100.0 / 144), 1.2 * four);
}

TEST(RandomField, IsTheSameWithAnyNumberOfThreadsAndOtherForOtherSeeds) {
  const Eigen::Vector3i n(9, 7, 11);
  setThreadCount(1);
  const auto one = randomField(n, {3, 3, 3}, 10, 4);
  setThreadCount(3);
  const auto three = randomField(n, {3, 3, 3}, 10, 4);
  setThreadCount(0);
  EXPECT_EQ(one, three);
  EXPECT_NE(one, randomField(n, {3, 3, 3}, 10, 5));
}

TEST(MapScatter, FindsTheNoiseOfAMapAndCallsTrueDifferencesNoise) {
  image::Grid g;
  g.size = {60, 60, 2};
  g.spacing_mm = {2, 2, 10};
  Random random(3);
  elastography::StiffnessMap map;
  map.values_kPa = image::ScalarVolume(g);
  for (float& v : map.values_kPa.values) v = static_cast<float>(2.5 * std::exp(0.06 * random.normal()));
  // White noise: two values have no correlation at all, and the noise that would be correlated by 1/e is larger.
  const double white = 0.06 / std::sqrt(1 - std::exp(-1.0));
  EXPECT_NEAR(scatterOf(map, nullptr, 10).noise, white, 0.05 * white);
  EXPECT_NEAR(scatterOf(map, nullptr, 10).liver, 0.06, 0.002);
  for (std::size_t i = 0; i < map.values_kPa.values.size(); ++i) map.values_kPa.values[i] *= i % 60 < 30 ? 1.0f : 2.0f;
  EXPECT_GT(scatterOf(map, nullptr, 10).liver, 0.3);
  image::Mask left(g);
  for (std::size_t i = 0; i < left.values.size(); ++i) left.values[i] = i % 60 < 30 ? 1 : 0;
  EXPECT_NEAR(scatterOf(map, &left, 10).liver, 0.06, 0.003);
}

}  // namespace
}  // namespace glisson::uncertainty
