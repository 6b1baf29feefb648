// SPDX-License-Identifier: GPL-3.0-or-later
#include "anatomy/detail/vesselness.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"

namespace glisson::anatomy {
namespace {

/// Convolution along one axis; weights that fall off the border are left out and the rest is rescaled.
void convolve(image::ScalarVolume& image, int axis, double sigma_voxels) {
  const int radius = std::max(1, static_cast<int>(std::ceil(3.5 * sigma_voxels)));
  std::vector<double> weight(static_cast<std::size_t>(radius) + 1);
  for (int d = 0; d <= radius; ++d)
    weight[static_cast<std::size_t>(d)] = std::exp(-0.5 * d * d / (sigma_voxels * sigma_voxels));
  const Eigen::Vector3i n = image.grid.size;
  const std::size_t strides[3] = {1, static_cast<std::size_t>(n.x()), image.grid.linear(0, 0, 1)};
  const int b = (axis + 1) % 3, c = (axis + 2) % 3, length = n[axis];
  std::vector<double> norm(static_cast<std::size_t>(length));
  for (int x = 0; x < length; ++x)
    for (int y = std::max(0, x - radius); y <= std::min(length - 1, x + radius); ++y)
      norm[static_cast<std::size_t>(x)] += weight[static_cast<std::size_t>(std::abs(x - y))];
  // Sixteen lines at a time, value by value beside each other: one pass through memory and a sum for each line at once.
  constexpr std::size_t block = 16;
  const std::size_t lines = static_cast<std::size_t>(n[b]) * static_cast<std::size_t>(n[c]);
  // Neighbouring lines lie beside each other in memory where the faster of the two other axes counts first.
  const int inner = strides[b] < strides[c] ? b : c, outer = inner == b ? c : b;
  parallelChunks(lines, 256, [&](std::size_t begin, std::size_t end) {
    std::vector<std::array<double, block>> line(static_cast<std::size_t>(length));
    for (std::size_t l = begin; l < end; l += block) {
      const std::size_t held = std::min(block, end - l);
      std::array<float*, block> first{};
      for (std::size_t m = 0; m < held; ++m)
        first[m] = image.values.data() + (l + m) % static_cast<std::size_t>(n[inner]) * strides[inner] +
                   (l + m) / static_cast<std::size_t>(n[inner]) * strides[outer];
      for (std::size_t x = 0; x < line.size(); ++x)
        for (std::size_t m = 0; m < held; ++m) line[x][m] = static_cast<double>(first[m][x * strides[axis]]);
      for (int x = 0; x < length; ++x) {
        std::array<double, block> sum{};
        for (int y = std::max(0, x - radius); y <= std::min(length - 1, x + radius); ++y) {
          const double w = weight[static_cast<std::size_t>(std::abs(x - y))];
          const std::array<double, block>& value = line[static_cast<std::size_t>(y)];
          for (std::size_t m = 0; m < block; ++m) sum[m] += w * value[m];
        }
        for (std::size_t m = 0; m < held; ++m)
          first[m][static_cast<std::size_t>(x) * strides[axis]] =
              static_cast<float>(sum[m] / norm[static_cast<std::size_t>(x)]);
      }
    }
  });
}

/// Eigenvalues of the Hessian at p times sigma², ordered by magnitude.
std::array<double, 3> curvatures(const image::ScalarVolume& s, const Eigen::Vector3i& p, double sigma_mm) {
  const double h_mm = s.grid.spacing_mm.x();
  auto at = [&](const Eigen::Vector3i& d) {
    return static_cast<double>(
        s.at((p + d).cwiseMax(Eigen::Vector3i::Zero()).cwiseMin(s.grid.size - Eigen::Vector3i::Ones())));
  };
  Eigen::Matrix3d H;
  for (int a = 0; a < 3; ++a) {
    const Eigen::Vector3i ea = Eigen::Vector3i::Unit(a);
    H(a, a) = at(ea) - 2.0 * at(Eigen::Vector3i::Zero()) + at(-ea);
    for (int b = a + 1; b < 3; ++b) {
      const Eigen::Vector3i eb = Eigen::Vector3i::Unit(b);
      H(a, b) = H(b, a) = 0.25 * (at(ea + eb) - at(ea - eb) - at(eb - ea) + at(-ea - eb));
    }
  }
  H *= sigma_mm * sigma_mm / (h_mm * h_mm);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(H, Eigen::EigenvaluesOnly);
  std::array<double, 3> l = {solver.eigenvalues()[0], solver.eigenvalues()[1], solver.eigenvalues()[2]};
  std::sort(l.begin(), l.end(), [](double x, double y) { return std::abs(x) < std::abs(y); });
  return l;
}

}  // namespace

image::ScalarVolume gaussian(const image::ScalarVolume& image, double sigma_mm) {
  image::ScalarVolume result = image;
  for (int axis = 0; axis < 3; ++axis) convolve(result, axis, sigma_mm / image.grid.spacing_mm[axis]);
  return result;
}

image::ScalarVolume maskedMean(const image::ScalarVolume& image, const image::Mask& where, double sigma_mm) {
  image::ScalarVolume sum(image.grid), weight(image.grid);
  for (std::size_t i = 0; i < image.values.size(); ++i)
    if (where.values[i] != 0) {
      sum.values[i] = image.values[i];
      weight.values[i] = 1.0F;
    }
  sum = gaussian(sum, sigma_mm);
  weight = gaussian(weight, sigma_mm);
  for (std::size_t i = 0; i < sum.values.size(); ++i)
    sum.values[i] = weight.values[i] > 1e-4F ? sum.values[i] / weight.values[i] : 0.0F;
  return sum;
}

image::ScalarVolume vesselness(const image::ScalarVolume& image, const image::Mask& roi,
                               const std::vector<double>& sigma_mm, const Progress& progress) {
  image::ScalarVolume best(image.grid);
  std::vector<Eigen::Vector3i> voxels;
  for (int k = 0; k < image.grid.size.z(); ++k)
    for (int j = 0; j < image.grid.size.y(); ++j)
      for (int i = 0; i < image.grid.size.x(); ++i)
        if (roi.at(i, j, k) != 0) voxels.emplace_back(i, j, k);
  if (voxels.empty()) return best;
  std::vector<double> strength2(voxels.size());
  std::vector<float> shape(voxels.size());
  for (std::size_t scale = 0; scale < sigma_mm.size(); ++scale) {
    progress.report(static_cast<double>(scale) / static_cast<double>(sigma_mm.size()), "vessels");
    const image::ScalarVolume smoothed = gaussian(image, sigma_mm[scale]);
    parallelChunks(voxels.size(), 4096, [&](std::size_t begin, std::size_t end) {
      progress.check();
      for (std::size_t v = begin; v < end; ++v) {
        const std::array<double, 3> l = curvatures(smoothed, voxels[v], sigma_mm[scale]);
        strength2[v] = l[0] * l[0] + l[1] * l[1] + l[2] * l[2];
        shape[v] = 0.0F;
        if (l[1] >= 0.0 || l[2] >= 0.0) continue;
        const double ra = l[1] / l[2], rb2 = l[0] * l[0] / (l[1] * l[2]);
        shape[v] = static_cast<float>((1.0 - std::exp(-2.0 * ra * ra)) * std::exp(-2.0 * rb2));
      }
    });
    std::vector<double> sorted = strength2;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    const double largest2 = *std::max_element(middle, sorted.end());
    const double c2 = std::max(25.0 * *middle, largest2 / 16.0);
    if (!(c2 > 0.0)) continue;
    for (std::size_t v = 0; v < voxels.size(); ++v) {
      const auto value = static_cast<float>(static_cast<double>(shape[v]) * (1.0 - std::exp(-0.5 * strength2[v] / c2)));
      float& held = best.at(voxels[v]);
      held = std::max(held, value);
    }
  }
  return best;
}

}  // namespace glisson::anatomy
