// SPDX-License-Identifier: GPL-3.0-or-later
#include "anatomy/regions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/error.h"
#include "image/resample.h"

namespace glisson::anatomy {
namespace {

constexpr double band_mm = 10.0;

bool inside(const image::Mask& mask, const Eigen::Vector3d& p_lps) {
  const auto voxel = image::voxelAt(mask.grid, p_lps);
  return voxel && mask.at(*voxel) != 0;
}

/// Lowest point of the mask straight below a point inside it, to about 1e-3 mm.
Eigen::Vector3d lowestBelow(const image::Mask& mask, const Eigen::Vector3d& from_lps, double lowest_mm) {
  const double step_mm = 0.25 * mask.grid.spacing_mm.minCoeff();
  Eigen::Vector3d good = from_lps, p = from_lps;
  while (p.z() > lowest_mm) {
    p.z() -= step_mm;
    if (inside(mask, p)) good = p;  // carries on below a gap: the inferior surface is the last one
  }
  double in_mm = good.z(), out_mm = good.z() - step_mm;
  while (in_mm - out_mm > 1e-3) {
    const double middle_mm = 0.5 * (in_mm + out_mm);
    p.z() = middle_mm;
    (inside(mask, p) ? in_mm : out_mm) = middle_mm;
  }
  good.z() = in_mm;
  return good;
}

}  // namespace

Eigen::Vector3d inferiorRightLobePoint(const image::Mask& liver) {
  std::vector<Eigen::Vector3d> centres;
  std::size_t at = 0;
  for (int k = 0; k < liver.grid.size.z(); ++k)
    for (int j = 0; j < liver.grid.size.y(); ++j)
      for (int i = 0; i < liver.grid.size.x(); ++i, ++at)
        if (liver.values[at] != 0) centres.push_back(liver.grid.indexToLps(Eigen::Vector3d(i, j, k)));
  if (centres.empty()) throw BadInput("the liver mask is empty: there is no right lobe to lift");

  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Eigen::Vector3d& p : centres) {
    low = std::min(low, p.x());
    high = std::max(high, p.x());
  }
  const double right = low + (high - low) / 3.0 + 1e-6;
  std::erase_if(centres, [&](const Eigen::Vector3d& p) { return p.x() > right; });
  double lowest = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& p : centres) lowest = std::min(lowest, p.z());
  // Extent of a voxel along z, whatever the orientation of the grid.
  const double voxel_mm = liver.grid.direction.row(2).cwiseAbs().dot(liver.grid.spacing_mm);
  const double top = lowest + std::max(band_mm, voxel_mm) - 1e-6;
  std::erase_if(centres, [&](const Eigen::Vector3d& p) { return p.z() > top; });

  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : centres) centroid += p / static_cast<double>(centres.size());
  if (!inside(liver, centroid))
    centroid =
        *std::min_element(centres.begin(), centres.end(), [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
          return (a - centroid).squaredNorm() < (b - centroid).squaredNorm();
        });
  return lowestBelow(liver, centroid, lowest - voxel_mm);
}

}  // namespace glisson::anatomy
