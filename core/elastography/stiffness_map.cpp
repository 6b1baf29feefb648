#include "elastography/stiffness_map.h"

#include <algorithm>
#include <charconv>
#include <cmath>
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

void attachConfidence(StiffnessMap& map, const image::ScalarVolume& stored, std::optional<double> fullScale) {
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
  if (!fullScale) {
    if (largest <= 1.0) {
      fullScale = 1.0;
    } else if (largest > 100.0 && largest <= 999.0) {
      fullScale = 999.0;
    } else {
      std::ostringstream why;
      why << "the largest value of the confidence map is " << largest
          << ", neither a fraction (0 to 1) nor the 0 to 999 scale; say which stored value means full confidence";
      throw BadInput(why.str());
    }
  }
  if (!(*fullScale > 0.0)) throw BadInput("the full scale of a confidence map must be a positive number");
  image::ScalarVolume confidence = stored.grid.sameGeometry(map.values_kPa.grid)
                                       ? stored
                                       : image::resampleNearest(stored, map.values_kPa.grid, 0.0F);
  confidence.grid = map.values_kPa.grid;
  for (float& v : confidence.values)
    v = std::isfinite(v) ? static_cast<float>(std::clamp(static_cast<double>(v) / *fullScale, 0.0, 1.0)) : 0.0F;
  map.confidence = std::move(confidence);
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
