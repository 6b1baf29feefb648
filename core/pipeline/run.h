// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "base/language.h"
#include "base/progress.h"
#include "comparison/difference.h"
#include "elastography/statistics.h"
#include "pipeline/inputs.h"
#include "pipeline/plan.h"
#include "pipeline/scene.h"
#include "render/overlay.h"
#include "retraction/discretisation.h"
#include "retraction/rigid_contact.h"
#include "retraction/simulate.h"
#include "uncertainty/propagate.h"

namespace glisson::pipeline {

/// What a run writes.
struct RunOptions {
  std::filesystem::path output;  ///< folder for results and pictures; empty: nothing is written
  render::Palette palette = render::Palette::RedBlue;
  Language language = Language::English;  ///< of the pictures of how sure the answer is
  bool discretisation = true;             ///< false: a study that measures errors itself does without the estimate
};

/// What linear theory says beside non-linear kinematics: same body, same load.
struct LinearBeside {
  retraction::Result primary;
  std::optional<retraction::Result> atlas;
  std::optional<comparison::Difference> difference;  ///< MRE against atlas, both linear
  comparison::Difference between;                    ///< the scene's own kinematics against linear, MRE stiffness
};

/// What one run gives. What was not asked for is empty.
struct RunResult {
  std::vector<PlanStep> plan;  ///< with the seconds each step took
  retraction::Model model;
  retraction::Result primary;                                     ///< with the scene's own material
  std::optional<retraction::Result> atlas;                        ///< where the scene compares
  std::optional<retraction::DiscretisationError> discretisation;  ///< of primary
  std::optional<comparison::Difference> difference;
  std::optional<uncertainty::Uncertainty> uncertainty;  ///< where it is asked for and both runs are answers
  std::optional<LinearBeside> linear;                   ///< where a report of large deformation is asked for
  std::vector<Eigen::Vector3d> landmarks_mm;            ///< vessel centrelines at rest, LPS
  std::optional<elastography::Measurement> stiffness;   ///< over the region of interest, where MRE is used
  std::optional<render::RetractionScene> picture;       ///< what the overlays draw, where they are asked for
  std::vector<std::filesystem::path> files;             ///< everything written, run.json first
  std::vector<std::string> warnings;
  Diagnostics diagnostics;
  std::optional<retraction::PlacedBar> placed;  ///< where a rigid bar lies
  std::string kinematicsWhy;                    ///< why these kinematics were used
  std::string json;                             ///< the run record, as in contract.md
};

/// On which side of the clinical line the difference at the retractor lies; open where the estimated error of the
/// cells, or the 95 % interval of what is uncertain, reaches over that line.
enum class Significance { Below, Beyond, Open };
/// result: with a difference.
Significance significanceOf(const RunResult& result);

/// Does everything the plan says. inputs: already loaded (the workstation), else read from the scene's files.
/// Throws BadInput, SolverFailed (nothing converged), Cancelled.
RunResult run(const Scene& scene, const RunOptions& options, const Progress& progress = {},
              const Inputs* inputs = nullptr);

}  // namespace glisson::pipeline
