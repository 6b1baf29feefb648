// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastography/fill.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "image/distance.h"
#include "image/morphology.h"

namespace glisson::elastography {
namespace {

constexpr double negligible = 1e-6;  // weight below which the neighbours say nothing

class Filler {
 public:
  Filler(const StiffnessMap& map, const image::Mask* roi, const FillOptions& options)
      : grid_(map.values_kPa.grid),
        value_(map.values_kPa.values.size()),
        trusted_(trustedMask(map, options.confidenceThreshold)) {
    if (roi != nullptr) {
      if (!roi->grid.sameGeometry(grid_))
        throw BadArgument("the region of interest lies on another grid than the stiffness map");
      for (std::size_t v = 0; v < value_.size(); ++v)
        if (roi->values[v] == 0) trusted_.values[v] = 0;
    }
    if (image::count(trusted_) == 0)
      throw BadInput(
          "no voxel of the stiffness map can be trusted in the region of interest; check the region, the unit "
          "and the confidence threshold");
    for (std::size_t v = 0; v < value_.size(); ++v)
      if (trusted_.values[v] != 0)
        value_[v] = std::clamp(static_cast<double>(map.values_kPa.values[v]), options.low_kPa, options.high_kPa);
    nearest_ = image::nearestInside(trusted_);
  }

  /// Weighted mean of trusted neighbours; weight: how much of the trilinear weight they hold.
  double interpolate(const Eigen::Vector3d& index, double& weight) const {
    weight = 0.0;
    double sum = 0.0;
    int low[3], high[3];
    double t[3];
    for (int a = 0; a < 3; ++a) {
      const int last = grid_.size[a] - 1;
      if (!(index[a] >= -0.5 - negligible && index[a] <= last + 0.5 + negligible)) return 0.0;
      const double x = std::clamp(index[a], 0.0, static_cast<double>(last));
      low[a] = static_cast<int>(x);
      high[a] = std::min(low[a] + 1, last);
      t[a] = x - low[a];
    }
    for (int corner = 0; corner < 8; ++corner) {
      double w = 1.0;
      int at[3];
      for (int a = 0; a < 3; ++a) {
        const bool upper = (corner >> a & 1) != 0;
        w *= upper ? t[a] : 1.0 - t[a];
        at[a] = upper ? high[a] : low[a];
      }
      const std::size_t v = grid_.linear(at[0], at[1], at[2]);
      if (trusted_.values[v] == 0) continue;
      weight += w;
      sum += w * value_[v];
    }
    return weight > negligible ? sum / weight : 0.0;
  }

  /// Mean round the trusted voxel nearest to the voxel that holds (or comes closest to) index.
  double fromNearest(const Eigen::Vector3d& index, double& distance_mm) const {
    Eigen::Vector3i at;
    for (int a = 0; a < 3; ++a)
      at[a] = static_cast<int>(std::clamp(std::round(index[a]), 0.0, static_cast<double>(grid_.size[a] - 1)));
    const std::size_t n = nearest_[grid_.linear(at)];
    const auto nx = static_cast<std::size_t>(grid_.size.x()), ny = static_cast<std::size_t>(grid_.size.y());
    const Eigen::Vector3i c(static_cast<int>(n % nx), static_cast<int>(n / nx % ny), static_cast<int>(n / (nx * ny)));
    distance_mm = (c.cast<double>() - index).cwiseProduct(grid_.spacing_mm).norm();
    double sum = 0.0;
    int count = 0;
    for (int dj = -2; dj <= 2; ++dj)
      for (int di = -2; di <= 2; ++di) {
        const Eigen::Vector3i p(c.x() + di, c.y() + dj, c.z());
        if (di * di + dj * dj > 4 || !grid_.contains(p) || trusted_.at(p) == 0) continue;
        sum += value_[grid_.linear(p)];
        ++count;
      }
    return sum / count;
  }

 private:
  image::Grid grid_;
  std::vector<double> value_;
  image::Mask trusted_;
  std::vector<std::size_t> nearest_;
};

}  // namespace

FilledStiffness fillStiffness(const StiffnessMap& map, const image::Mask& body, const image::Mask* roi,
                              const FillOptions& options) {
  const std::size_t voxels = image::count(body);
  if (voxels == 0) throw BadInput("the body has no voxel to give a stiffness to");
  const Filler filler(map, roi, options);
  const image::Grid& grid = body.grid;
  FilledStiffness result{image::ScalarVolume(grid), map.quantity, image::Mask(grid), 0.0, 0.0};
  const auto slices = static_cast<std::size_t>(grid.size.z());
  std::vector<double> farthest_mm(slices, 0.0);
  parallelChunks(slices, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      for (int j = 0; j < grid.size.y(); ++j)
        for (int i = 0; i < grid.size.x(); ++i) {
          const std::size_t at = grid.linear(i, j, static_cast<int>(k));
          if (body.values[at] == 0) continue;
          const Eigen::Vector3d index =
              map.values_kPa.grid.lpsToIndex(grid.indexToLps({double(i), double(j), static_cast<double>(k)}));
          double weight = 0.0, distance_mm = 0.0;
          double value_kPa = filler.interpolate(index, weight);
          result.origin.values[at] = weight > negligible ? 1 : 2;
          if (weight <= negligible) {
            value_kPa = filler.fromNearest(index, distance_mm);
            farthest_mm[k] = std::max(farthest_mm[k], distance_mm);
          }
          result.values_kPa.values[at] = static_cast<float>(value_kPa);
        }
  });
  result.farthest_mm = *std::max_element(farthest_mm.begin(), farthest_mm.end());
  result.filledFraction = static_cast<double>(std::count(result.origin.values.begin(), result.origin.values.end(), 2)) /
                          static_cast<double>(voxels);
  return result;
}

}  // namespace glisson::elastography
