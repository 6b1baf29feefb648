// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/detail/clipping.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace glisson::inversion::detail {
namespace {

constexpr double leastShare = 1e-3;
constexpr std::size_t leastVoxels = 5;
constexpr Eigen::Index leastOffsets = 4;

std::pair<float, float> endsOf(const std::vector<image::ScalarVolume>& offsets) {
  float low = offsets.front().values.front(), high = low;
  for (const image::ScalarVolume& o : offsets)
    for (const float v : o.values) {
      low = std::min(low, v);
      high = std::max(high, v);
    }
  return {low, high};
}

}  // namespace

image::Mask clippedVoxels(const PhaseOffsets& direction) {
  const std::vector<image::ScalarVolume>& offsets = direction.offsets_rad;
  const auto [low, high] = endsOf(offsets);
  image::Mask clipped(offsets.front().grid);
  std::size_t moving = 0, resting = 0;
  for (std::size_t v = 0; v < clipped.values.size(); ++v) {
    bool moves = false, rests = false, touches = false;
    for (std::size_t t = 0; t < offsets.size(); ++t) {
      const float here = offsets[t].values[v], next = offsets[(t + 1) % offsets.size()].values[v];
      const bool end = here <= low || here >= high;
      moves = moves || here != next;
      rests = rests || (end && here == next);
      touches = touches || end;
    }
    if (!moves) continue;
    ++moving;
    resting += rests ? 1 : 0;
    clipped.values[v] = touches ? 1 : 0;
  }
  if (resting < leastVoxels || static_cast<double>(resting) < leastShare * static_cast<double>(moving)) return {};
  return clipped;
}

void fitUnclipped(const PhaseOffsets& direction, const image::Mask& clipped, Waves::Direction& out, image::Mask& mask) {
  const std::vector<image::ScalarVolume>& offsets = direction.offsets_rad;
  const auto [low, high] = endsOf(offsets);
  const auto n = static_cast<Eigen::Index>(offsets.size());
  for (std::size_t v = 0; v < clipped.values.size(); ++v) {
    if (clipped.values[v] == 0) continue;
    Eigen::MatrixXd basis(n, 3);
    Eigen::VectorXd values(n);
    Eigen::Index kept = 0;
    for (Eigen::Index t = 0; t < n; ++t) {
      const float value = offsets[static_cast<std::size_t>(t)].values[v];
      if (value <= low || value >= high) continue;
      const double angle = 2.0 * std::numbers::pi * static_cast<double>(t) / static_cast<double>(n);
      basis.row(kept) << 1.0, std::cos(angle), -std::sin(angle);  // Re(U exp(i angle))
      values[kept++] = static_cast<double>(value);
    }
    for (ComplexVolume& noise : out.noise) noise.values[v] = 0.0F;
    out.wave.values[v] = 0.0F;
    if (kept < leastOffsets) {
      mask.values[v] = 0;
      continue;
    }
    const Eigen::Vector3d c = basis.topRows(kept).colPivHouseholderQr().solve(values.head(kept));
    out.wave.values[v] = {static_cast<float>(c[1]), static_cast<float>(c[2])};
  }
}

}  // namespace glisson::inversion::detail
