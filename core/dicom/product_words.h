// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "dicom/series.h"

namespace glisson::dicom {

/// A product of an elastography acquisition that a name speaks of.
struct Product {
  SeriesRole role = SeriesRole::Other;
  std::string word;     ///< that says so
  bool masked = false;  ///< a stiffness map without what is not trusted
};

/// What a series description or an image type calls a series. The last product word before "of", "with", "from" ... is
/// what it is ("shear wave": a wave; "wave speed": a stiffness map; "stiffness confidence": a confidence map), but a
/// stiffness with a percentage or a unit stays one ("stiffness 95% confidence [kPa]": masked). shearAlone: "shear"
/// by itself means stiffness. Empty where no word is a product.
std::optional<Product> productNamed(const std::string& name, bool shearAlone);

/// "kPa", "Pa" or "m/s", where a description holds one.
std::optional<std::string> unitInWords(const std::string& description);

}  // namespace glisson::dicom
