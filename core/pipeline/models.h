// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "base/progress.h"
#include "pipeline/inputs.h"
#include "pipeline/scene.h"
#include "retraction/simulate.h"

namespace glisson::pipeline {

/// The bodies of a scene before anything is solved, and what is watched in them.
struct Models {
  retraction::Model model;                        ///< with the scene's own stiffness
  std::optional<retraction::Model> atlas;         ///< where the scene compares
  std::vector<Eigen::Vector3d> landmarks_mm;      ///< vessel centrelines, LPS; empty without an image or vessels
  std::vector<std::array<int, 2>> landmarkEdges;  ///< neighbouring landmarks
  std::vector<std::string> warnings;
};

/// What a scene's steps up to "mesh" and "vessels" give. vessels: they are sought where the scene has an image.
/// inputs: already loaded (the workstation), else read. Throws BadInput, Cancelled.
Models buildModels(const Scene& scene, bool vessels, const Progress& progress = {}, const Inputs* inputs = nullptr);

/// What follows the tool in a live retraction: the vessels, or the scene's probes where there are none; LPS mm. Throws
/// BadInput where the scene has neither.
const std::vector<Eigen::Vector3d>& followedPoints(const Scene& scene, const Models& models);

}  // namespace glisson::pipeline
