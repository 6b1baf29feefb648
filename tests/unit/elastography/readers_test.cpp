// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastography/readers.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace glisson::elastography {
namespace {

// Table 2 of Shrout and Fleiss 1979: six cases, four readers; the paper gives .17, .29 and .71. Intervals as printed by
// the public program "psych" for the same table.
TEST(ReaderReliability, ShroutAndFleiss) {
  Eigen::MatrixXd table(6, 4);
  table << 9, 2, 5, 8, 6, 1, 3, 2, 8, 4, 6, 8, 7, 1, 2, 6, 10, 5, 6, 9, 6, 2, 4, 7;
  const ReaderReliability r = readerReliability(table);
  EXPECT_NEAR(r.betweenCases, 11.24, 0.005);
  EXPECT_NEAR(r.betweenReaders, 32.49, 0.005);
  EXPECT_NEAR(r.residual, 1.02, 0.005);
  EXPECT_NEAR(r.icc11.value, 0.17, 0.005);
  EXPECT_NEAR(r.icc21.value, 0.29, 0.005);
  EXPECT_NEAR(r.icc31.value, 0.71, 0.005);
  EXPECT_NEAR(r.icc11.low, -0.133, 0.005);
  EXPECT_NEAR(r.icc11.high, 0.723, 0.005);
  EXPECT_NEAR(r.icc21.low, 0.019, 0.005);
  EXPECT_NEAR(r.icc21.high, 0.761, 0.005);
  EXPECT_NEAR(r.icc31.low, 0.342, 0.005);
  EXPECT_NEAR(r.icc31.high, 0.946, 0.005);
}

TEST(ReaderReliability, BiasCountsForAgreementButNotForConsistency) {
  Eigen::MatrixXd equal(5, 2), biased(5, 2);
  equal << 1, 1, 2, 2, 4, 4, 3, 3, 7, 7;
  biased = equal;
  biased.col(1).array() += 2.0;
  const ReaderReliability same = readerReliability(equal), shifted = readerReliability(biased);
  EXPECT_NEAR(same.icc21.value, 1.0, 1e-12);
  EXPECT_NEAR(shifted.icc31.value, 1.0, 1e-12);
  // MSR = 2 var, MSC = n·2, MSE = 0: ICC(2,1) = MSR / (MSR + k MSC / n) = var / (var + 2)
  const double variance = (equal.col(0).array() - equal.col(0).mean()).square().sum() / 4.0;
  EXPECT_NEAR(shifted.icc21.value, variance / (variance + 2.0), 1e-12);
  EXPECT_THROW(readerReliability(Eigen::MatrixXd::Constant(4, 2, 3.0)), BadInput);
  EXPECT_THROW(readerReliability(equal.col(0)), BadInput);
  equal(2, 1) = std::nan("");
  EXPECT_THROW(readerReliability(equal), BadInput);
}

// Peak flow of 17 people by a mini and a large meter (first readings), Bland and Altman 1986: mean difference −2.1
// l/min, standard deviation 38.8, limits −79.7 and 75.5.
TEST(BlandAltman, PeakFlow) {
  const std::vector<double> large{494, 395, 516, 434, 476, 557, 413, 442, 650, 433, 417, 656, 267, 478, 178, 423, 427};
  const std::vector<double> mini{512, 430, 520, 428, 500, 600, 364, 380, 658, 445, 432, 626, 260, 477, 259, 350, 451};
  const BlandAltman r = blandAltman(mini, large);
  EXPECT_EQ(r.n, 17);
  EXPECT_NEAR(r.bias, -2.1, 0.05);
  EXPECT_NEAR(r.sd, 38.8, 0.05);
  // The paper takes 2 rather than 1.96 standard deviations.
  EXPECT_NEAR(r.bias - 2 * r.sd, -79.7, 0.1);
  EXPECT_NEAR(r.bias + 2 * r.sd, 75.5, 0.1);
  EXPECT_NEAR(r.highLimit - r.lowLimit, 3.92 * r.sd, 1e-9);
  // "The standard error of d is 9.4 ... the 95 % confidence interval for the bias is −22.0 to 17.8"; of the limit
  // "± 34.6".
  EXPECT_NEAR(r.bias_low, -22.0, 0.1);
  EXPECT_NEAR(r.bias_high, 17.8, 0.1);
  EXPECT_NEAR(r.limit_ci, 34.6, 0.2);
  EXPECT_THROW(blandAltman({1, 2}, {1, 2}), BadInput);
  EXPECT_THROW(blandAltman({1, 2, 3}, {1, 2}), BadInput);
}

}  // namespace
}  // namespace glisson::elastography
