// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace glisson::uncertainty {

/// A normal random field on cells, mean 0 and variance 1 everywhere, correlated by exp(−d²/length²) at distance d:
/// white noise under a separable Gaussian of standard deviation length/2, with cells beyond the border, so that the
/// border is no different. Cells x fastest; mm. A length far below the edge of a cell gives white noise. The same bits
/// for the same seed, with any number of threads.
std::vector<float> randomField(const Eigen::Vector3i& cells, const Eigen::Vector3d& h_mm, double length_mm,
                               std::uint64_t seed);

}  // namespace glisson::uncertainty
