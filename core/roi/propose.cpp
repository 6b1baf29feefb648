#include "roi/propose.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "image/components.h"
#include "image/morphology.h"
#include "image/resample.h"

namespace glisson::roi {
namespace {

std::vector<Eigen::Vector3i> ball(const image::Grid& grid, double radius_mm) {
  std::vector<Eigen::Vector3i> result;
  const Eigen::Vector3i reach = (radius_mm / grid.spacing_mm.array()).ceil().cast<int>();
  for (int k = -reach.z(); k <= reach.z(); ++k)
    for (int j = -reach.y(); j <= reach.y(); ++j)
      for (int i = -reach.x(); i <= reach.x(); ++i)
        if (grid.spacing_mm.cwiseProduct(Eigen::Vector3d(i, j, k)).norm() <= radius_mm) result.emplace_back(i, j, k);
  return result;
}

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<double> valuesAround(const image::ScalarVolume& image, const Eigen::Vector3i& at,
                                 const std::vector<Eigen::Vector3i>& offsets) {
  std::vector<double> values;
  for (const Eigen::Vector3i& offset : offsets)
    if (image.grid.contains(at + offset) && std::isfinite(image.at(at + offset)))
      values.push_back(static_cast<double>(image.at(at + offset)));
  return values;
}

/// Median in a ball: noise goes, edges stay.
image::ScalarVolume smoothed(const image::ScalarVolume& image, double radius_mm, const Progress& progress) {
  // At least the neighbours in the slice: a ball smaller than the pixels would do nothing.
  const double least_mm = image.grid.spacing_mm.head<2>().maxCoeff();
  const std::vector<Eigen::Vector3i> offsets = ball(image.grid, std::max(radius_mm, least_mm));
  image::ScalarVolume result(image.grid);
  const auto slices = static_cast<std::size_t>(image.grid.size.z());
  parallelChunks(slices, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      for (int j = 0; j < image.grid.size.y(); ++j) {
        progress.check();
        for (int i = 0; i < image.grid.size.x(); ++i) {
          const Eigen::Vector3i at(i, j, static_cast<int>(k));
          std::vector<double> values = valuesAround(image, at, offsets);
          result.at(at) = values.empty() ? 0.0F : static_cast<float>(median(values));
        }
      }
  });
  return result;
}

/// The part that hangs together with the voxel, or nothing where it is outside.
image::Mask partWith(const image::Mask& mask, const Eigen::Vector3i& voxel) {
  image::Mask result(mask.grid);
  const image::Components parts = image::components(mask);
  const std::int32_t label = parts.labels.at(voxel);
  if (label == 0) return result;
  for (std::size_t v = 0; v < result.values.size(); ++v) result.values[v] = parts.labels.values[v] == label ? 1 : 0;
  return result;
}

void keepWithin(image::Mask& mask, const image::Mask& limit) {
  for (std::size_t v = 0; v < mask.values.size(); ++v)
    if (limit.values[v] == 0) mask.values[v] = 0;
}

/// The voxel of mask nearest to at; at itself where it is inside.
Eigen::Vector3i nearestOf(const image::Mask& mask, const Eigen::Vector3i& at) {
  Eigen::Vector3i best = at;
  double nearest_mm = 1e300;
  for (int k = 0; k < mask.grid.size.z(); ++k)
    for (int j = 0; j < mask.grid.size.y(); ++j)
      for (int i = 0; i < mask.grid.size.x(); ++i) {
        if (mask.at(i, j, k) == 0) continue;
        const double d_mm = mask.grid.spacing_mm.cwiseProduct((Eigen::Vector3i(i, j, k) - at).cast<double>()).norm();
        if (d_mm < nearest_mm) {
          nearest_mm = d_mm;
          best = {i, j, k};
        }
      }
  return best;
}

bool touches(const image::Mask& mask) {
  const Eigen::Vector3i n = mask.grid.size;
  for (int k = 0; k < n.z(); ++k)
    for (int j = 0; j < n.y(); ++j)
      for (int i = 0; i < n.x(); ++i)
        if (mask.at(i, j, k) != 0 && (i == 0 || j == 0 || k == 0 || i == n.x() - 1 || j == n.y() - 1 || k == n.z() - 1))
          return true;
  return false;
}

/// The mask with a border of outside voxels, so that closing does not stick to the border of the image.
image::Mask padded(const image::Mask& mask, int by, std::uint8_t fill) {
  image::Grid grid = mask.grid;
  grid.size.array() += 2 * by;
  grid.origin_lps_mm = mask.grid.indexToLps(Eigen::Vector3d::Constant(-by));
  image::Mask result(grid, fill);
  for (int k = 0; k < mask.grid.size.z(); ++k)
    for (int j = 0; j < mask.grid.size.y(); ++j)
      for (int i = 0; i < mask.grid.size.x(); ++i) result.at(i + by, j + by, k + by) = mask.at(i, j, k);
  return result;
}

image::Mask cropped(const image::Mask& mask, const image::Grid& grid, int by) {
  image::Mask result(grid);
  for (int k = 0; k < grid.size.z(); ++k)
    for (int j = 0; j < grid.size.y(); ++j)
      for (int i = 0; i < grid.size.x(); ++i) result.at(i, j, k) = mask.at(i + by, j + by, k + by);
  return result;
}

}  // namespace

Proposal propose(const image::ScalarVolume& image, const Eigen::Vector3d& seed_lps, const ProposalOptions& options,
                 const Progress& progress) {
  const image::Grid& grid = image.grid;
  const auto seed = image::voxelAt(grid, seed_lps);
  if (!seed) {
    std::ostringstream why;
    why << "the seed (" << seed_lps.transpose() << ") mm lies outside the image; click inside the organ";
    throw BadInput(why.str());
  }
  progress.report(0.0, "smoothing");
  const image::ScalarVolume smooth =
      options.smoothing_mm > 0.0 ? smoothed(image, options.smoothing_mm, progress) : image;
  progress.report(0.4, "growing from the seed");
  std::vector<double> around = valuesAround(smooth, *seed, ball(grid, options.seedRadius_mm));
  if (around.empty()) throw BadInput("the image holds no finite value at the seed");
  const double middle = median(around);
  for (double& v : around) v = std::abs(v - middle);
  // 1.4826 × median deviation is the SD of a normal distribution; a flat neighbourhood still needs some room.
  const double sd = std::max(1.4826 * median(around), 0.02 * std::abs(middle));
  Proposal result;
  result.low = middle - options.spread * sd;
  result.high = middle + options.spread * sd;
  image::Mask similar(grid);
  for (std::size_t v = 0; v < similar.values.size(); ++v) {
    const auto value = static_cast<double>(smooth.values[v]);
    similar.values[v] = value >= result.low && value <= result.high ? 1 : 0;
  }
  // Beyond the image counts as inside here, so that an organ cut by the field of view is not eroded there.
  const int margin =
      static_cast<int>(std::ceil(2.0 * std::max(options.neck_mm, options.closing_mm) / grid.spacing_mm.minCoeff())) + 1;
  const image::Mask filled = image::fillHoles(similar);
  image::Mask core = cropped(image::erode(padded(filled, margin, 1), options.neck_mm), grid, margin);
  if (image::count(core) == 0)
    throw BadInput("nothing as thick as an organ grows from the seed; click inside the organ, away from vessels");
  progress.report(0.6, "cutting bridges");
  const Eigen::Vector3i root = nearestOf(core, *seed);
  if (grid.spacing_mm.cwiseProduct((root - *seed).cast<double>()).norm() > 2.0 * options.neck_mm)
    throw BadInput("the seed lies in something thinner than an organ; click inside the organ, away from vessels");
  core = partWith(core, root);
  image::Mask organ = image::dilate(core, options.neck_mm * 1.05);
  keepWithin(organ, filled);
  progress.report(0.8, "closing gaps");
  image::Mask closed = image::erode(image::dilate(padded(organ, margin, 0), options.closing_mm), options.closing_mm);
  result.mask = image::fillHoles(partWith(cropped(closed, grid, margin), root));
  result.volume_mL = 1e-3 * grid.voxelVolume_mm3() * static_cast<double>(image::count(result.mask));
  result.touchesBorder = touches(result.mask);
  progress.report(1.0, "proposed");
  return result;
}

}  // namespace glisson::roi
