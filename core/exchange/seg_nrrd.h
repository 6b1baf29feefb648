// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "image/volume.h"

namespace glisson::exchange {

/// A segment for 3D Slicer: a mask with a name. All masks of one file share a grid.
struct NamedMask {
  std::string name;
  image::Mask mask;
  double red = 0.87, green = 0.72, blue = 0.45;  ///< display colour, 0 ... 1
};

/// Writes a Slicer segmentation (.seg.nrrd): 8-bit label values 1, 2 ... in one layer, or one layer per segment where
/// they overlap; LPS geometry; segment names, label values, layers, extents and the liver's SNOMED code in the header;
/// gzip. Throws BadArgument where the grids differ, BadInput where the file cannot be written.
void writeSegNrrd(const std::filesystem::path& file, const std::vector<NamedMask>& segments);

}  // namespace glisson::exchange
