// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

namespace glisson {

/// What a unit of a stiffness map measures, and how much one of it is.
struct MapUnit {
  enum class Of { Modulus, Speed } of = Of::Modulus;
  double factor = 1.0;  ///< kPa for a modulus, m/s for a wave speed
};

/// Reads the unit of a stiffness map as files write it: "Pa", "kPa" and their kin ("N/m2", "kilopascal", "MPa"), wave
/// speeds ("m/s", "mm/s"), each with an optional positive factor before it ("0.01kPa"). Empty for everything else.
std::optional<MapUnit> mapUnit(const std::string& text);

/// The same unit in the words that the rest of the program knows: "Pa", "kPa", "<factor>kPa", "m/s", "<factor>m/s". A
/// text that is no such unit is returned as it is.
std::string canonicalUnit(const std::string& text);

}  // namespace glisson
