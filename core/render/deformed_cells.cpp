// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/deformed_cells.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace glisson::render {
namespace {

/// Corners of a cell by their bits: 1 along i, 2 along j, 4 along k. Six tetrahedra round the long diagonal, so that
/// neighbouring cells share the triangles of their common face.
constexpr std::array<std::array<int, 4>, 6> tetrahedra{
    {{0, 1, 3, 7}, {0, 1, 5, 7}, {0, 2, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 4, 6, 7}}};
/// Whether a tetrahedron's edges from its first corner are right-handed in the cell's own axes.
constexpr std::array<bool, 6> rightHanded{true, false, false, true, true, false};

Eigen::Vector3i cornerOffset(int bits) {
  return {bits & 1, bits >> 1 & 1, bits >> 2 & 1};
}

}  // namespace

DeformedCells::DeformedCells(const image::DisplacementField& u_mm, const image::ScalarVolume& mask)
    : u_(u_mm), mask_(mask), toIndex_(u_mm.grid), toMask_(mask.grid) {
  const image::Grid& grid = u_.grid;
  std::vector<std::uint8_t> reached(grid.voxelCount());
  std::size_t n = 0;
  for (int k = 0; k < grid.size.z(); ++k)
    for (int j = 0; j < grid.size.y(); ++j)
      for (int i = 0; i < grid.size.x(); ++i, ++n)
        reached[n] = inside(grid.indexToLps(Eigen::Vector3d(i, j, k))) > 0.0F ? 1 : 0;
  for (int k = 0; k + 1 < grid.size.z(); ++k)
    for (int j = 0; j + 1 < grid.size.y(); ++j)
      for (int i = 0; i + 1 < grid.size.x(); ++i) {
        bool any = false;
        for (int c = 0; c < 8 && !any; ++c) any = reached[grid.linear(Eigen::Vector3i(i, j, k) + cornerOffset(c))] != 0;
        if (any || inside(grid.indexToLps(Eigen::Vector3d(i + 0.5, j + 0.5, k + 0.5))) > 0.0F)
          cells_.push_back(static_cast<std::uint32_t>(grid.linear(i, j, k)));
      }
  sort();
}

float DeformedCells::inside(const Eigen::Vector3d& x_lps) const {
  return sampleLinear(mask_, toMask_(x_lps));
}

Eigen::Vector3i DeformedCells::lowestOf(std::uint32_t cell) const {
  const auto n = static_cast<std::size_t>(cell);
  const auto nx = static_cast<std::size_t>(u_.grid.size.x()), ny = static_cast<std::size_t>(u_.grid.size.y());
  return {static_cast<int>(n % nx), static_cast<int>(n / nx % ny), static_cast<int>(n / (nx * ny))};
}

std::size_t DeformedCells::boxAt(const Eigen::Vector3i& place) const {
  const Eigen::Vector3i b = place - low_;
  const auto nx = static_cast<std::size_t>(boxes_.x()), ny = static_cast<std::size_t>(boxes_.y());
  return static_cast<std::size_t>(b.x()) +
         nx * (static_cast<std::size_t>(b.y()) + ny * static_cast<std::size_t>(b.z()));
}

/// Where the corners are now, as indices of the field's grid.
std::array<Eigen::Vector3d, 8> DeformedCells::cornersOf(std::uint32_t cell) const {
  const Eigen::Vector3i low = lowestOf(cell);
  std::array<Eigen::Vector3d, 8> corners;
  for (int c = 0; c < 8; ++c) {
    const Eigen::Vector3i at = low + cornerOffset(c);
    corners[static_cast<std::size_t>(c)] = at.cast<double>() + toIndex_.A * u_.at(at).cast<double>();
  }
  return corners;
}

void DeformedCells::sort() {
  if (cells_.empty()) return;
  struct Reach {
    Eigen::Vector3i low, high;
  };
  std::vector<Reach> reaches;
  reaches.reserve(cells_.size());
  Eigen::Vector3i high = Eigen::Vector3i::Constant(std::numeric_limits<int>::min());
  low_ = Eigen::Vector3i::Constant(std::numeric_limits<int>::max());
  for (const std::uint32_t cell : cells_) {
    Eigen::Vector3d least = Eigen::Vector3d::Constant(1e9), most = -least;
    for (const Eigen::Vector3d& p : cornersOf(cell)) {
      least = least.cwiseMin(p);
      most = most.cwiseMax(p);
    }
    reaches.push_back({least.array().floor().cast<int>(), most.array().floor().cast<int>()});
    low_ = low_.cwiseMin(reaches.back().low);
    high = high.cwiseMax(reaches.back().high);
  }
  boxes_ = high - low_ + Eigen::Vector3i::Ones();
  const auto each = [&](const Reach& r, auto&& visit) {
    for (int k = r.low.z(); k <= r.high.z(); ++k)
      for (int j = r.low.y(); j <= r.high.y(); ++j)
        for (int i = r.low.x(); i <= r.high.x(); ++i) visit(boxAt({i, j, k}));
  };
  first_.assign(boxAt(high) + 2, 0);
  for (const Reach& r : reaches) each(r, [&](std::size_t b) { ++first_[b + 1]; });
  for (std::size_t b = 1; b < first_.size(); ++b) first_[b] += first_[b - 1];
  entries_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t n = 0; n < cells_.size(); ++n)
    each(reaches[n], [&](std::size_t b) { entries_[next[b]++] = cells_[n]; });
}

std::optional<Eigen::Vector3d> DeformedCells::rest(const Eigen::Vector3d& y_lps) const {
  constexpr double outside = -1e-9;  // of the barycentric coordinates
  constexpr double flat = 1e-9;      // of a voxel's volume
  const Eigen::Vector3d y = toIndex_(y_lps);
  const Eigen::Vector3i place = y.array().floor().cast<int>();
  if (((place - low_).array() < 0).any() || ((place - low_).array() >= boxes_.array()).any()) return {};
  const std::size_t b = boxAt(place);
  std::optional<Eigen::Vector3d> best;
  bool bestUpright = false;
  float bestInside = -1.0F;
  for (std::uint32_t e = first_[b]; e < first_[b + 1]; ++e) {
    const std::uint32_t cell = entries_[e];
    const std::array<Eigen::Vector3d, 8> corners = cornersOf(cell);
    const Eigen::Vector3d low = lowestOf(cell).cast<double>();
    for (std::size_t t = 0; t < tetrahedra.size(); ++t) {
      const auto& tet = tetrahedra[t];
      const Eigen::Vector3d& from = corners[0];
      Eigen::Matrix3d edges;
      for (int c = 0; c < 3; ++c)
        edges.col(c) = corners[static_cast<std::size_t>(tet[static_cast<std::size_t>(c) + 1])] - from;
      const double volume = edges.determinant();
      if (std::abs(volume) < flat) continue;
      const Eigen::Vector3d share = edges.inverse() * (y - from);
      if ((share.array() < outside).any() || share.sum() > 1.0 - outside) continue;
      Eigen::Vector3d at = low;
      for (int c = 0; c < 3; ++c) at += share[c] * cornerOffset(tet[static_cast<std::size_t>(c) + 1]).cast<double>();
      const Eigen::Vector3d x = u_.grid.indexToLps(at);
      const bool upright = (volume > 0.0) == rightHanded[t];
      const float in = inside(x);
      if (best && (upright < bestUpright || (upright == bestUpright && in <= bestInside))) continue;
      best = x;
      bestUpright = upright;
      bestInside = in;
    }
  }
  return best;
}

}  // namespace glisson::render
