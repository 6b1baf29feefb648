// SPDX-License-Identifier: GPL-3.0-or-later
#include "roi/propose.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <vector>

#include "base/error.h"
#include "image/components.h"
#include "image/distance.h"
#include "image/morphology.h"
#include "image/resample.h"
#include "roi/detail/cell_masks.h"
#include "roi/detail/coarse.h"

namespace glisson::roi {
namespace {

using detail::boxAround;
using detail::boxOf;
using detail::closed;
using detail::eroded;
using detail::keepWithin;
using detail::LocalMean;
using detail::nearestOf;
using detail::partWith;
using detail::putBack;
using detail::volume_mL;

/// SD of an organ's texture, of the span between dark and bright tissue.
constexpr double leastTexture = 0.04, mostTexture = 0.12;

double medianOf(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Median and robust standard deviation (1.4826 × median deviation); empties the values of their order.
struct Robust {
  double middle = 0.0, sd = 0.0;
};
Robust robust(std::vector<double>& values) {
  Robust r;
  if (values.empty()) return r;
  r.middle = medianOf(values);
  for (double& v : values) v = std::abs(v - r.middle);
  r.sd = 1.4826 * medianOf(values);
  return r;
}

/// What divides two classes of values best [otsu1979].
double otsu(const std::vector<float>& values, double low, double high) {
  constexpr int bins = 256;
  std::vector<double> histogram(bins, 0.0);
  for (const float v : values)
    histogram[static_cast<std::size_t>(
        std::clamp((static_cast<double>(v) - low) / (high - low) * bins, 0.0, bins - 1.0))] += 1.0;
  double all = 0.0, sum = 0.0;
  for (int b = 0; b < bins; ++b) {
    all += histogram[static_cast<std::size_t>(b)];
    sum += b * histogram[static_cast<std::size_t>(b)];
  }
  double below = 0.0, sumBelow = 0.0, best = -1.0;
  int at = 0;
  for (int b = 0; b + 1 < bins; ++b) {
    below += histogram[static_cast<std::size_t>(b)];
    sumBelow += b * histogram[static_cast<std::size_t>(b)];
    if (below <= 0.0 || below >= all) continue;
    const double apart = sumBelow / below - (sum - sumBelow) / (all - below);
    if (const double between = below * (all - below) * apart * apart; between > best) {
      best = between;
      at = b;
    }
  }
  return low + (at + 1) * (high - low) / bins;
}

/// The cells that growing works on, and what is known of their values.
struct Scene {
  image::ScalarVolume cells;
  double air = 0.0;   ///< cells below hold no tissue
  double span = 0.0;  ///< between dark and bright tissue (10th and 90th percentile)
};

Scene sceneOf(const image::ScalarVolume& image, const ProposalOptions& options) {
  Scene s;
  s.cells = detail::blockMeans(image, options.edge_mm);
  if (options.smoothing_mm > 0.0) s.cells = detail::medianSmoothed(s.cells, options.smoothing_mm);
  std::vector<float> sorted = s.cells.values;
  std::sort(sorted.begin(), sorted.end());
  const auto part = [](const std::vector<float>& v, double p) {
    return static_cast<double>(v[static_cast<std::size_t>(p * static_cast<double>(v.size() - 1))]);
  };
  const double low = part(sorted, 0.01), high = part(sorted, 0.99);
  if (!(high > low)) throw BadInput("the image is the same everywhere: nothing can be told apart in it");
  // Hounsfield units have a scale: air is at -1000. Elsewhere air is what is dark even among the dark half.
  s.air = -300.0;
  if (low > -500.0) {
    const auto middle = static_cast<float>(otsu(s.cells.values, low, high));
    std::vector<float> dark(sorted.begin(), std::lower_bound(sorted.begin(), sorted.end(), middle));
    s.air = otsu(dark, low, static_cast<double>(middle));
  }
  const std::vector<float> tissue(std::lower_bound(sorted.begin(), sorted.end(), static_cast<float>(s.air)),
                                  sorted.end());
  s.span = part(tissue, 0.9) - part(tissue, 0.1);
  return s;
}

std::vector<double> valuesAround(const Scene& s, const Eigen::Vector3i& at, double radius_mm) {
  const image::Grid& grid = s.cells.grid;
  const Eigen::Vector3i reach = (radius_mm / grid.spacing_mm.array()).ceil().cast<int>();
  std::vector<double> values;
  for (int k = -reach.z(); k <= reach.z(); ++k)
    for (int j = -reach.y(); j <= reach.y(); ++j)
      for (int i = -reach.x(); i <= reach.x(); ++i) {
        const Eigen::Vector3i offset(i, j, k);
        if (grid.spacing_mm.cwiseProduct(offset.cast<double>()).norm() <= radius_mm && grid.contains(at + offset))
          values.push_back(static_cast<double>(s.cells.at(at + offset)));
      }
  return values;
}

/// Cuts what is thinner than twice neck_mm and keeps the part at the seed. Empty where nothing is thick there.
image::Mask opened(const image::Mask& similar, double neck_mm, const Eigen::Vector3i& seed, double reach_mm) {
  const image::Mask filled = image::fillHoles(similar);
  image::Mask core = eroded(filled, neck_mm);
  if (image::count(core) == 0) return core;
  const auto [root, away_mm] = nearestOf(core, seed);
  if (away_mm > reach_mm) return image::Mask(similar.grid);
  core = partWith(core, root);
  image::Mask organ = image::dilate(core, neck_mm * 1.05);
  keepWithin(organ, filled);
  return organ;
}

struct Grown {
  image::Mask mask;
  double middle = 0.0, sd = 0.0;  ///< accepted at the seed
};

/// Cells like those around the seed, first by their own values, then by the local mean of what was found.
Grown grow(const Scene& s, const Eigen::Vector3i& seed, const Robust& around, const ProposalOptions& options,
           const Progress& progress) {
  constexpr double sigma_mm = 20.0;
  constexpr double reach_mm = 30.0;  // that it may grow in a round
  constexpr int rounds = 20;
  const image::Grid& grid = s.cells.grid;
  const double leastSd = leastTexture * s.span, mostSd = mostTexture * s.span;
  double sd = std::clamp(around.sd, leastSd, mostSd);
  image::Mask organ(grid);
  Grown result{image::Mask(grid), around.middle, sd};
  for (int k = 0; k < grid.size.z(); ++k)
    for (int j = 0; j < grid.size.y(); ++j)
      for (int i = 0; i < grid.size.x(); ++i) {
        const Eigen::Vector3i at(i, j, k);
        const double value = static_cast<double>(s.cells.at(at));
        if (grid.spacing_mm.cwiseProduct((at - seed).cast<double>()).norm() <= 25.0 && value > s.air &&
            std::abs(value - around.middle) <= options.spread * sd)
          organ.at(at) = 1;
      }
  organ = opened(organ, 0.5 * options.neck_mm, seed, 2.0 * options.neck_mm);
  if (image::count(organ) == 0) return result;
  std::size_t before = 0;
  for (int round = 0; round < rounds; ++round) {
    progress.check();
    const auto [first, box] = boxAround(organ, reach_mm);
    const image::ScalarVolume cells = boxOf(s.cells, first, box);
    const image::Mask old = boxOf(organ, first, box);
    const Eigen::Vector3i root = seed - first;
    const LocalMean local = detail::localMean(cells, old, sigma_mm);
    // The texture of the organ, vessels that run through it included: they are few enough for robust figures.
    const image::Mask inside = eroded(image::fillHoles(closed(old, options.closing_mm)), options.neck_mm);
    std::vector<double> texture;
    for (std::size_t v = 0; v < inside.values.size(); ++v)
      if (inside.values[v] != 0)
        texture.push_back(static_cast<double>(cells.values[v]) - static_cast<double>(local.mean.values[v]));
    if (texture.size() > 50) sd = std::clamp(robust(texture).sd, leastSd, mostSd);
    image::Mask similar(box);
    for (std::size_t v = 0; v < similar.values.size(); ++v) {
      const auto value = static_cast<double>(cells.values[v]), mean = static_cast<double>(local.mean.values[v]);
      similar.values[v] =
          local.weight.values[v] > 1e-3F && value > s.air && std::abs(value - mean) <= options.spread * sd ? 1 : 0;
    }
    const image::Mask next = opened(similar, 0.6 * options.neck_mm, root, 2.0 * options.neck_mm);
    const std::size_t now = image::count(next);
    if (now == 0) break;
    organ = putBack(next, first, grid);
    result.middle = static_cast<double>(local.mean.at(root));
    if (std::abs(static_cast<double>(now) - static_cast<double>(before)) < 0.005 * static_cast<double>(now)) break;
    before = now;
  }
  result.sd = sd;
  const auto [first, box] = boxAround(organ, reach_mm);
  const image::Mask full = opened(closed(boxOf(organ, first, box), options.closing_mm), options.neck_mm, seed - first,
                                  2.0 * options.neck_mm);
  result.mask = putBack(image::fillHoles(closed(full, options.closing_mm)), first, grid);
  return result;
}

/// Cells in reach whose value is not that of the seed's surroundings: the densest of them, and where the nearest lie.
std::optional<Eigen::Vector3i> otherTissue(const Scene& s, const Eigen::Vector3i& seed, const Robust& around,
                                           double spread) {
  constexpr double reach_mm = 25.0, width = 0.08;
  const double apart = spread * std::max(around.sd, width * s.span / 2.0);
  std::vector<double> values;
  for (const double v : valuesAround(s, seed, reach_mm))
    if (v > s.air && std::abs(v - around.middle) > apart) values.push_back(v);
  if (values.size() < 20) return {};
  std::sort(values.begin(), values.end());
  double middle = values.front();
  for (std::size_t low = 0, high = 0, most = 0; low < values.size(); ++low) {
    while (high < values.size() && values[high] <= values[low] + width * s.span) ++high;
    if (high - low > most) {
      most = high - low;
      middle = values[low + most / 2];
    }
  }
  image::Mask like(s.cells.grid);
  for (std::size_t v = 0; v < like.values.size(); ++v)
    like.values[v] = std::abs(static_cast<double>(s.cells.values[v]) - middle) <= width * s.span ? 1 : 0;
  const auto [cell, away_mm] = nearestOf(eroded(like, s.cells.grid.spacing_mm.head<2>().maxCoeff()), seed);
  if (away_mm > reach_mm) return {};
  return cell;
}

/// The most even cell in reach with the value of the seed itself.
std::optional<Eigen::Vector3i> evenTissue(const Scene& s, const Eigen::Vector3i& seed, const Robust&, double spread) {
  constexpr double reach_mm = 15.0, radius_mm = 6.0;
  const image::Grid& grid = s.cells.grid;
  const auto own = static_cast<double>(s.cells.at(seed));
  const Eigen::Vector3i reach = (reach_mm / grid.spacing_mm.array()).floor().cast<int>();
  std::optional<Eigen::Vector3i> best;
  double least = 1e300;
  for (int k = -reach.z(); k <= reach.z(); ++k)
    for (int j = -reach.y(); j <= reach.y(); ++j)
      for (int i = -reach.x(); i <= reach.x(); ++i) {
        const Eigen::Vector3i at = seed + Eigen::Vector3i(i, j, k);
        if (!grid.contains(at)) continue;
        std::vector<double> values = valuesAround(s, at, radius_mm);
        const Robust here = robust(values);
        if (here.middle > s.air && std::abs(here.middle - own) <= spread * leastTexture * s.span && here.sd < least) {
          least = here.sd;
          best = at;
        }
      }
  return best;
}

std::string rounded(double value) {
  return std::to_string(static_cast<long>(std::lround(value)));
}

}  // namespace

Proposal propose(const image::ScalarVolume& image, const Eigen::Vector3d& seed_lps, const ProposalOptions& options,
                 const Progress& progress) {
  if (!image::voxelAt(image.grid, seed_lps)) {
    std::ostringstream why;
    why << "the seed (" << seed_lps.transpose() << ") mm lies outside the image; click inside the organ";
    throw BadInput(why.str());
  }
  progress.report(0.0, "smoothing");
  const Scene scene = sceneOf(image, options);
  const image::Grid& grid = scene.cells.grid;
  const Eigen::Vector3i seed = grid.lpsToIndex(seed_lps).array().round().cast<int>().max(0).min(grid.size.array() - 1);
  std::vector<double> values = valuesAround(scene, seed, options.seedRadius_mm);
  const Robust around = robust(values);
  if (around.middle < scene.air)
    throw BadInput("the seed lies in air: there is no signal around it; click inside the organ");
  progress.report(0.3, "growing from the seed");
  Proposal result;
  Grown grown = grow(scene, seed, around, options, progress);
  // A click beside or into a vessel: the even tissue next to it is meant, else the tissue that surrounds the vessel.
  for (const auto& find : {evenTissue, otherTissue}) {
    if (volume_mL(grown.mask) >= options.least_mL) break;
    const auto other = find(scene, seed, around, options.spread);
    if (!other) continue;
    values = valuesAround(scene, *other, options.seedRadius_mm);
    Grown second = grow(scene, *other, robust(values), options, progress);
    constexpr double beside_mm = 6.0;
    const double mL = volume_mL(second.mask);
    if (mL < options.least_mL || mL > options.most_mL || nearestOf(second.mask, seed).second > beside_mm) continue;
    const double moved_mm = grid.spacing_mm.cwiseProduct((*other - seed).cast<double>()).norm();
    result.notes.push_back("the seed lies in or beside a vessel or another thing smaller than an organ: the tissue " +
                           rounded(moved_mm) + " mm away was taken");
    grown = std::move(second);
  }
  const double grown_mL = volume_mL(grown.mask);
  if (image::count(grown.mask) == 0 || grown_mL < options.least_mL)
    throw BadInput(
        "only " + rounded(grown_mL) +
        " mL grow from the seed, less than an organ: it lies in a vessel or in something thin or small; click "
        "inside the organ, away from vessels");
  if (grown_mL > options.most_mL)
    throw BadInput(rounded(grown_mL) + " mL grow from the seed, more than an organ of at most " +
                   rounded(options.most_mL) + " mL: it leaks into its surroundings; click elsewhere in the organ or " +
                   "accept fewer intensities (a smaller spread)");
  result.low = grown.middle - options.spread * grown.sd;
  result.high = grown.middle + options.spread * grown.sd;
  // A cell on the border was taken where about three quarters of it or more are organ: on average the border lies a
  // quarter of a cell further out.
  result.mask = detail::refined(grown.mask, image.grid, 0.25 * grid.spacing_mm.head<2>().mean());
  result.volume_mL = volume_mL(result.mask);
  result.touchesBorder = detail::touchesBorder(result.mask);
  progress.report(1.0, "proposed");
  return result;
}

}  // namespace glisson::roi
