// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>

#include "render/overlay.h"

namespace glisson::pipeline {

/// What the pictures of a run are drawn from, so that they can be drawn again without solving again.
struct PictureData {
  render::RetractionScene scene;
  std::optional<Eigen::Vector3d> vessel_lps_mm;  ///< where the most misplaced vessel ends up, between the two answers
};

/// Name of the file in the folder of a run.
inline constexpr const char* pictureFileName = "pictures.glisson";

/// One file: "GLISSONP", length of a JSON header (64-bit little-endian), the header (grids, numbers, texts, length and
/// SHA-256 of what follows), then the arrays as they lie in memory (little-endian). Nothing is rounded: pictures drawn
/// from it have the same bits as those of the run. Written beside, then renamed. Throws BadInput.
void writePictureFile(const std::filesystem::path& file, const PictureData& data);

/// Throws BadInput where the file is missing, of another version, truncated or damaged.
PictureData readPictureFile(const std::filesystem::path& file);

}  // namespace glisson::pipeline
