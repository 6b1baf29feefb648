// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/language.h"
#include "pipeline/picture_file.h"
#include "pipeline/run.h"
#include "render/charts.h"
#include "render/overlay.h"

namespace glisson::pipeline {

/// From where a 3-D picture is seen.
struct NamedCamera {
  std::string name;  ///< part of the file's name
  render::View3D view = render::View3D::Oblique;
  std::optional<render::Camera3D> camera{};
};

/// "anterior", "posterior", "left", "right", "superior", "inferior", "oblique", or "azimuth,elevation" in degrees.
/// Throws BadInput.
NamedCamera cameraFromText(const std::string& text);

/// Where the two predictions differ most in a slice (k of the MRI), in the middle between the two places; of one
/// prediction where it moves most. The middle of the image where nothing moves.
Eigen::Vector3d placeOfLargestDifference(const render::RetractionScene& scene, int slice);

/// Which pictures, and how.
struct PictureOptions {
  render::Palette palette = render::Palette::RedBlue;
  std::vector<int> slices{};           ///< k of the MRI grid; empty: largest difference, vessels, retractor
  std::vector<NamedCamera> cameras{};  ///< empty: oblique and anterior
  int width = 1600, height = 1200;     ///< of 3-D pictures; pixels per voxel of slices grow with the width
  double dpi = 300.0;
  Language language = Language::English;  ///< of drawHowSure and drawHowSure3D
};

/// Draws the slices and, of two answers, the map of differences into the folder; gives the files. Nothing where the
/// scene may not be drawn (not converged, inverted cells). Throws BadInput where a slice is not there or the folder
/// cannot be written.
std::vector<std::filesystem::path> drawSlices(const PictureData& data, const PictureOptions& options,
                                              const std::filesystem::path& folder);

/// Force of a rigid bar against its travel under either stiffness, with what was asked for and how much the place
/// bears. stiffness: what the first one is called.
render::XyChart forceChart(const render::RigidBar& bar, const std::string& stiffness = "MRE");

/// The chart of a rigid bar, whether the scene may be drawn or not: a bar that slips shows there how far it came.
/// Nothing without such a bar.
std::vector<std::filesystem::path> drawCharts(const PictureData& data, const PictureOptions& options,
                                              const std::filesystem::path& folder);

/// Of a run that says how sure it is; else nothing.
std::optional<SureNumbers> sureNumbersOf(const RunResult& result);

/// What the difference at the retractor depends on: its sources, the largest first. Nothing without a comparison.
std::optional<render::Tornado> retractorTornado(const SureNumbers& numbers, Language language);
/// The same of the vessel landmark that lies furthest apart; without a comparison of the vessels' places.
std::optional<render::Tornado> vesselTornado(const SureNumbers& numbers, Language language);

/// How sure the run is: both tornado charts, and the map of the probability of 5 mm; with slices that map alone.
/// Nothing where the run does not say how sure it is, or may not be drawn. Throws as drawSlices.
std::vector<std::filesystem::path> drawHowSure(const PictureData& data, const PictureOptions& options,
                                               const std::filesystem::path& folder);
/// The vessels with what holds them with 95 %, in 3-D. Throws RenderUnavailable.
std::vector<std::filesystem::path> drawHowSure3D(const PictureData& data, const PictureOptions& options,
                                                 const std::filesystem::path& folder);

/// The same as drawSlices in 3-D: both answers, and the contact pressure of a rigid bar on each. Throws
/// RenderUnavailable.
std::vector<std::filesystem::path> draw3D(const PictureData& data, const PictureOptions& options,
                                          const std::filesystem::path& folder);

}  // namespace glisson::pipeline
