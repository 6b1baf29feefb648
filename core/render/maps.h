// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "image/volume.h"
#include "render/overlay.h"
#include "render/picture.h"
#include "roi/contour_stack.h"

namespace glisson::render {

/// Pictures of one slice of data, framed like the overlays (radiological convention, scale bar, letters, colour bar).
/// They need no display and may be drawn from any thread. All throw BadArgument where slice or range are not usable.
struct MapOptions {
  int slice = -1;  ///< k; −1 = the middle slice, or that of the largest difference
  int pixelsPerVoxel = 5;
  double low = 0.0, high = 8.0;  ///< ends of the colour bar, in its unit
  bool decorate = true;
  std::string title{};
  std::string caption{};              ///< holds no patient text
  std::optional<double> margin_mm{};  ///< cut to the contours (or the liver) plus this margin; unset: the whole slice
  std::optional<Eigen::Vector3d> ring_lps_mm{};  ///< a place to mark
  Language language = Language::English;         ///< of probabilityPicture
};

/// A stiffness map, one colour per voxel, no smoothing. barTitle names quantity and unit ("Shear modulus µ (kPa)").
/// contours and confidence may be null; confidence is 0..1 on any grid, voxels below 0.95 are hatched.
Picture stiffnessPicture(const image::ScalarVolume& stiffness_kPa, const std::string& barTitle,
                         const roi::ContourStack* contours, const image::ScalarVolume* confidence,
                         const MapOptions& options = {});

/// An anatomical slice with the outline of the region of interest: included solid, excluded and interpolated dashed.
/// Range options are not used: grey runs from the 1st to the 99.5th percentile of the volume.
Picture roiPicture(const image::ScalarVolume& mri, const roi::ContourStack& contours, const MapOptions& options = {});

/// ‖u_mre − u_atlas‖ in mm at rest positions inside the liver, over the MRI, with the line of clinical significance.
/// The colour bar runs to options.high, or further where a voxel of the liver is larger.
Picture differencePicture(const RetractionScene& scene, const MapOptions& options = {.high = 10.0});

/// HowSure::beyond in percent at rest positions inside the liver, over the MRI, with the line of one half. Throws
/// BadArgument where the scene has none. Range and titles of the options are not used.
Picture probabilityPicture(const RetractionScene& scene, const MapOptions& options = {});

}  // namespace glisson::render
