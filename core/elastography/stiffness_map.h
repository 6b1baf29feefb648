#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/quantity.h"
#include "image/volume.h"

namespace glisson::elastography {

/// A map of stiffness with its quantity: a number without one is never compared with anything.
struct StiffnessMap {
  image::ScalarVolume values_kPa;  ///< as reported; may hold zeros or not-a-number where there is no wave
  StiffnessQuantity quantity = StiffnessQuantity::Shear;
  std::optional<image::ScalarVolume> confidence;  ///< 0 ... 1, on the same grid
  std::string frameOfReferenceUid;                ///< empty where unknown
};

/// kPa per stored unit: "Pa" (0.001), "kPa" (1), "<factor>kPa", e.g. "0.01kPa" (0.01); a space before the unit is
/// allowed. Throws BadInput for anything else, or where the factor is not a finite positive number.
double unitFactor_kPa(const std::string& unit);

/// values × unitFactor_kPa(unit).
StiffnessMap makeStiffnessMap(image::ScalarVolume values, StiffnessQuantity quantity, const std::string& unit);

/// Attaches a confidence map. fullScale is the stored value that means 1 (GE stores 0–999: 999). Empty: found from the
/// largest value (up to 1: 1; above 100 and up to 999: 999). A confidence map on another grid is sampled at the nearest
/// voxel, 0 outside. Results are clamped to 0 ... 1; values that are not finite become 0.
/// Throws BadInput where the scale cannot be told, and where values are negative.
void attachConfidence(StiffnessMap& map, const image::ScalarVolume& stored, std::optional<double> fullScale = {});

/// The same map as the other quantity: E = 2 (1 + ν) µ. Throws BadArgument where poisson is outside (−1, 0.5].
StiffnessMap toQuantity(const StiffnessMap& map, StiffnessQuantity quantity, double poisson);

/// Whether the voxel can be used: finite, > 0, and confidence at least the threshold (where there is a confidence map).
bool trusted(const StiffnessMap& map, std::size_t voxel, double confidenceThreshold);

/// trusted() for every voxel, for hatching.
image::Mask trustedMask(const StiffnessMap& map, double confidenceThreshold = defaults::confidenceThreshold);

}  // namespace glisson::elastography
