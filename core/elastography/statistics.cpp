#include "elastography/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "base/error.h"
#include "image/morphology.h"

namespace glisson::elastography {
namespace {

constexpr double leastPlausible_kPa = 0.5, mostPlausible_kPa = 15.0;  // shear modulus of a liver

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
        << " below the confidence, " << m.notPositive << " not positive, " << m.notFinite << " not finite)";
    m.warnings.push_back(few.str());
  }
}

}  // namespace

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
  const image::Mask region = options.erosion_pixels > 0 ? image::erodeInPlane(roi, options.erosion_pixels) : roi;

  Measurement m;
  m.quantity = map.quantity;
  m.poisson = options.poisson;
  const double voxelArea_mm2 = grid.spacing_mm.x() * grid.spacing_mm.y();
  const std::size_t perSlice = grid.linear(0, 0, 1);
  std::vector<double> all, slice;
  std::size_t before = 0;
  double weighted = 0.0, weights = 0.0;
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
      } else if (!trusted(map, v, options.confidenceThreshold)) {
        ++m.lowConfidence;
      } else {
        slice.push_back(static_cast<double>(value));
      }
    }
    if (inSlice == 0) continue;
    all.insert(all.end(), slice.begin(), slice.end());
    before += inSlice;
    m.slices.push_back({k, statisticsOf(slice, voxelArea_mm2)});
    m.slices.back().statistics.n_before_mask = inSlice;
    if (!slice.empty()) {
      const Statistics& s = m.slices.back().statistics;
      weighted += s.mean_kPa * s.area_mm2;
      weights += s.area_mm2;
    }
  }
  if (before == 0)
    throw BadInput("the inner region of interest is empty: an erosion by " + std::to_string(options.erosion_pixels) +
                   " pixels removes all " + std::to_string(drawn) + " voxels; take a smaller erosion");
  if (all.empty())
    throw BadInput("no voxel of the region of interest can be used: of " + std::to_string(before) + " voxels " +
                   std::to_string(m.lowConfidence) + " lie below the confidence, " + std::to_string(m.notPositive) +
                   " are not positive, " + std::to_string(m.notFinite) +
                   " are not finite; check the region, or lower the confidence threshold");
  m.pooled = statisticsOf(std::move(all), voxelArea_mm2);
  m.pooled.n_before_mask = before;
  m.areaWeightedMean_kPa = weighted / weights;
  const bool shear = map.quantity == StiffnessQuantity::Shear;
  const double mean_kPa = m.pooled.mean_kPa;
  m.shear_mean_kPa = shear ? mean_kPa : toShear(YoungsModulus::fromKPa(mean_kPa), options.poisson).kPa();
  m.youngs_mean_kPa = shear ? toYoungs(ShearModulus::fromKPa(mean_kPa), options.poisson).kPa() : mean_kPa;
  warn(m);
  return m;
}

}  // namespace glisson::elastography
