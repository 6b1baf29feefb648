// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace glisson::elastography {

/// A figure with its standard error and 95 % interval; not-a-number where nothing can be said.
struct Interval {
  double value = 0.0;
  double se = 0.0;
  double low = 0.0, high = 0.0;
};

/// Quantile of Student's t; p in (0, 1), freedom > 0.
double quantileT(double p, double freedom);

/// Bootstrap over slices [efron1993]: what the figure would be had other slices been hit. statistic gets the numbers of
/// the slices drawn (of n, with repetition) and may return not-a-number, which does not count. The standard deviation
/// of the replicates is multiplied by √(n/(n−1)), as n draws out of n slices vary too little, and the interval is
/// value ± t(n−1) se. Fewer than two slices: not-a-number. Same seed, same bits.
Interval bootstrapSlices(std::size_t n, const std::function<double(const std::vector<std::size_t>&)>& statistic,
                         int replicates = 1000, std::uint64_t seed = 1);

}  // namespace glisson::elastography
