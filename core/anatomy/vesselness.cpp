// SPDX-License-Identifier: GPL-3.0-or-later
#include "anatomy/detail/vesselness.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "base/wide_registers.h"

namespace glisson::anatomy {
namespace {

constexpr std::size_t block = 16;  ///< lines that are convolved beside each other

/// Sums of `block` lines beside each other, for one place: `taps` values from `value` on, by weights that begin at
/// `weight`.
GLISSON_WIDE void weigh(const double* value, const double* weight, int taps, double* sum) {
  double s[block] = {};
  for (int t = 0; t < taps; ++t) {
    const double w = weight[t];
    const double* v = value + static_cast<std::size_t>(t) * block;
    for (std::size_t m = 0; m < block; ++m) s[m] += w * v[m];
  }
  for (std::size_t m = 0; m < block; ++m) sum[m] = s[m];
}

/// Convolution along one axis; weights that fall off the border are left out and the rest is rescaled.
void convolve(image::ScalarVolume& image, int axis, double sigma_voxels) {
  const int radius = std::max(1, static_cast<int>(std::ceil(3.5 * sigma_voxels)));
  std::vector<double> weight(2 * static_cast<std::size_t>(radius) + 1);
  for (int d = -radius; d <= radius; ++d)
    weight[static_cast<std::size_t>(radius + d)] = std::exp(-0.5 * d * d / (sigma_voxels * sigma_voxels));
  const Eigen::Vector3i n = image.grid.size;
  const std::size_t strides[3] = {1, static_cast<std::size_t>(n.x()), image.grid.linear(0, 0, 1)};
  const int b = (axis + 1) % 3, c = (axis + 2) % 3, length = n[axis];
  std::vector<double> norm(static_cast<std::size_t>(length));
  for (int x = 0; x < length; ++x)
    for (int y = std::max(0, x - radius); y <= std::min(length - 1, x + radius); ++y)
      norm[static_cast<std::size_t>(x)] += weight[static_cast<std::size_t>(radius + y - x)];
  // Sixteen lines at a time, value by value beside each other: one pass through memory and a sum for each line at once.
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
        const int from = std::max(0, x - radius), to = std::min(length - 1, x + radius);
        weigh(line[static_cast<std::size_t>(from)].data(), weight.data() + (radius + from - x), to - from + 1,
              sum.data());
        for (std::size_t m = 0; m < held; ++m)
          first[m][static_cast<std::size_t>(x) * strides[axis]] =
              static_cast<float>(sum[m] / norm[static_cast<std::size_t>(x)]);
      }
    }
  });
}

/// Hessians of an image times sigma², by central differences; beyond the border its outermost values go on.
class Hessians {
 public:
  Hessians(const image::ScalarVolume& image, double sigma_mm)
      : image_(image),
        factor_(sigma_mm * sigma_mm / (image.grid.spacing_mm.x() * image.grid.spacing_mm.x())),
        stride_{1, image.grid.size.x(), std::ptrdiff_t{image.grid.size.x()} * image.grid.size.y()} {}

  Eigen::Matrix3d at(const Eigen::Vector3i& p) const {
    if ((p.array() > 0).all() && (p.array() + 1 < image_.grid.size.array()).all()) {
      const float* centre = image_.values.data() + image_.grid.linear(p);
      return of([&](int i, int j, int k) {
        return static_cast<double>(centre[i * stride_[0] + j * stride_[1] + k * stride_[2]]);
      });
    }
    const Eigen::Vector3i last = image_.grid.size - Eigen::Vector3i::Ones();
    return of([&](int i, int j, int k) {
      return static_cast<double>(
          image_.at((p + Eigen::Vector3i(i, j, k)).cwiseMax(Eigen::Vector3i::Zero()).cwiseMin(last)));
    });
  }

 private:
  /// value(i, j, k): at an offset.
  template <typename Value>
  Eigen::Matrix3d of(const Value& value) const {
    const double twice = 2.0 * value(0, 0, 0);
    Eigen::Matrix3d H;
    H(0, 0) = value(1, 0, 0) - twice + value(-1, 0, 0);
    H(1, 1) = value(0, 1, 0) - twice + value(0, -1, 0);
    H(2, 2) = value(0, 0, 1) - twice + value(0, 0, -1);
    H(0, 1) = H(1, 0) = 0.25 * (value(1, 1, 0) - value(1, -1, 0) - value(-1, 1, 0) + value(-1, -1, 0));
    H(0, 2) = H(2, 0) = 0.25 * (value(1, 0, 1) - value(1, 0, -1) - value(-1, 0, 1) + value(-1, 0, -1));
    H(1, 2) = H(2, 1) = 0.25 * (value(0, 1, 1) - value(0, 1, -1) - value(0, -1, 1) + value(0, -1, -1));
    return factor_ * H;
  }

  const image::ScalarVolume& image_;
  double factor_;
  std::array<std::ptrdiff_t, 3> stride_;
};

/// How much a Hessian is that of a bright tube: 0 to 1.
float tubeness(const Eigen::Matrix3d& H) {
  // The two larger eigenvalues of a tube are negative, and with them the sum of all three: half of all places need
  // none.
  if (H.trace() >= 0.0) return 0.0F;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(H, Eigen::EigenvaluesOnly);
  std::array<double, 3> l = {solver.eigenvalues()[0], solver.eigenvalues()[1], solver.eigenvalues()[2]};
  std::sort(l.begin(), l.end(), [](double x, double y) { return std::abs(x) < std::abs(y); });
  if (l[1] >= 0.0 || l[2] >= 0.0) return 0.0F;
  const double ra = l[1] / l[2], rb2 = l[0] * l[0] / (l[1] * l[2]);
  return static_cast<float>((1.0 - std::exp(-2.0 * ra * ra)) * std::exp(-2.0 * rb2));
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
    const Hessians hessians(smoothed, sigma_mm[scale]);
    parallelChunks(voxels.size(), 4096, [&](std::size_t begin, std::size_t end) {
      progress.check();
      for (std::size_t v = begin; v < end; ++v) {
        const Eigen::Matrix3d H = hessians.at(voxels[v]);
        strength2[v] = H.squaredNorm();  // the sum of the squared eigenvalues
        shape[v] = tubeness(H);
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
