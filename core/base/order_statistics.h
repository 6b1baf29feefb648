// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "base/error.h"

namespace glisson {

/// The value at place `rank` of the ascending order, 0 the smallest. Rearranges the values. Precondition: rank < size,
/// no value is NaN.
template <class T>
T atRank(std::vector<T>& values, std::size_t rank) {
  if (rank >= values.size()) throw BadArgument("atRank: there is no such place among the values");
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// The smallest value that a share of the values, in (0, 1], does not exceed (nearest rank): the one rule of
/// percentiles that are reported. Rearranges the values. Throws BadArgument where there is none.
template <class T>
T percentile(std::vector<T>& values, double share) {
  const double rank = std::ceil(share * static_cast<double>(values.size()));
  return atRank(values, static_cast<std::size_t>(std::max(rank, 1.0)) - 1);
}

/// The middle value, of an even number the upper one of the two: a value that is there. Rearranges the values. Throws
/// BadArgument where there is none.
template <class T>
T middleValue(std::vector<T>& values) {
  return atRank(values, values.size() / 2);
}

}  // namespace glisson
