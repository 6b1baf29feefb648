// SPDX-License-Identifier: GPL-3.0-or-later
#include "roi/edge_paths.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/error.h"

namespace glisson::roi {
namespace {

constexpr int dearest = 200;          ///< cost of a pixel where nothing changes
constexpr double halfCostPart = 0.9;  ///< of all pixels are flatter than one of half the cost
constexpr double diagonal = 1.4142135623730951;
constexpr double mostShift = 0.75;  ///< pixels, from its centre to the edge
constexpr std::uint32_t unreached = std::numeric_limits<std::uint32_t>::max();

struct Step {
  int i, j;
};
constexpr std::array<Step, 8> steps{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}}};

/// (1, 2, 1) / 4 along rows and columns; the border is repeated. What is not finite counts as 0.
std::vector<float> smoothed(const image::ScalarVolume& image, int k) {
  const int nx = image.grid.size.x(), ny = image.grid.size.y();
  std::vector<float> out(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny));
  const auto value = [&](int i, int j) {
    const float v = image.at(std::clamp(i, 0, nx - 1), std::clamp(j, 0, ny - 1), k);
    return std::isfinite(v) ? v : 0.0F;
  };
  const auto row = [&](int i, int j) { return 0.25F * value(i - 1, j) + 0.5F * value(i, j) + 0.25F * value(i + 1, j); };
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i)
      out[static_cast<std::size_t>(j) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(i)] =
          0.25F * row(i, j - 1) + 0.5F * row(i, j) + 0.25F * row(i, j + 1);
  return out;
}

}  // namespace

EdgePaths::EdgePaths(const image::ScalarVolume& image, int k)
    : nx_(image.grid.size.x()), ny_(image.grid.size.y()), spacing_mm_(image.grid.spacing_mm.head<2>()) {
  if (k < 0 || k >= image.grid.size.z()) throw BadArgument("the image has no slice " + std::to_string(k + 1));
  const std::vector<float> value = smoothed(image, k);
  const std::size_t n = value.size();
  slopeX_.resize(n);
  slopeY_.resize(n);
  slope_.resize(n);
  const auto at = [&](int i, int j) {
    return static_cast<double>(
        value[static_cast<std::size_t>(std::clamp(j, 0, ny_ - 1) * nx_ + std::clamp(i, 0, nx_ - 1))]);
  };
  for (int j = 0; j < ny_; ++j)
    for (int i = 0; i < nx_; ++i) {
      const auto p = static_cast<std::size_t>(j * nx_ + i);
      const double x = 0.5 * (at(i + 1, j) - at(i - 1, j)) / spacing_mm_.x();
      const double y = 0.5 * (at(i, j + 1) - at(i, j - 1)) / spacing_mm_.y();
      slopeX_[p] = static_cast<float>(x);
      slopeY_[p] = static_cast<float>(y);
      slope_[p] = static_cast<float>(std::hypot(x, y));
    }
  std::vector<float> sorted = slope_;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(halfCostPart * static_cast<double>(n - 1));
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double half = std::max(static_cast<double>(*middle), 1e-30);
  cost_.resize(n);
  for (std::size_t p = 0; p < n; ++p) {
    const double s = static_cast<double>(slope_[p]) / half;
    cost_[p] = static_cast<std::uint16_t>(1 + std::lround((dearest - 1) / (1.0 + s * s)));
  }
  buckets_.resize(static_cast<std::size_t>(std::ceil(diagonal * dearest)) + 2);
  startAt({0.0, 0.0});
}

int EdgePaths::indexOf(const Eigen::Vector2d& pixel) const {
  const int i = std::clamp(static_cast<int>(std::lround(std::clamp(pixel.x(), -1.0, 1e6))), 0, nx_ - 1);
  const int j = std::clamp(static_cast<int>(std::lround(std::clamp(pixel.y(), -1.0, 1e6))), 0, ny_ - 1);
  return j * nx_ + i;
}

void EdgePaths::startAt(const Eigen::Vector2d& pixel) {
  start_ = indexOf(pixel);
  const std::size_t n = cost_.size();
  distance_.assign(n, unreached);
  before_.assign(n, -1);
  settled_.assign(n, false);
  for (std::vector<int>& bucket : buckets_) bucket.clear();
  at_ = 0;
  distance_[static_cast<std::size_t>(start_)] = 0;
  buckets_[0].push_back(start_);
  waiting_ = 1;
}

// Dijkstra with a bucket for each distance: the longest step is shorter than the ring of buckets.
void EdgePaths::settleUntil(int target) {
  while (!settled_[static_cast<std::size_t>(target)] && waiting_ > 0) {
    std::vector<int>& bucket = buckets_[at_ % buckets_.size()];
    if (bucket.empty()) {
      ++at_;
      continue;
    }
    const int here = bucket.back();
    bucket.pop_back();
    --waiting_;
    const auto p = static_cast<std::size_t>(here);
    if (settled_[p] || distance_[p] != at_) continue;
    settled_[p] = true;
    const int i = here % nx_, j = here / nx_;
    for (const Step& step : steps) {
      const int ni = i + step.i, nj = j + step.j;
      if (ni < 0 || nj < 0 || ni >= nx_ || nj >= ny_) continue;
      const auto q = static_cast<std::size_t>(nj * nx_ + ni);
      if (settled_[q]) continue;
      const double length = step.i != 0 && step.j != 0 ? diagonal : 1.0;
      const auto way = static_cast<std::uint32_t>(std::max(1L, std::lround(length * 0.5 * (cost_[p] + cost_[q]))));
      if (at_ + way >= distance_[q]) continue;
      distance_[q] = at_ + way;
      before_[q] = here;
      buckets_[(at_ + way) % buckets_.size()].push_back(static_cast<int>(q));
      ++waiting_;
    }
  }
}

double EdgePaths::slopeAt(const Eigen::Vector2d& pixel) const {
  const double x = std::clamp(pixel.x(), 0.0, nx_ - 1.0), y = std::clamp(pixel.y(), 0.0, ny_ - 1.0);
  const int i = std::min(static_cast<int>(x), std::max(nx_ - 2, 0)),
            j = std::min(static_cast<int>(y), std::max(ny_ - 2, 0));
  const double u = x - i, v = y - j;
  const auto at = [&](int a, int b) {
    return static_cast<double>(slope_[static_cast<std::size_t>(std::min(b, ny_ - 1) * nx_ + std::min(a, nx_ - 1))]);
  };
  return (1.0 - v) * ((1.0 - u) * at(i, j) + u * at(i + 1, j)) + v * ((1.0 - u) * at(i, j + 1) + u * at(i + 1, j + 1));
}

// The top of a parabola through the slopes one pixel before and behind, across the edge.
Eigen::Vector2d EdgePaths::onTheEdge(int index) const {
  const Eigen::Vector2d centre(index % nx_, index / nx_);
  const auto p = static_cast<std::size_t>(index);
  Eigen::Vector2d across(static_cast<double>(slopeX_[p]) * spacing_mm_.x(),
                         static_cast<double>(slopeY_[p]) * spacing_mm_.y());
  if (!(across.norm() > 0.0)) return centre;
  across.normalize();
  const double here = slopeAt(centre), ahead = slopeAt(centre + across), behind = slopeAt(centre - across);
  const double bend = ahead + behind - 2.0 * here;
  double shift = 0.0;
  if (bend < 0.0)
    shift = std::clamp(0.5 * (behind - ahead) / bend, -mostShift, mostShift);
  else if (ahead != behind)
    shift = ahead > behind ? mostShift : -mostShift;
  return centre + shift * across;
}

Eigen::Matrix2Xd EdgePaths::to(const Eigen::Vector2d& pixel) {
  const int target = indexOf(pixel);
  settleUntil(target);
  std::vector<int> way;
  for (int p = target; p >= 0; p = before_[static_cast<std::size_t>(p)]) way.push_back(p);
  std::reverse(way.begin(), way.end());
  const auto n = static_cast<Eigen::Index>(way.size());
  Eigen::Matrix2Xd points(2, n);
  for (Eigen::Index v = 0; v < n; ++v) {
    const int p = way[static_cast<std::size_t>(v)];
    points.col(v) = v == 0 || v + 1 == n ? Eigen::Vector2d(p % nx_, p / nx_) : onTheEdge(p);
  }
  // The stairs of the pixels go.
  for (int pass = 0; pass < 2; ++pass) {
    const Eigen::Matrix2Xd before = points;
    for (Eigen::Index v = 1; v + 1 < n; ++v)
      points.col(v) = 0.25 * before.col(v - 1) + 0.5 * before.col(v) + 0.25 * before.col(v + 1);
  }
  return points;
}

}  // namespace glisson::roi
