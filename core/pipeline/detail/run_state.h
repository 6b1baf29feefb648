// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <future>
#include <optional>

#include "anatomy/vessels.h"
#include "base/folder_claim.h"
#include "pipeline/detail/needs.h"
#include "pipeline/detail/outputs.h"
#include "pipeline/detail/step_log.h"
#include "pipeline/run.h"

namespace glisson::pipeline::detail {

/// What the steps of one run share: each takes what earlier ones have left here, and adds its own.
struct RunState {
  /// Everything but the members below outlives the state. result.plan: as plan() gives it.
  RunState(const Scene& scene_, const RunOptions& options_, const Inputs& inputs_, RunResult& result_,
           const Progress& progress)
      : scene(scene_),
        options(options_),
        inputs(inputs_),
        needs(scene_),
        log(result_.plan, progress),
        setup(scene_.setup),
        result(result_) {}

  bool compares() const { return scene.compare.has_value(); }
  /// Both runs are answers; without a comparison, the one is.
  bool allAnswer() const;

  const Scene& scene;
  const RunOptions& options;
  const Inputs& inputs;
  const Needs needs;
  StepLog log;
  retraction::Setup setup;  ///< the scene's, with the bar in its place and the kinematics that are used
  image::Mask cells;        ///< of the body
  retraction::Model atlasModel;
  anatomy::VesselModel vessels;
  RunResult& result;
  std::optional<FolderClaim> claim;  ///< from the first step that writes on
  std::optional<Writer> writer;
  std::optional<PictureData> pictures;
  /// The second answer, where it is solved beside the first. Last, so that it has ended before what it works on goes.
  std::future<retraction::Result> atlasAhead;
};

}  // namespace glisson::pipeline::detail
