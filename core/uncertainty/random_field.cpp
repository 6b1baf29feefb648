// SPDX-License-Identifier: GPL-3.0-or-later
#include "uncertainty/random_field.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/random.h"

namespace glisson::uncertainty {
namespace {

/// Weights of offsets −radius … radius whose squares sum to 1.
std::vector<double> weightsOf(double sigma_cells) {
  const int radius = sigma_cells > 0.2 ? static_cast<int>(std::ceil(3.5 * sigma_cells)) : 0;
  std::vector<double> w;
  double squares = 0;
  for (int i = -radius; i <= radius; ++i) {
    w.push_back(radius == 0 ? 1.0 : std::exp(-0.5 * i * i / (sigma_cells * sigma_cells)));
    squares += w.back() * w.back();
  }
  for (double& v : w) v /= std::sqrt(squares);
  return w;
}

/// Weighs along one axis, which becomes shorter by twice the radius.
std::vector<float> along(int axis, const std::vector<float>& in, Eigen::Vector3i& size, const std::vector<double>& w) {
  Eigen::Vector3i out = size;
  out[axis] -= static_cast<int>(w.size()) - 1;
  const auto nx = static_cast<std::size_t>(size.x()), ny = static_cast<std::size_t>(size.y());
  const std::size_t stride = axis == 0 ? 1 : axis == 1 ? nx : nx * ny;
  std::vector<float> result(static_cast<std::size_t>(out.prod()));
  parallelChunks(static_cast<std::size_t>(out.z()), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      for (std::size_t j = 0; j < static_cast<std::size_t>(out.y()); ++j)
        for (std::size_t i = 0; i < static_cast<std::size_t>(out.x()); ++i) {
          double sum = 0;
          const std::size_t from = (k * ny + j) * nx + i;
          for (std::size_t o = 0; o < w.size(); ++o) sum += w[o] * static_cast<double>(in[from + o * stride]);
          result[(k * static_cast<std::size_t>(out.y()) + j) * static_cast<std::size_t>(out.x()) + i] =
              static_cast<float>(sum);
        }
  });
  size = out;
  return result;
}

}  // namespace

std::vector<float> randomField(const Eigen::Vector3i& cells, const Eigen::Vector3d& h_mm, double length_mm,
                               std::uint64_t seed) {
  std::vector<double> w[3];
  Eigen::Vector3i size = cells;
  for (int axis = 0; axis < 3; ++axis) {
    w[axis] = weightsOf(0.5 * length_mm / h_mm[axis]);
    size[axis] += static_cast<int>(w[axis].size()) - 1;
  }
  const auto layer = static_cast<std::size_t>(size.x()) * static_cast<std::size_t>(size.y());
  std::vector<float> field(layer * static_cast<std::size_t>(size.z()));
  parallelChunks(static_cast<std::size_t>(size.z()), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      Random random(Random(seed + 0x51ed27 * k).next());
      for (std::size_t i = 0; i < layer; ++i) field[k * layer + i] = static_cast<float>(random.normal());
    }
  });
  for (int axis = 0; axis < 3; ++axis) field = along(axis, field, size, w[axis]);
  return field;
}

}  // namespace glisson::uncertainty
