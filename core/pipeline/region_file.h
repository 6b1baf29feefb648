// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "image/volume.h"
#include "pipeline/scene.h"

namespace glisson::pipeline {

/// Whether a file is a mask, a label map, a surface or a volume mesh (image::isVolumeFile, anatomy::isSurfaceFile).
bool isRegionFile(const std::filesystem::path& path);

/// The labels of a label map that holds more than one, e.g. "3 5 7"; empty for any other file. Throws BadInput where a
/// volume file cannot be read.
std::string severalLabels(const std::filesystem::path& path);

/// The voxels of a region. A mask keeps its grid; label picks a value of a label map (0 = any). A closed surface, or
/// the outside of a volume mesh, is filled on a grid along the patient axes with cells of cell_mm (absent: 256 along
/// its longest side); coordinates are LPS mm. Appends to warnings what the user should know, and what of it there is as
/// data to diagnostics (may be null). Throws BadInput where the file cannot be read, or the surface is open or smaller
/// than 1 mL (its coordinates are then hardly millimetres).
image::Mask readRegion(const std::filesystem::path& path, int label, std::optional<Eigen::Vector3d> cell_mm,
                       std::vector<std::string>& warnings, Diagnostics* diagnostics = nullptr);

/// Cells of a scene's mask that comes as a surface: the scene's cell_mm, or twice the in-plane voxel of a usual MRI.
Eigen::Vector3d surfaceCell_mm(const GeometrySpec& geometry);

}  // namespace glisson::pipeline
