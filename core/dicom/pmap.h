// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>

#include "base/quantity.h"
#include "dicom/series.h"
#include "image/volume.h"

namespace glisson::dicom {

/// Writes a Parametric Map (32-bit float pixels) of a stiffness in kPa on the grid of source: unit and quantity (shear
/// modulus or Young's modulus) in the real-world value map, ContentQualification RESEARCH, the source image of every
/// frame. Values that are not finite are a BadInput: an elastogram marks missing values with 0. Throws BadArgument
/// where the grids differ, BadInput where the file cannot be written.
void writeParametricMap(const std::filesystem::path& file, const image::ScalarVolume& stiffness_kPa,
                        StiffnessQuantity quantity, const Series& source, std::uint64_t seed);

}  // namespace glisson::dicom
