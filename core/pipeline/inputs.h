// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/diagnostic.h"
#include "base/progress.h"
#include "elastography/registration.h"
#include "elastography/roi_mapping.h"
#include "elastography/stiffness_map.h"
#include "image/volume.h"
#include "pipeline/scene.h"
#include "roi/contour_stack.h"

namespace glisson::pipeline {

/// What a scene's files hold, read and checked. The workstation makes one from what is open on screen.
struct Inputs {
  std::optional<image::ScalarVolume> mri;               ///< anatomical image
  std::optional<roi::ContourStack> contours;            ///< region of interest as polygons, where it came as such
  std::optional<image::Mask> liver;                     ///< region of interest as voxels (MRI grid, or the mask's own)
  std::optional<elastography::StiffnessMap> stiffness;  ///< MRE or map, with its confidence
  std::optional<elastography::MappedRoi> roiOnMre;      ///< region of interest on the grid of the elastogram
  std::optional<elastography::Registration> registration;  ///< of the elastogram, where the scene asks for it
  std::vector<std::string> warnings;                       ///< texts, those of diagnostics among them
  Diagnostics diagnostics;
  std::vector<std::pair<std::string, double>> seconds;  ///< what reading took, by step of the plan
};

/// Reads what the scene needs and nothing else. Throws BadInput.
Inputs loadInputs(const Scene& scene, const Progress& progress = {});

}  // namespace glisson::pipeline
