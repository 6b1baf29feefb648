// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "base/progress.h"
#include "pipeline/run.h"
#include "render/charts.h"

namespace glisson::session {

/// A place on a vessel where both answers lie apart.
struct VesselPlace {
  double apart_mm = 0.0;
  Eigen::Vector3d rest_lps = Eigen::Vector3d::Zero();
  Eigen::Vector3d seen_lps = Eigen::Vector3d::Zero();  ///< in the middle between where both answers put it
};

/// Landmarks at or beyond what matters clinically, the furthest first.
std::vector<VesselPlace> vesselsBeyond(const pipeline::RunResult& result, const render::RetractionScene& picture);

/// Differences of vessels and of the whole liver in mm, with the lines of one voxel (1.64 mm) and of 5 mm. Throws
/// BadArgument where there is no difference to show.
render::BoxPlot differenceBoxes(const pipeline::RunResult& result, const render::RetractionScene& picture);

/// Everything the run wrote into its folder, with pictures (slices, difference map, 3-D), report and record in this
/// palette, and the box plot as PNG and SVG, into another folder; the record names exactly what lies there. Needs a
/// thread without a window's OpenGL context. Throws BadInput, RenderUnavailable, Cancelled; then nothing of it stays.
std::vector<std::filesystem::path> exportResults(const pipeline::RunResult& result,
                                                 const render::RetractionScene& picture, render::Palette palette,
                                                 const std::filesystem::path& runFolder,
                                                 const std::filesystem::path& folder, const Progress& progress = {});

}  // namespace glisson::session
