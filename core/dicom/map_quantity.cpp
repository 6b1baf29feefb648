// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/map_quantity.h"

#include <algorithm>
#include <initializer_list>

#include "base/text.h"

namespace glisson::dicom {
namespace {

bool holdsAny(const std::string& text, std::initializer_list<const char*> words) {
  return std::any_of(words.begin(), words.end(), [&](const char* w) { return text.find(w) != std::string::npos; });
}

/// Underscores and hyphens are spaces of a kind.
std::string spaced(std::string text) {
  text = lowerCase(std::move(text));
  for (char& c : text)
    if (c == '_' || c == '-' || c == '\\' || c == '(' || c == ')' || c == ',') c = ' ';
  return text;
}

}  // namespace

std::string inWords(MapQuantity quantity) {
  switch (quantity) {
    case MapQuantity::ShearModulus: return "the shear modulus";
    case MapQuantity::YoungsModulus: return "Young's modulus";
    case MapQuantity::WaveSpeed: return "the wave speed";
    default: return "another quantity";
  }
}

std::optional<MapQuantity> quantityInWords(const std::string& description) {
  const std::string text = ' ' + spaced(description) + ' ';
  if (holdsAny(text, {"loss modulus", "storage modulus", "damping", "viscos", "strain", "attenuation"}))
    return MapQuantity::Other;
  // Parts of the complex modulus, and figures about a stiffness instead of the stiffness itself.
  if (holdsAny(text, {" loss ", "imaginary", " imag ", " real shear", " real part", " compliance", "standard dev",
                      " std ", " stdev", " sd ", " error", "uncertaint", " variance", "stiffness difference",
                      "stiffness change", "modulus difference", " residual", "goodness"}))
    return MapQuantity::Other;
  if (holdsAny(text, {"young", "elastic modulus", "modulus of elasticity", "e modul", "emodul"}))
    return MapQuantity::YoungsModulus;
  if (holdsAny(text, {"wave speed", "wavespeed", "shear speed", "velocity", "phase speed"}))
    return MapQuantity::WaveSpeed;
  if (holdsAny(text, {"shear mod", "shear stiff", "shearmod", "shearstiff"})) return MapQuantity::ShearModulus;
  return std::nullopt;
}

MapQuantity quantityOfCode(const std::string& scheme, const std::string& value, const std::string& meaning) {
  if (scheme == "99GLISSON" && value == "shear-modulus") return MapQuantity::ShearModulus;
  if (scheme == "99GLISSON" && value == "youngs-modulus") return MapQuantity::YoungsModulus;
  for (const std::string& words : {meaning, value}) {
    if (const auto quantity = quantityInWords(words)) return *quantity;
    const std::string text = spaced(words);
    if (holdsAny(text, {"speed"})) return MapQuantity::WaveSpeed;
    if (holdsAny(text, {"stiffness", "shear modulus"})) return MapQuantity::ShearModulus;
  }
  return MapQuantity::Other;
}

}  // namespace glisson::dicom
