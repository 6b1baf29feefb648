// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <algorithm>
#include <limits>

#include "base/order_statistics.h"
#include "base/quantity_names.h"
#include "base/random.h"

using namespace glisson;
using testing::HasSubstr;

// The definition of nearest rank: the smallest value with a share of at least p at or below it.
TEST(Percentile, IsTheSmallestValueThatEnoughDoNotExceed) {
  Random random(5);
  for (const std::size_t n : {1u, 2u, 19u, 20u, 21u, 1000u})
    for (const double p : {0.01, 0.5, 0.95, 1.0}) {
      std::vector<double> v(n);
      for (double& x : v) x = std::floor(random.uniform(0, 40));  // with ties
      const std::vector<double> before = v;
      const double found = percentile(v, p);
      const auto share = [&](auto&& test) {
        return static_cast<double>(std::count_if(before.begin(), before.end(), test)) / static_cast<double>(n);
      };
      EXPECT_GE(share([&](double x) { return x <= found; }), p);
      EXPECT_LT(share([&](double x) { return x < found; }), p);
      EXPECT_THAT(v, testing::UnorderedElementsAreArray(before));
    }
}

TEST(Percentile, MiddleOfAnEvenNumberIsTheUpperOne) {
  std::vector<int> even = {4, 1, 3, 2}, odd = {5, 9, 7};
  EXPECT_EQ(middleValue(even), 3);
  EXPECT_EQ(middleValue(odd), 7);
}

TEST(Percentile, ThereIsNoneOfNothing) {
  std::vector<float> none;
  EXPECT_THROW(percentile(none, 0.95), BadArgument);
  EXPECT_THROW(middleValue(none), BadArgument);
}

TEST(EnumNames, EveryWordLeadsBackToItsValue) {
  for (const std::string& word : stiffnessQuantityNames.words())
    EXPECT_EQ(stiffnessQuantityNames.nameOf(stiffnessQuantityNames.named(word)), word);
  EXPECT_EQ(stiffnessQuantityNames.named("youngs"), StiffnessQuantity::Youngs);
}

TEST(EnumNames, AnotherWordIsRefusedWithThoseThatThereAre) {
  try {
    stiffnessQuantityNames.named("stiff");
    FAIL() << "a word that is not in the table was taken";
  } catch (const BadInput& e) {
    EXPECT_THAT(e.what(), HasSubstr("stiff"));
    EXPECT_THAT(e.what(), HasSubstr("shear, youngs"));
  }
  EXPECT_THROW(stiffnessQuantityNames.nameOf(static_cast<StiffnessQuantity>(7)), BadArgument);
}
