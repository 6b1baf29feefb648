// SPDX-License-Identifier: GPL-3.0-or-later
#include "uncertainty/elastogram.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace glisson::uncertainty {
namespace {

constexpr double least = 0.02, most = 0.5;
constexpr double ofNormal = 0.6745;  ///< median of |x| of a standard normal

double medianOf(std::vector<double> v) {
  if (v.empty()) return 0.0;
  const auto middle = v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2);
  std::nth_element(v.begin(), middle, v.end());
  return *middle;
}

}  // namespace

MapScatter scatterOf(const elastography::StiffnessMap& map, const image::Mask* roi, double correlation_mm) {
  const image::Grid& g = map.values_kPa.grid;
  image::Mask good = elastography::trustedMask(map);
  for (std::size_t v = 0; roi != nullptr && v < good.values.size(); ++v)
    if (roi->values[v] == 0) good.values[v] = 0;
  const auto ln = [&](const Eigen::Vector3i& p) { return std::log(static_cast<double>(map.values_kPa.at(p))); };
  std::vector<double> apart;
  double sum = 0, squares = 0, count = 0;
  for (int k = 0; k < g.size.z(); ++k)
    for (int j = 0; j < g.size.y(); ++j)
      for (int i = 0; i < g.size.x(); ++i) {
        const Eigen::Vector3i p(i, j, k);
        if (good.at(p) == 0) continue;
        sum += ln(p), squares += ln(p) * ln(p), count += 1;
        for (int axis = 0; axis < 2; ++axis) {
          Eigen::Vector3i q = p;
          q[axis] += std::max(1, static_cast<int>(std::lround(correlation_mm / g.spacing_mm[axis])));
          if (g.contains(q) && good.at(q) != 0) apart.push_back(std::abs(ln(p) - ln(q)));
        }
      }
  MapScatter s;
  if (count > 1) s.liver = std::sqrt(std::max(0.0, squares / count - (sum / count) * (sum / count)));
  // Of two values correlated by 1/e the difference has variance 2 (1 − 1/e).
  s.noise = std::clamp(medianOf(std::move(apart)) / ofNormal / std::sqrt(2 * (1 - std::exp(-1.0))), least, most);
  return s;
}

}  // namespace glisson::uncertainty
