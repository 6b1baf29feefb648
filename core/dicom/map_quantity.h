// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

namespace glisson::dicom {

/// What the values of a map are a measure of, as far as a file says it.
enum class MapQuantity { ShearModulus, YoungsModulus, WaveSpeed, Other };

/// In words: "the shear modulus", "Young's modulus", "the wave speed", "another quantity".
std::string inWords(MapQuantity quantity);

/// The quantity that a code of a QuantityDefinitionSequence names: by its value where it is one of ours, else by its
/// meaning. Other where it names something that is no stiffness.
MapQuantity quantityOfCode(const std::string& scheme, const std::string& value, const std::string& meaning);

/// The quantity that a description names; empty where its words name none.
std::optional<MapQuantity> quantityInWords(const std::string& description);

}  // namespace glisson::dicom
