// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/parallel.h"

// Separable squared distance: along each axis in turn, d(x) = min over y of ( h(|x − y|) + d(y) ), with
// h(n) = (max(0, n − gap) s)². gap 0 measures to voxel centres, gap 1/2 to voxel boxes. h is convex, so two of its
// translates cross once, and a lower envelope with a bisected crossing finds the minimum exactly (after Meijster 2000
// and Felzenszwalb and Huttenlocher 2012, whose parabolas are the case gap 0).
namespace glisson::image {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::size_t nowhere = std::numeric_limits<std::size_t>::max();

struct Field {
  Grid grid;
  std::vector<double> squared_mm2;
  std::vector<std::size_t> source;  // empty where not asked for
};

class LineTransform {
 public:
  LineTransform(int count, double spacing_mm, double gap)
      : n_(count),
        spacing_mm_(spacing_mm),
        gap_(gap),
        value_(size()),
        source_(size()),
        envelope_(size()),
        from_(size()) {}

  /// Transforms the n values at first, first + stride, ...
  void run(Field& field, std::size_t first, std::size_t stride) {
    double largest = 0.0;
    for (std::size_t i = 0; i < size(); ++i) {
      value_[i] = field.squared_mm2[first + i * stride];
      largest = std::max(largest, value_[i]);
    }
    if (largest == 0.0) return;  // nothing is nearer than itself
    int top = -1;
    for (int y = 0; y < n_; ++y) {
      if (value_[static_cast<std::size_t>(y)] == infinity) continue;
      int start = 0;
      while (top >= 0) {
        start = firstWins(envelope_[static_cast<std::size_t>(top)], y);
        if (start > from_[static_cast<std::size_t>(top)]) break;
        --top;
        start = 0;
      }
      if (start >= n_) continue;
      ++top;
      envelope_[static_cast<std::size_t>(top)] = y;
      from_[static_cast<std::size_t>(top)] = start;
    }
    if (top < 0) return;
    if (!field.source.empty())
      for (std::size_t i = 0; i < size(); ++i) source_[i] = field.source[first + i * stride];
    for (int x = n_ - 1; x >= 0; --x) {
      while (x < from_[static_cast<std::size_t>(top)]) --top;
      const auto y = static_cast<std::size_t>(envelope_[static_cast<std::size_t>(top)]);
      const std::size_t at = first + static_cast<std::size_t>(x) * stride;
      field.squared_mm2[at] = cost(x, static_cast<int>(y));
      if (!field.source.empty()) field.source[at] = source_[y];
    }
  }

 private:
  std::size_t size() const { return static_cast<std::size_t>(n_); }
  double cost(int x, int y) const {
    const double d_mm = std::max(0.0, std::abs(x - y) - gap_) * spacing_mm_;
    return d_mm * d_mm + value_[static_cast<std::size_t>(y)];
  }
  /// Smallest x at which the later source is strictly nearer; n where there is none. Bisected between the ends of steps
  /// that double, from where two parabolas of these sources cross.
  int firstWins(int earlier, int later) const {
    const auto wins = [&](int x) { return cost(x, later) < cost(x, earlier); };
    const double apart = later - earlier;
    const double rise = (value_[static_cast<std::size_t>(later)] - value_[static_cast<std::size_t>(earlier)]) /
                        (spacing_mm_ * spacing_mm_ * apart);
    const int guess = static_cast<int>(std::clamp(0.5 * (rise + earlier + later), 0.0, n_ - 1.0));
    int low = 0, high = n_;
    if (wins(guess)) {
      high = guess;
      for (int step = 1; high > 0; step *= 2) {
        const int x = std::max(0, high - step);
        if (!wins(x)) {
          low = x + 1;
          break;
        }
        high = x;
      }
    } else {
      low = guess + 1;
      for (int step = 1; low < n_; step *= 2) {
        const int x = std::min(n_ - 1, low + step - 1);
        if (wins(x)) {
          high = x;
          break;
        }
        low = x + 1;
      }
    }
    while (low < high) {
      const int middle = (low + high) / 2;
      if (wins(middle)) {
        high = middle;
      } else {
        low = middle + 1;
      }
    }
    return low;
  }

  int n_;
  double spacing_mm_, gap_;
  std::vector<double> value_;
  std::vector<std::size_t> source_;
  std::vector<int> envelope_, from_;
};

void alongAxis(Field& field, int axis, double gap) {
  const Eigen::Vector3i n = field.grid.size;
  const std::size_t strides[3] = {1, static_cast<std::size_t>(n.x()), field.grid.linear(0, 0, 1)};
  const int b = (axis + 1) % 3, c = (axis + 2) % 3;
  const std::size_t lines = static_cast<std::size_t>(n[b]) * static_cast<std::size_t>(n[c]);
  parallelChunks(lines, 256, [&](std::size_t begin, std::size_t end) {
    LineTransform line(n[axis], field.grid.spacing_mm[axis], gap);
    for (std::size_t l = begin; l < end; ++l) {
      const std::size_t ib = l % static_cast<std::size_t>(n[b]), ic = l / static_cast<std::size_t>(n[b]);
      line.run(field, ib * strides[b] + ic * strides[c], strides[axis]);
    }
  });
}

Field start(const Mask& mask, bool inside) {
  Field field{mask.grid, std::vector<double>(mask.values.size()), {}};
  for (std::size_t i = 0; i < mask.values.size(); ++i)
    field.squared_mm2[i] = ((mask.values[i] != 0) == inside) ? 0.0 : infinity;
  return field;
}

void needVoxels(const Mask& mask, const char* what) {
  if (std::none_of(mask.values.begin(), mask.values.end(), [](std::uint8_t v) { return v != 0; }))
    throw BadInput(std::string("the mask is empty (no voxel inside): ") + what + " needs at least one");
}

/// Signed distance from squared distances to the boxes of either side; axes: how many take part (2 = in the slice).
ScalarVolume combine(const Mask& mask, const Field& toInside, const Field& toOutside, int axes) {
  ScalarVolume result(mask.grid);
  const Eigen::Vector3i n = mask.grid.size;
  std::size_t at = 0;
  for (int k = 0; k < n.z(); ++k)
    for (int j = 0; j < n.y(); ++j)
      for (int i = 0; i < n.x(); ++i, ++at) {
        if (mask.values[at] == 0) {
          result.values[at] = static_cast<float>(-std::sqrt(toInside.squared_mm2[at]));
          continue;
        }
        double depth_mm = std::sqrt(toOutside.squared_mm2[at]);
        const int index[3] = {i, j, k};
        for (int a = 0; a < axes; ++a)
          depth_mm = std::min(depth_mm, (std::min(index[a], n[a] - 1 - index[a]) + 0.5) * mask.grid.spacing_mm[a]);
        result.values[at] = static_cast<float>(depth_mm);
      }
  return result;
}

ScalarVolume signedDistance(const Mask& mask, int axes) {
  Field toInside = start(mask, true), toOutside = start(mask, false);
  for (int axis = 0; axis < axes; ++axis) {
    alongAxis(toInside, axis, 0.5);
    alongAxis(toOutside, axis, 0.5);
  }
  return combine(mask, toInside, toOutside, axes);
}

}  // namespace

ScalarVolume distanceToBoundary_mm(const Mask& mask) {
  needVoxels(mask, "a distance to its surface");
  return signedDistance(mask, 3);
}

ScalarVolume distanceToOutline_mm(const Mask& mask) {
  return signedDistance(mask, 2);
}

std::vector<std::size_t> nearestInside(const Mask& mask) {
  needVoxels(mask, "a nearest voxel");
  Field field = start(mask, true);
  field.source.assign(mask.values.size(), nowhere);
  for (std::size_t i = 0; i < mask.values.size(); ++i)
    if (mask.values[i] != 0) field.source[i] = i;
  for (int axis = 0; axis < 3; ++axis) alongAxis(field, axis, 0.0);
  return std::move(field.source);
}

}  // namespace glisson::image
