// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "anatomy/vessels.h"
#include "pipeline/run.h"

namespace glisson::pipeline::detail {

/// How sure the answers of a run are. vessels: those of result.landmarks_mm. atlas: the model of result.atlas, or null
/// without a comparison; setup: with the bar in its place. Both results are answers in contact with a rigid bar.
uncertainty::Uncertainty uncertaintyOf(const Scene& scene, const Inputs& inputs, const image::Mask& cells,
                                       const retraction::Setup& setup, const anatomy::VesselModel& vessels,
                                       const retraction::Model* atlas, const RunResult& result,
                                       const Progress& progress);

}  // namespace glisson::pipeline::detail
