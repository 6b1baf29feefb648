// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastography/stiffness_map.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>

#include "base/error.h"
#include "image/resample.h"

namespace glisson::elastography {

double unitFactor_kPa(const std::string& unit) {
  if (unit == "Pa") return 1e-3;
  if (unit == "kPa") return 1.0;
  const std::string suffix = "kPa";
  if (unit.size() > suffix.size() && unit.ends_with(suffix)) {
    const char* end = unit.data() + unit.size() - suffix.size();
    double factor = 0.0;
    const auto [stop, error] = std::from_chars(unit.data(), end, factor);
    const bool whole = stop == end || (stop + 1 == end && *stop == ' ');
    if (error == std::errc() && whole && std::isfinite(factor) && factor > 0.0) return factor;
  }
  throw BadInput("the unit of the stiffness map is '" + unit.substr(0, 32) +
                 "'; it must be Pa, kPa or <factor>kPa with a positive factor, e.g. 0.01kPa");
}

StiffnessMap makeStiffnessMap(image::ScalarVolume values, StiffnessQuantity quantity, const std::string& unit) {
  const double factor = unitFactor_kPa(unit);
  StiffnessMap map;
  map.values_kPa = std::move(values);
  map.quantity = quantity;
  if (factor != 1.0)
    for (float& v : map.values_kPa.values) v = static_cast<float>(factor * static_cast<double>(v));
  return map;
}

namespace {

/// Largest values that are the full one of a scale in themselves: 8 bits, per mille, 10 and 12 bits.
constexpr double wholeScales[] = {255.0, 1000.0, 1023.0, 4095.0};

ConfidenceScale scaleOf(double largest, std::optional<double> fullScale) {
  if (fullScale) {
    if (!(*fullScale > 0.0)) throw BadInput("the full scale of a confidence map must be a positive number");
    return {*fullScale, largest, false};
  }
  if (largest <= 1.0) return {1.0, largest, false};
  if (largest >= defaults::confidenceThreshold * 999.0 && largest <= 999.0) return {999.0, largest, false};
  for (const double whole : wholeScales)
    if (largest == whole) return {whole, largest, true};
  std::ostringstream why;
  why << "the largest value of the confidence map is " << largest
      << ", the full one of none of the known scales (0 to 1, 0 to 999); say which stored value means full confidence "
         "(--confidence-scale), or give the confidence as fractions";
  throw BadInput(why.str());
}

}  // namespace

ConfidenceScale attachConfidence(StiffnessMap& map, const image::ScalarVolume& stored,
                                 std::optional<double> fullScale) {
  double largest = 0.0;
  for (const float value : stored.values) {
    if (!std::isfinite(value)) continue;
    if (value < 0.0F) {
      std::ostringstream why;
      why << "the confidence map holds the negative value " << value << "; this is no confidence map";
      throw BadInput(why.str());
    }
    largest = std::max(largest, static_cast<double>(value));
  }
  const ConfidenceScale scale = scaleOf(largest, fullScale);
  constexpr float none = std::numeric_limits<float>::quiet_NaN();
  image::ScalarVolume confidence = stored.grid.sameGeometry(map.values_kPa.grid)
                                       ? stored
                                       : image::resampleNearest(stored, map.values_kPa.grid, none);
  confidence.grid = map.values_kPa.grid;
  image::Mask missing(confidence.grid);
  bool any = false;
  for (std::size_t v = 0; v < confidence.values.size(); ++v) {
    float& value = confidence.values[v];
    if (std::isfinite(value)) {
      value = static_cast<float>(std::clamp(static_cast<double>(value) / scale.full, 0.0, 1.0));
    } else {
      value = 0.0F;
      missing.values[v] = 1;
      any = true;
    }
  }
  map.confidence = std::move(confidence);
  map.noConfidence.reset();
  if (any) map.noConfidence = std::move(missing);
  return scale;
}

Diagnostics doubtsAboutConfidence(const StiffnessMap& map, const ConfidenceScale& scale) {
  Diagnostics doubts;
  if (scale.guessed)
    doubts.add(DiagnosticCode::ConfidenceScaleTaken, {{"largest", scale.largest}, {"scale", scale.full}});
  if (!map.noConfidence) return doubts;
  const image::Mask& missing = *map.noConfidence;
  const std::size_t perSlice = missing.grid.linear(0, 0, 1);
  std::size_t without = 0;
  std::string slices;
  for (int k = 0; k < missing.grid.size.z(); ++k) {
    const auto begin = missing.values.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(k) * perSlice);
    const auto here =
        static_cast<std::size_t>(std::count(begin, begin + static_cast<std::ptrdiff_t>(perSlice), std::uint8_t{1}));
    without += here;
    if (here == perSlice) slices += (slices.empty() ? "" : ", ") + std::to_string(k);
  }
  const double covered = 100.0 * (1.0 - static_cast<double>(without) / static_cast<double>(missing.values.size()));
  doubts.add(DiagnosticCode::ConfidenceCoversLess,
             {{"percent", covered}, {"slices", slices.empty() ? std::string("none") : slices}});
  return doubts;
}

StiffnessMap toQuantity(const StiffnessMap& map, StiffnessQuantity quantity, double poisson) {
  if (!(poisson > -1.0 && poisson <= 0.5))
    throw BadArgument("a Poisson ratio of " + std::to_string(poisson) + "; it must lie above -1 and at most at 0.5");
  StiffnessMap result = map;
  result.quantity = quantity;
  if (map.quantity == quantity) return result;
  const double factor = quantity == StiffnessQuantity::Youngs ? toYoungs(ShearModulus::fromKPa(1.0), poisson).kPa()
                                                              : toShear(YoungsModulus::fromKPa(1.0), poisson).kPa();
  for (float& v : result.values_kPa.values) v = static_cast<float>(factor * static_cast<double>(v));
  return result;
}

bool trusted(const StiffnessMap& map, std::size_t voxel, double confidenceThreshold) {
  const float value = map.values_kPa.values[voxel];
  if (!std::isfinite(value) || value <= 0.0F) return false;
  return !map.confidence || map.confidence->values[voxel] >= static_cast<float>(confidenceThreshold);
}

image::Mask trustedMask(const StiffnessMap& map, double confidenceThreshold) {
  image::Mask result(map.values_kPa.grid);
  for (std::size_t i = 0; i < result.values.size(); ++i)
    result.values[i] = trusted(map, i, confidenceThreshold) ? 1 : 0;
  return result;
}

}  // namespace glisson::elastography
