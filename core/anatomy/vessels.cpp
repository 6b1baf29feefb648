// SPDX-License-Identifier: GPL-3.0-or-later
#include "anatomy/vessels.h"

#include <algorithm>
#include <cmath>

#include "anatomy/centreline.h"
#include "anatomy/detail/isosurface.h"
#include "anatomy/detail/vesselness.h"
#include "base/error.h"
#include "image/components.h"
#include "image/distance.h"
#include "image/morphology.h"
#include "image/resample.h"

namespace glisson::anatomy {
namespace {

constexpr double background_mm = 12.0;
constexpr double largestRim_mm = 4.0;
constexpr double leastContrast = 0.05;  // of the liver's brightness
constexpr int scales = 4;

/// Isotropic grid along the MRI's axes round the liver.
image::Grid workingGrid(const image::Grid& mri, const image::Mask& liver, double margin_mm) {
  const double h_mm = std::max(1.0, mri.spacing_mm.minCoeff());
  image::Grid grid = mri;
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = -low;
  std::size_t at = 0;
  for (int k = 0; k < liver.grid.size.z(); ++k)
    for (int j = 0; j < liver.grid.size.y(); ++j)
      for (int i = 0; i < liver.grid.size.x(); ++i, ++at)
        if (liver.values[at] != 0) {
          const Eigen::Vector3d p = mri.direction.transpose() * liver.grid.indexToLps(Eigen::Vector3d(i, j, k));
          low = low.cwiseMin(p);
          high = high.cwiseMax(p);
        }
  low.array() -= margin_mm;
  high.array() += margin_mm;
  grid.spacing_mm.setConstant(h_mm);
  for (int a = 0; a < 3; ++a) grid.size[a] = static_cast<int>(std::ceil((high[a] - low[a]) / h_mm)) + 1;
  grid.origin_lps_mm = mri.direction * low;
  grid.check();
  return grid;
}

struct Working {
  image::ScalarVolume image;  // sign turned where vessels are dark
  image::Mask liver;
  double level = 0.0;  // median brightness of the liver
};

double quantile(std::vector<float> values, double fraction) {
  if (values.empty()) return 0.0;
  const auto place = static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + place, values.end());
  return static_cast<double>(values[static_cast<std::size_t>(place)]);
}

Working prepare(const image::ScalarVolume& mri, const image::Mask& liver, const VesselOptions& options) {
  if (image::count(liver) == 0) throw BadInput("the liver mask is empty: there is no place to look for vessels");
  const image::Grid grid = workingGrid(mri.grid, liver, 2.0 * options.largestRadius_mm);
  Working w{image::resampleLinear(mri, grid, std::nanf("")), image::resampleNearest(liver, grid), 0.0};
  bool inside = false;
  for (std::size_t i = 0; i < w.liver.values.size(); ++i)
    inside = inside || (w.liver.values[i] != 0 && std::isfinite(w.image.values[i]));
  if (!inside) throw BadInput("the liver mask lies outside the image; check that both belong to the same examination");
  // The outermost voxel layer of the MRI mixes liver and surroundings.
  w.liver = image::erode(w.liver, std::min(mri.grid.spacing_mm.maxCoeff(), largestRim_mm));
  for (std::size_t i = 0; i < w.image.values.size(); ++i) {
    if (!std::isfinite(w.image.values[i])) {
      w.image.values[i] = 0.0F;
      w.liver.values[i] = 0;
    } else if (!options.bright) {
      w.image.values[i] = -w.image.values[i];
    }
  }
  if (image::count(w.liver) == 0)
    throw BadInput(
        "the liver is thinner than two voxels everywhere: nothing of it is left once its outermost layer, mixed with "
        "the surroundings, is taken off; outline it on at least three neighbouring slices");
  std::vector<float> values;
  for (std::size_t i = 0; i < w.image.values.size(); ++i)
    if (w.liver.values[i] != 0) values.push_back(std::abs(w.image.values[i]));
  w.level = quantile(std::move(values), 0.5);
  return w;
}

/// Image minus the smooth level of the liver, taken over the voxels of where; 0 outside the liver.
image::ScalarVolume difference(const Working& w, const image::Mask& where) {
  image::ScalarVolume result = maskedMean(w.image, where, background_mm);
  for (std::size_t i = 0; i < result.values.size(); ++i)
    result.values[i] = w.liver.values[i] != 0 ? w.image.values[i] - result.values[i] : 0.0F;
  return result;
}

/// Voxels above low in parts that hold one above high.
image::Mask hysteresis(const image::ScalarVolume& line, double low, double high) {
  image::Mask candidate(line.grid);
  for (std::size_t i = 0; i < line.values.size(); ++i)
    candidate.values[i] = static_cast<double>(line.values[i]) > low ? 1 : 0;
  const image::Components parts = image::components(candidate);
  std::vector<bool> keep(parts.voxels.size() + 1, false);
  for (std::size_t i = 0; i < line.values.size(); ++i)
    if (static_cast<double>(line.values[i]) > high) keep[static_cast<std::size_t>(parts.labels.values[i])] = true;
  keep[0] = false;
  for (std::size_t i = 0; i < line.values.size(); ++i)
    candidate.values[i] = keep[static_cast<std::size_t>(parts.labels.values[i])] ? 1 : 0;
  return candidate;
}

/// Drops parts that are too small, too short or too faint.
image::Mask selected(const image::Mask& mask, const image::ScalarVolume& above, double contrast,
                     const VesselOptions& options) {
  const image::Components parts = image::components(mask);
  const std::size_t n = parts.voxels.size();
  std::vector<double> sum(n + 1, 0.0);
  std::vector<Eigen::Vector3i> low(n + 1, mask.grid.size), high(n + 1, -Eigen::Vector3i::Ones());
  std::size_t at = 0;
  for (int k = 0; k < mask.grid.size.z(); ++k)
    for (int j = 0; j < mask.grid.size.y(); ++j)
      for (int i = 0; i < mask.grid.size.x(); ++i, ++at) {
        const auto p = static_cast<std::size_t>(parts.labels.values[at]);
        sum[p] += static_cast<double>(above.values[at]);
        low[p] = low[p].cwiseMin(Eigen::Vector3i(i, j, k));
        high[p] = high[p].cwiseMax(Eigen::Vector3i(i, j, k));
      }
  std::vector<bool> keep(n + 1, false);
  for (std::size_t p = 1; p <= n; ++p) {
    const auto voxels = static_cast<double>(parts.voxels[p - 1]);
    const double length_mm =
        (high[p] - low[p] + Eigen::Vector3i::Ones()).cast<double>().cwiseProduct(mask.grid.spacing_mm).norm();
    keep[p] = voxels * mask.grid.voxelVolume_mm3() >= options.smallestVolume_mm3 &&
              length_mm >= options.smallestLength_mm && sum[p] / voxels > 0.25 * contrast;
  }
  image::Mask result(mask.grid);
  for (std::size_t i = 0; i < result.values.size(); ++i)
    result.values[i] = keep[static_cast<std::size_t>(parts.labels.values[i])] ? 1 : 0;
  return result;
}

image::Mask vesselVoxels(const Working& w, const image::ScalarVolume& line, VesselModel& model,
                         const VesselOptions& options) {
  const image::Mask candidates = hysteresis(line, options.low, options.high);
  image::Mask none(w.liver.grid);
  if (image::count(candidates) == 0) return none;
  const image::Mask near = image::dilate(candidates, options.largestRadius_mm);
  image::Mask liverOnly = w.liver;
  for (std::size_t i = 0; i < near.values.size(); ++i)
    if (candidates.values[i] != 0) liverOnly.values[i] = 0;
  const image::ScalarVolume above = gaussian(difference(w, liverOnly), 0.75 * w.image.grid.spacing_mm.x());
  std::vector<float> core, rest;
  for (std::size_t i = 0; i < line.values.size(); ++i) {
    if (static_cast<double>(line.values[i]) > options.high) core.push_back(above.values[i]);
    if (liverOnly.values[i] != 0) rest.push_back(std::abs(above.values[i]));
  }
  model.contrast = quantile(std::move(core), 0.75);
  // Ridges of pure noise reach about two standard deviations; a vessel must stand clear of that.
  const double noise = 1.4826 * quantile(std::move(rest), 0.5);
  if (model.contrast <= std::max(3.0 * noise, leastContrast * w.level)) return none;
  image::Mask mask(w.liver.grid);
  for (std::size_t i = 0; i < mask.values.size(); ++i) {
    if (w.liver.values[i] == 0) continue;
    const bool bright = near.values[i] != 0 && static_cast<double>(above.values[i]) > 0.5 * model.contrast;
    const bool ridge = candidates.values[i] != 0 && static_cast<double>(line.values[i]) > options.high;
    mask.values[i] = bright || ridge ? 1 : 0;
  }
  return image::fillHoles(selected(mask, above, model.contrast, options));
}

/// Surface of the voxels together with the tubes of the centreline, none thinner than least_mm: the smooth surface of a
/// branch one voxel wide alone would break into drops or vanish, and its landmarks would hang in the air.
TriangleMesh vesselSurface(const image::Mask& mask, const Centreline& line, double least_mm) {
  image::ScalarVolume depth_mm = image::distanceToBoundary_mm(mask);
  const image::Grid& grid = mask.grid;
  const double h_mm = grid.spacing_mm.minCoeff();
  const auto ball = [&](const Eigen::Vector3d& p_lps, double radius_mm) {
    radius_mm = std::max(radius_mm, least_mm);
    const Eigen::Vector3d centre = grid.lpsToIndex(p_lps);
    const Eigen::Vector3i at = centre.array().round().cast<int>();
    const int reach = static_cast<int>(std::ceil(radius_mm / h_mm)) + 2;
    for (int k = -reach; k <= reach; ++k)
      for (int j = -reach; j <= reach; ++j)
        for (int i = -reach; i <= reach; ++i) {
          const Eigen::Vector3i voxel = at + Eigen::Vector3i(i, j, k);
          if (!grid.contains(voxel)) continue;
          const double off_mm = ((voxel.cast<double>() - centre).cwiseProduct(grid.spacing_mm)).norm();
          depth_mm.at(voxel) = std::max(depth_mm.at(voxel), static_cast<float>(radius_mm - off_mm));
        }
  };
  for (std::size_t n = 0; n < line.points_lps_mm.size(); ++n) ball(line.points_lps_mm[n], line.radius_mm[n]);
  for (const auto& [a, b] : line.edges) {
    const auto from = static_cast<std::size_t>(a), to = static_cast<std::size_t>(b);
    const Eigen::Vector3d step = line.points_lps_mm[to] - line.points_lps_mm[from];
    const int steps = static_cast<int>(std::ceil(step.norm() / (0.5 * h_mm)));
    for (int n = 1; n < steps; ++n) {
      const double t = static_cast<double>(n) / steps;
      ball(line.points_lps_mm[from] + t * step, (1.0 - t) * line.radius_mm[from] + t * line.radius_mm[to]);
    }
  }
  return isosurface(depth_mm, 0.0, 10);
}

}  // namespace

VesselModel findVessels(const image::ScalarVolume& mri, const image::Mask& liver, const VesselOptions& options,
                        const Progress& progress) {
  if (!(options.smallestRadius_mm > 0.0) || !(options.largestRadius_mm >= options.smallestRadius_mm))
    throw BadArgument("the range of vessel radii must be positive and ascending");
  VesselModel model;
  const Working w = prepare(mri, liver, options);
  const image::ScalarVolume flat = difference(w, w.liver);
  std::vector<double> sigma_mm;
  for (int s = 0; s < scales; ++s)
    sigma_mm.push_back(options.smallestRadius_mm / std::sqrt(2.0) *
                       std::pow(options.largestRadius_mm / options.smallestRadius_mm, s / (scales - 1.0)));
  const image::ScalarVolume line = vesselness(flat, w.liver, sigma_mm, progress.part(0.05, 0.7));
  progress.report(0.7, "vessels");
  model.mask = vesselVoxels(w, line, model, options);
  if (image::count(model.mask) == 0) {
    model.note = "no vessel stands out from the liver in this image";
    return model;
  }
  progress.report(0.8, "vessel centrelines");
  Centreline centreline = centrelineOf(model.mask);
  model.tree = treeOf(centreline);
  progress.report(0.9, "vessel surface");
  model.surface = vesselSurface(model.mask, centreline, options.smallestRadius_mm);
  model.centreline_lps_mm = std::move(centreline.points_lps_mm);
  model.radius_mm = std::move(centreline.radius_mm);
  model.edges = std::move(centreline.edges);
  model.note = std::to_string(image::components(model.mask).voxels.size()) + " connected vessels, " +
               std::to_string(model.tree.branches.size()) + " branches, " +
               std::to_string(model.centreline_lps_mm.size()) + " landmarks";
  progress.report(1.0, "vessels");
  return model;
}

VesselModel findVessels(const image::ScalarVolume& mri, const image::Mask& liver, const Progress& progress) {
  return findVessels(mri, liver, VesselOptions{}, progress);
}

}  // namespace glisson::anatomy
