// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/how_sure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "render/colour_map.h"

namespace glisson::render {

float sampleKnown(const image::ScalarVolume& field, const Eigen::Vector3d& index) {
  const Eigen::Vector3d low = index.array().floor();
  const Eigen::Vector3d f = index - low;
  double sum = 0.0, weight = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    Eigen::Vector3i at = low.cast<int>();
    double w = 1.0;
    for (int a = 0; a < 3; ++a) {
      const int upper = (corner >> a) & 1;
      at[a] += upper;
      w *= upper ? f[a] : 1.0 - f[a];
    }
    if (!(w > 0.0) || !field.grid.contains(at) || !std::isfinite(field.at(at))) continue;
    sum += w * static_cast<double>(field.at(at));
    weight += w;
  }
  return weight > 0.0 ? static_cast<float>(sum / weight) : std::numeric_limits<float>::quiet_NaN();
}

double placeScale_mm(const HowSure& sure) {
  std::vector<float> all(sure.vessel95_mm.begin(), sure.vessel95_mm.end());
  if (all.empty()) return 1.0;
  const auto at = all.begin() + static_cast<std::ptrdiff_t>(0.98 * static_cast<double>(all.size()));
  std::nth_element(all.begin(), at, all.end());
  return scaleEnd(static_cast<double>(*at));
}

}  // namespace glisson::render
