// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastography/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "base/error.h"
#include "image/distance.h"
#include "image/morphology.h"

namespace glisson::elastography {
namespace {

constexpr double leastPlausible_kPa = 0.5, mostPlausible_kPa = 15.0;  // shear modulus of a liver

/// Slices whose median is another order of magnitude than that of all: of another unit or scale than the others.
void tellOtherScales(Measurement& m) {
  constexpr double another = 10.0;
  constexpr std::size_t enough = 20;
  std::string slices;
  for (const SliceStatistics& s : m.slices) {
    const double ratio = s.statistics.median_kPa / m.pooled.median_kPa;
    if (s.statistics.n >= enough && (ratio > another || ratio < 1.0 / another))
      slices += (slices.empty() ? "" : ", ") + std::to_string(s.slice);
  }
  if (slices.empty()) return;
  m.diagnostics.add(DiagnosticCode::SlicesOfAnotherScale, {{"slices", slices}, {"median_kPa", m.pooled.median_kPa}});
  m.warnings.push_back(m.diagnostics.texts().back());
}

/// Many voxels of one largest value far above the others: a map's ceiling, or padding that nothing marks.
void tellCeiling(const std::vector<double>& values_kPa, Measurement& m) {
  constexpr double farAbove = 6.0, many = 0.01;
  constexpr std::int64_t enough = 10;
  const auto there = std::count(values_kPa.begin(), values_kPa.end(), m.pooled.max_kPa);
  if (there < enough || static_cast<double>(there) < many * static_cast<double>(values_kPa.size()) ||
      m.pooled.max_kPa < farAbove * m.pooled.median_kPa)
    return;
  m.diagnostics.add(DiagnosticCode::ValuesAtCeiling, {{"voxels", static_cast<std::int64_t>(there)},
                                                      {"of", static_cast<std::int64_t>(values_kPa.size())},
                                                      {"kPa", m.pooled.max_kPa}});
  m.warnings.push_back(m.diagnostics.texts().back());
}

void warn(Measurement& m) {
  const double shearPerUnit = m.shear_mean_kPa / m.pooled.mean_kPa;
  const double shearMedian_kPa = m.pooled.median_kPa * shearPerUnit;
  std::ostringstream text;
  if (shearMedian_kPa < leastPlausible_kPa || shearMedian_kPa > mostPlausible_kPa) {
    text << "the median shear modulus in the region of interest is " << shearMedian_kPa << " kPa, outside "
         << leastPlausible_kPa << " to " << mostPlausible_kPa << " kPa: Pa or kPa? Check unit and quantity of the map";
    m.warnings.push_back(text.str());
  }
  const std::size_t before = m.pooled.n_before_mask;
  if (2 * m.pooled.n < before) {
    std::ostringstream few;
    few << "only " << m.pooled.n << " of " << before << " voxels count (" << m.lowConfidence
        << " below the confidence, " << m.noConfidence << " without a confidence, " << m.notPositive
        << " not positive, " << m.notFinite << " not finite)";
    m.warnings.push_back(few.str());
  } else if (const std::size_t empty = m.notPositive + m.notFinite; empty > 0 && 100 * empty < before) {
    m.diagnostics.add(DiagnosticCode::FewVoxelsEmpty,
                      {{"voxels", static_cast<std::int64_t>(empty)}, {"of", static_cast<std::int64_t>(before)}});
  } else if (empty > 0) {
    std::ostringstream some;
    some << m.notPositive + m.notFinite << " of " << before << " voxels hold no stiffness and do not count ("
         << m.notPositive << " not positive, " << m.notFinite << " not finite)";
    m.warnings.push_back(some.str());
  }
  if (m.noConfidence > 0) {
    m.diagnostics.add(DiagnosticCode::NoConfidenceThere, {{"voxels", static_cast<std::int64_t>(m.noConfidence)},
                                                          {"of", static_cast<std::int64_t>(before)}});
    m.warnings.push_back(m.diagnostics.texts().back());
  }
  tellOtherScales(m);
}

/// The region without its rim and what is excluded; how many voxels either takes goes into m.
image::Mask innerRegion(const image::Mask& roi, const MeasureOptions& options, Measurement& m) {
  if (!(options.erosion_mm >= 0.0 && std::isfinite(options.erosion_mm)))
    throw BadArgument("an erosion must not be negative");
  image::Mask region = options.erosion_pixels > 0 ? image::erodeInPlane(roi, options.erosion_pixels) : roi;
  if (options.erosion_mm > 0.0 && image::count(region) > 0) {
    const image::ScalarVolume depth_mm = image::distanceToOutline_mm(roi);
    for (std::size_t v = 0; v < region.values.size(); ++v)
      if (static_cast<double>(depth_mm.values[v]) <= options.erosion_mm) region.values[v] = 0;
  }
  m.rim = m.drawn - image::count(region);
  if (options.exclude == nullptr) return region;
  if (!options.exclude->grid.sameGeometry(roi.grid))
    throw BadInput("what is to be excluded lies on another grid than the region of interest");
  for (std::size_t v = 0; v < region.values.size(); ++v) {
    if (options.exclude->values[v] == 0 || region.values[v] == 0) continue;
    region.values[v] = 0;
    ++m.excluded;
  }
  return region;
}

/// Of every voxel of the mask that counts; not-a-number where none does.
double meanOver(const StiffnessMap& map, const image::Mask& mask, double confidenceThreshold) {
  double sum = 0.0, n = 0.0;
  for (std::size_t v = 0; v < mask.values.size(); ++v)
    if (mask.values[v] != 0 && trusted(map, v, confidenceThreshold)) {
      sum += static_cast<double>(map.values_kPa.values[v]);
      n += 1.0;
    }
  return sum / n;
}

/// Autocorrelation of the deviations at one in-plane shift.
double correlation(const image::Grid& grid, const std::vector<double>& deviation, const image::Mask& counts,
                   double variance, int di, int dj) {
  double sum = 0.0;
  std::size_t pairs = 0;
  for (int k = 0; k < grid.size.z(); ++k)
    for (int j = std::max(0, -dj); j < std::min(grid.size.y(), grid.size.y() - dj); ++j)
      for (int i = std::max(0, -di); i < std::min(grid.size.x(), grid.size.x() - di); ++i) {
        const std::size_t a = grid.linear(i, j, k), b = grid.linear(i + di, j + dj, k);
        if (counts.values[a] == 0 || counts.values[b] == 0) continue;
        sum += deviation[a] * deviation[b];
        ++pairs;
      }
  return pairs < 8 ? 0.0 : sum / static_cast<double>(pairs) / variance;
}

double voxelArea_mm2(const image::Grid& grid) {
  return grid.spacing_mm.x() * grid.spacing_mm.y();
}

/// The voxels of a region that count.
struct Counted {
  std::vector<double> values_kPa;
  image::Mask mask;
  std::size_t before = 0;  ///< voxels of the region, counted or not
};

/// Sorts the region's voxels into those that count and those that do not, and why; gives m its slices.
Counted countVoxels(const StiffnessMap& map, const image::Mask& region, double confidenceThreshold, Measurement& m) {
  const image::Grid& grid = map.values_kPa.grid;
  const std::size_t perSlice = grid.linear(0, 0, 1);
  Counted counted;
  counted.mask = image::Mask(grid);
  std::vector<double> slice;
  for (int k = 0; k < grid.size.z(); ++k) {
    slice.clear();
    std::size_t inSlice = 0;
    for (std::size_t v = static_cast<std::size_t>(k) * perSlice; v < static_cast<std::size_t>(k + 1) * perSlice; ++v) {
      if (region.values[v] == 0) continue;
      ++inSlice;
      const float value = map.values_kPa.values[v];
      if (!std::isfinite(value)) {
        ++m.notFinite;
      } else if (value <= 0.0F) {
        ++m.notPositive;
      } else if (!trusted(map, v, confidenceThreshold)) {
        ++(map.noConfidence && map.noConfidence->values[v] != 0 ? m.noConfidence : m.lowConfidence);
      } else {
        slice.push_back(static_cast<double>(value));
        counted.mask.values[v] = 1;
      }
    }
    if (inSlice == 0) continue;
    counted.values_kPa.insert(counted.values_kPa.end(), slice.begin(), slice.end());
    counted.before += inSlice;
    m.slices.push_back({k, statisticsOf(slice, voxelArea_mm2(grid))});
    m.slices.back().statistics.n_before_mask = inSlice;
  }
  return counted;
}

/// The slices' means, each weighted by the area that counts. At least one voxel counts.
double areaWeightedMean_kPa(const std::vector<SliceStatistics>& slices) {
  double weighted = 0.0, weights = 0.0;
  for (const SliceStatistics& s : slices) {
    if (s.statistics.n == 0) continue;
    weighted += s.statistics.mean_kPa * s.statistics.area_mm2;
    weights += s.statistics.area_mm2;
  }
  return weighted / weights;
}

[[noreturn]] void refuseErosion(const MeasureOptions& options, std::size_t drawn) {
  std::ostringstream why;
  why << "the inner region of interest is empty: an erosion by " << options.erosion_pixels << " pixels and "
      << options.erosion_mm << " mm" << (options.exclude != nullptr ? " and what is excluded" : "") << " remove all "
      << drawn << " voxels; take a smaller erosion";
  throw BadInput(why.str());
}

[[noreturn]] void refuseAll(std::size_t before, const Measurement& m) {
  throw BadInput("no voxel of the region of interest can be used: of " + std::to_string(before) + " voxels " +
                 std::to_string(m.lowConfidence) + " lie below the confidence, " + std::to_string(m.noConfidence) +
                 " have no confidence value, " + std::to_string(m.notPositive) + " are not positive, " +
                 std::to_string(m.notFinite) + " are not finite; check the region, or lower the confidence threshold");
}

}  // namespace

MeanUncertainty meanUncertainty(const image::ScalarVolume& values_kPa, const image::Mask& counts) {
  const image::Grid& grid = values_kPa.grid;
  if (!counts.grid.sameGeometry(grid)) throw BadArgument("meanUncertainty: the mask lies on another grid");
  double n = 0.0, mean = 0.0, squares = 0.0;
  for (std::size_t v = 0; v < counts.values.size(); ++v)
    if (counts.values[v] != 0) {
      n += 1.0;
      mean += static_cast<double>(values_kPa.values[v]);
    }
  MeanUncertainty u;
  u.se_kPa = u.low_kPa = u.high_kPa = std::numeric_limits<double>::quiet_NaN();
  if (n < 2.0) return u;
  mean /= n;
  std::vector<double> deviation(counts.values.size(), 0.0);
  for (std::size_t v = 0; v < counts.values.size(); ++v)
    if (counts.values[v] != 0) {
      deviation[v] = static_cast<double>(values_kPa.values[v]) - mean;
      squares += deviation[v] * deviation[v];
    }
  if (squares > 0.0) {
    // Square shells of shifts; both ways of a shift are alike, so half of each shell is looked at.
    constexpr int mostShells = 12;
    for (int shell = 1; shell <= mostShells; ++shell) {
      double sum = 0.0;
      for (int dj = 0; dj <= shell; ++dj)
        for (int di = -shell; di <= shell; ++di) {
          if (std::max(dj, std::abs(di)) != shell || (dj == 0 && di < 0)) continue;
          sum += 2.0 * correlation(grid, deviation, counts, squares / n, di, dj);
        }
      if (sum < 0.1 * 8.0 * shell) break;
      u.correlatedVoxels += sum;
    }
    u.correlatedVoxels = std::clamp(u.correlatedVoxels, 1.0, n);
  }
  u.se_kPa = std::sqrt(squares / (n - 1.0) * u.correlatedVoxels / n);
  u.low_kPa = mean - 1.96 * u.se_kPa;
  u.high_kPa = mean + 1.96 * u.se_kPa;
  return u;
}

Statistics statisticsOf(std::vector<double> values_kPa, double voxelArea_mm2) {
  Statistics s;
  s.n = s.n_before_mask = values_kPa.size();
  s.area_mm2 = static_cast<double>(s.n) * voxelArea_mm2;
  if (values_kPa.empty()) {
    s.mean_kPa = s.median_kPa = s.sd_kPa = s.min_kPa = s.max_kPa = std::numeric_limits<double>::quiet_NaN();
    return s;
  }
  const auto n = static_cast<double>(s.n);
  std::sort(values_kPa.begin(), values_kPa.end());
  double sum = 0.0;
  for (const double v : values_kPa) sum += v;
  s.mean_kPa = sum / n;
  double squares = 0.0;
  for (const double v : values_kPa) squares += (v - s.mean_kPa) * (v - s.mean_kPa);
  s.sd_kPa = s.n > 1 ? std::sqrt(squares / (n - 1.0)) : std::numeric_limits<double>::quiet_NaN();
  s.median_kPa = 0.5 * (values_kPa[(s.n - 1) / 2] + values_kPa[s.n / 2]);
  s.min_kPa = values_kPa.front();
  s.max_kPa = values_kPa.back();
  return s;
}

Measurement measure(const StiffnessMap& map, const image::Mask& roi, const MeasureOptions& options) {
  const image::Grid& grid = map.values_kPa.grid;
  if (!roi.grid.sameGeometry(grid))
    throw BadInput(
        "the region of interest lies on another grid than the stiffness map; map it onto the stiffness map first");
  if (!(options.poisson > -1.0 && options.poisson <= 0.5))
    throw BadInput("a Poisson ratio of " + std::to_string(options.poisson) +
                   "; it must lie above -1 and at most at 0.5");
  const std::size_t drawn = image::count(roi);
  if (drawn == 0) throw BadInput("the region of interest holds no voxel of the stiffness map");
  Measurement m;
  m.drawn = drawn;
  const image::Mask region = innerRegion(roi, options, m);
  m.quantity = map.quantity;
  m.poisson = options.poisson;
  const Counted counted = countVoxels(map, region, options.confidenceThreshold, m);
  if (counted.before == 0) refuseErosion(options, drawn);
  if (counted.values_kPa.empty()) refuseAll(counted.before, m);
  m.pooled = statisticsOf(counted.values_kPa, voxelArea_mm2(grid));
  m.pooled.n_before_mask = counted.before;
  m.uncertainty = meanUncertainty(map.values_kPa, counted.mask);
  m.interval = meanInterval(map.values_kPa, counted.mask);
  m.areaWeightedMean_kPa = areaWeightedMean_kPa(m.slices);
  m.meanOfAll_kPa = m.rim + m.excluded > 0 ? meanOver(map, roi, options.confidenceThreshold) : m.pooled.mean_kPa;
  const bool shear = map.quantity == StiffnessQuantity::Shear;
  const double mean_kPa = m.pooled.mean_kPa;
  m.shear_mean_kPa = shear ? mean_kPa : toShear(YoungsModulus::fromKPa(mean_kPa), options.poisson).kPa();
  m.youngs_mean_kPa = shear ? toYoungs(ShearModulus::fromKPa(mean_kPa), options.poisson).kPa() : mean_kPa;
  warn(m);
  tellCeiling(counted.values_kPa, m);
  return m;
}

}  // namespace glisson::elastography
