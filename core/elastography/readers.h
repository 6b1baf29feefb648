// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

namespace glisson::elastography {

/// An intraclass correlation with its confidence interval (not-a-number where it does not exist).
struct Correlation {
  double value = 0.0, low = 0.0, high = 0.0;
};

/// Agreement of k readers on n cases, every reader having measured every case [shrout1979].
struct ReaderReliability {
  int cases = 0, readers = 0;
  double betweenCases = 0.0;    ///< mean square between cases, MSR
  double betweenReaders = 0.0;  ///< mean square between readers, MSC
  double residual = 0.0;        ///< mean square of the residual, MSE
  Correlation icc11;            ///< one-way random: readers differ from case to case
  Correlation icc21;            ///< two-way random, absolute agreement of a single reader: the one to report
  Correlation icc31;            ///< two-way fixed, consistency: a constant bias of a reader does not count
  double confidence = 0.95;
};

/// values: cases × readers. Intervals as in [shrout1979, mcgraw1996]. Throws BadInput: fewer than two cases or readers,
/// values that are not finite, or all values equal.
ReaderReliability readerReliability(const Eigen::MatrixXd& values, double confidence = 0.95);

/// Two readers or methods, case by case [bland1986]. Differences are b − a.
struct BlandAltman {
  int n = 0;
  double bias = 0.0, sd = 0.0;
  double lowLimit = 0.0, highLimit = 0.0;  ///< bias ± 1.96 sd
  double bias_low = 0.0, bias_high = 0.0;  ///< 95 % confidence interval of the bias (t distribution)
  double limit_ci = 0.0;                   ///< half width of the 95 % interval of either limit: t √(3/n) sd
  std::vector<double> mean, difference;    ///< of each case, to draw
};

/// Throws BadInput: unequal numbers, fewer than three cases, values that are not finite.
BlandAltman blandAltman(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace glisson::elastography
