// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>

#include "render/overlay.h"
#include "uncertainty/sampling.h"

namespace glisson::pipeline {

/// How sure a run is, in the numbers that charts show.
struct SureNumbers {
  std::optional<uncertainty::Headline> headline;  ///< with a comparison
  double at_retractor_mm = 0.0;                   ///< difference, as computed
  bool vessels = false;                           ///< there are landmarks
  std::vector<uncertainty::SourceSpread> sources;
};

/// What the pictures of a run are drawn from, so that they can be drawn again without solving again.
struct PictureData {
  render::RetractionScene scene;
  std::optional<Eigen::Vector3d> vessel_lps_mm;  ///< where the most misplaced vessel ends up, between the two answers
  std::optional<SureNumbers> sure;               ///< where it was asked for and is known
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
