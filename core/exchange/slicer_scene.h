// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace glisson::exchange {

/// What a Slicer scene shows; files lie beside the scene and are named without a folder.
struct SlicerItem {
  enum class Kind { Volume, VectorVolume, Segmentation, Model, ClosedCurves } kind = Kind::Volume;
  std::string name, file;
  double red = 0.87, green = 0.72, blue = 0.45, opacity = 1.0;  ///< of models
};

/// Writes a 3D Slicer scene (.mrml). Throws BadInput where the file cannot be written.
void writeSlicerScene(const std::filesystem::path& file, const std::vector<SlicerItem>& items);

}  // namespace glisson::exchange
