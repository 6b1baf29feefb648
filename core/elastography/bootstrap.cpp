// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastography/bootstrap.h"

#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

#include "base/random.h"

namespace glisson::elastography {

double quantileT(double p, double freedom) {
  return boost::math::quantile(boost::math::students_t(freedom), p);
}

Interval bootstrapSlices(std::size_t n, const std::function<double(const std::vector<std::size_t>&)>& statistic,
                         int replicates, std::uint64_t seed) {
  std::vector<std::size_t> drawn(n);
  for (std::size_t i = 0; i < n; ++i) drawn[i] = i;
  Interval out;
  out.value = n == 0 ? std::numeric_limits<double>::quiet_NaN() : statistic(drawn);
  out.se = out.low = out.high = std::numeric_limits<double>::quiet_NaN();
  if (n < 2) return out;
  Random random(seed);
  double count = 0.0, mean = 0.0, squares = 0.0;
  for (int r = 0; r < replicates; ++r) {
    for (std::size_t& slice : drawn) slice = random.below(n);
    const double value = statistic(drawn);
    if (!std::isfinite(value)) continue;
    count += 1.0;
    const double before = value - mean;
    mean += before / count;
    squares += before * (value - mean);
  }
  if (count < 2.0) return out;
  const auto slices = static_cast<double>(n);
  out.se = std::sqrt(squares / (count - 1.0) * slices / (slices - 1.0));
  const double t = quantileT(0.975, slices - 1.0);
  out.low = out.value - t * out.se;
  out.high = out.value + t * out.se;
  return out;
}

}  // namespace glisson::elastography
