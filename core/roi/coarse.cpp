// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/error.h"
#include "base/order_statistics.h"
#include "base/parallel.h"
#include "image/distance.h"
#include "image/resample.h"
#include "roi/detail/coarse.h"

namespace glisson::roi::detail {

image::ScalarVolume blockMeans(const image::ScalarVolume& image, double edge_mm) {
  const Eigen::Vector3i block =
      (edge_mm / image.grid.spacing_mm.array()).round().cast<int>().max(1).min(image.grid.size.array());
  image::Grid grid = image.grid;
  grid.size = (image.grid.size.array() + block.array() - 1) / block.array();
  grid.spacing_mm = image.grid.spacing_mm.cwiseProduct(block.cast<double>());
  grid.origin_lps_mm = image.grid.indexToLps(0.5 * (block.cast<double>().array() - 1.0));
  const float none = std::numeric_limits<float>::quiet_NaN();
  image::ScalarVolume result(grid, none);
  parallelChunks(static_cast<std::size_t>(grid.size.z()), 1, [&](std::size_t begin, std::size_t end) {
    for (auto k = static_cast<int>(begin); k < static_cast<int>(end); ++k)
      for (int j = 0; j < grid.size.y(); ++j)
        for (int i = 0; i < grid.size.x(); ++i) {
          double sum = 0.0;
          int n = 0;
          for (int c = k * block.z(); c < std::min((k + 1) * block.z(), image.grid.size.z()); ++c)
            for (int b = j * block.y(); b < std::min((j + 1) * block.y(), image.grid.size.y()); ++b)
              for (int a = i * block.x(); a < std::min((i + 1) * block.x(), image.grid.size.x()); ++a)
                if (const float v = image.at(a, b, c); std::isfinite(v)) {
                  sum += static_cast<double>(v);
                  ++n;
                }
          if (n > 0) result.at(i, j, k) = static_cast<float>(sum / n);
        }
  });
  float least = std::numeric_limits<float>::infinity();
  for (const float v : result.values)
    if (std::isfinite(v)) least = std::min(least, v);
  if (!std::isfinite(least)) throw BadInput("the image holds no finite value");
  for (float& v : result.values)
    if (!std::isfinite(v)) v = least;
  return result;
}

image::ScalarVolume medianSmoothed(const image::ScalarVolume& image, double radius_mm) {
  const image::Grid& grid = image.grid;
  const double reach_mm = std::max(radius_mm, grid.spacing_mm.head<2>().maxCoeff()) * (1.0 + 1e-9);
  const Eigen::Vector3i reach = (reach_mm / grid.spacing_mm.array()).floor().cast<int>();
  std::vector<Eigen::Vector3i> ball;
  for (int k = -reach.z(); k <= reach.z(); ++k)
    for (int j = -reach.y(); j <= reach.y(); ++j)
      for (int i = -reach.x(); i <= reach.x(); ++i)
        if (grid.spacing_mm.cwiseProduct(Eigen::Vector3d(i, j, k)).norm() <= reach_mm) ball.emplace_back(i, j, k);
  image::ScalarVolume result(grid);
  parallelChunks(static_cast<std::size_t>(grid.size.z()), 1, [&](std::size_t begin, std::size_t end) {
    std::vector<float> values;
    for (auto k = static_cast<int>(begin); k < static_cast<int>(end); ++k)
      for (int j = 0; j < grid.size.y(); ++j)
        for (int i = 0; i < grid.size.x(); ++i) {
          values.clear();
          for (const Eigen::Vector3i& offset : ball)
            if (const Eigen::Vector3i at = offset + Eigen::Vector3i(i, j, k); grid.contains(at))
              values.push_back(image.at(at));
          result.at(i, j, k) = middleValue(values);
        }
  });
  return result;
}

namespace {

/// Convolves along one axis with a Gaussian that is cut off, not normalised.
void blur(image::ScalarVolume& volume, int axis, double sigma_mm) {
  const image::Grid& grid = volume.grid;
  const int reach = std::max(1, static_cast<int>(std::ceil(2.5 * sigma_mm / grid.spacing_mm[axis])));
  std::vector<float> kernel;
  for (int n = -reach; n <= reach; ++n)
    kernel.push_back(static_cast<float>(std::exp(-0.5 * std::pow(n * grid.spacing_mm[axis] / sigma_mm, 2))));
  const int length = grid.size[axis];
  const std::size_t step = axis == 0 ? 1
                           : axis == 1
                               ? static_cast<std::size_t>(grid.size.x())
                               : static_cast<std::size_t>(grid.size.x()) * static_cast<std::size_t>(grid.size.y());
  const std::size_t lines = grid.voxelCount() / static_cast<std::size_t>(length);
  parallelChunks(lines, 256, [&](std::size_t begin, std::size_t end) {
    std::vector<float> line(static_cast<std::size_t>(length));
    for (std::size_t l = begin; l < end; ++l) {
      float* first = volume.values.data() + (l / step) * step * static_cast<std::size_t>(length) + l % step;
      for (int n = 0; n < length; ++n) line[static_cast<std::size_t>(n)] = first[static_cast<std::size_t>(n) * step];
      for (int n = 0; n < length; ++n) {
        float sum = 0.0F;
        const int from = std::max(0, n - reach), to = std::min(length - 1, n + reach);
        const float *values = line.data() + from, *weights = kernel.data() + (from - n + reach);
        for (int m = 0; m <= to - from; ++m) sum += weights[m] * values[m];
        first[static_cast<std::size_t>(n) * step] = sum;
      }
    }
  });
}

}  // namespace

LocalMean localMean(const image::ScalarVolume& image, const image::Mask& mask, double sigma_mm) {
  LocalMean result{image::ScalarVolume(image.grid), image::ScalarVolume(image.grid)};
  for (std::size_t v = 0; v < mask.values.size(); ++v)
    if (mask.values[v] != 0) {
      result.mean.values[v] = image.values[v];
      result.weight.values[v] = 1.0F;
    }
  for (int axis = 0; axis < 3; ++axis) {
    blur(result.mean, axis, sigma_mm);
    blur(result.weight, axis, sigma_mm);
  }
  for (std::size_t v = 0; v < mask.values.size(); ++v)
    result.mean.values[v] = result.weight.values[v] > 0.0F ? result.mean.values[v] / result.weight.values[v] : 0.0F;
  return result;
}

image::Mask refined(const image::Mask& coarse, const image::Grid& grid, double out_mm) {
  image::Mask result(grid);
  if (std::none_of(coarse.values.begin(), coarse.values.end(), [](auto v) { return v != 0; })) return result;
  const image::ScalarVolume distance = image::resampleLinear(image::distanceToBoundary_mm(coarse), grid, -1e6F);
  for (std::size_t v = 0; v < result.values.size(); ++v)
    result.values[v] = static_cast<double>(distance.values[v]) >= -out_mm ? 1 : 0;
  return result;
}

}  // namespace glisson::roi::detail
