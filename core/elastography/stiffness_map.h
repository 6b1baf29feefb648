// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "base/quantity.h"
#include "image/volume.h"

namespace glisson::elastography {

/// A map of stiffness with its quantity: a number without one is never compared with anything.
struct StiffnessMap {
  image::ScalarVolume values_kPa;  ///< as reported; may hold zeros or not-a-number where there is no wave
  StiffnessQuantity quantity = StiffnessQuantity::Shear;
  std::optional<image::ScalarVolume> confidence;  ///< 0 ... 1, on the same grid
  std::optional<image::Mask> noConfidence;        ///< voxels that the confidence map says nothing about; empty: none
  std::string frameOfReferenceUid;                ///< empty where unknown
  /// Where slices lie unevenly: their heights above the first one along the normal. The grid then only stacks them:
  /// statistics hold, volumes and places between slices do not. Else empty.
  std::vector<double> unevenSlices_mm;
};

/// kPa per stored unit: "Pa" (0.001), "kPa" (1), "<factor>kPa", e.g. "0.01kPa" (0.01); a space before the unit is
/// allowed. Throws BadInput for anything else, or where the factor is not a finite positive number.
double unitFactor_kPa(const std::string& unit);

/// values × unitFactor_kPa(unit).
StiffnessMap makeStiffnessMap(image::ScalarVolume values, StiffnessQuantity quantity, const std::string& unit);

/// The largest value that counts as full confidence, and how it was found.
struct ConfidenceScale {
  double full = 1.0;
  double largest = 0.0;  ///< stored in the map
  bool guessed = false;  ///< the largest value is the full one of another scale than 0 to 1 and 0 to 999
};

/// Attaches a confidence map. fullScale is the stored value that means 1 (GE stores 0–999: 999). Empty: found from the
/// largest value: up to 1: 1; from 949 (0.95 of 999) to 999: 999; exactly 255, 1000, 1023 or 4095: that, guessed.
/// A confidence map on another grid is sampled at the nearest voxel; what it does not cover, or not by a finite value,
/// is 0 and marked in map.noConfidence. Results are clamped to 0 ... 1.
/// Throws BadInput where the scale cannot be told, and where values are negative.
ConfidenceScale attachConfidence(StiffnessMap& map, const image::ScalarVolume& stored,
                                 std::optional<double> fullScale = {});

/// What is to be told about a map's confidence: a guessed scale, and where there is none.
Diagnostics doubtsAboutConfidence(const StiffnessMap& map, const ConfidenceScale& scale);

/// The same map as the other quantity: E = 2 (1 + ν) µ. Throws BadArgument where poisson is outside (−1, 0.5].
StiffnessMap toQuantity(const StiffnessMap& map, StiffnessQuantity quantity, double poisson);

/// Whether the voxel can be used: finite, > 0, and confidence at least the threshold (where there is a confidence map).
bool trusted(const StiffnessMap& map, std::size_t voxel, double confidenceThreshold);

/// trusted() for every voxel, for hatching.
image::Mask trustedMask(const StiffnessMap& map, double confidenceThreshold = defaults::confidenceThreshold);

}  // namespace glisson::elastography
