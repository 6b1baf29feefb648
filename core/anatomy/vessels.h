// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "anatomy/triangle_mesh.h"
#include "anatomy/vessel_tree.h"
#include "base/progress.h"
#include "image/volume.h"

namespace glisson::anatomy {

/// What counts as a vessel.
struct VesselOptions {
  double smallestRadius_mm = 1.5;
  double largestRadius_mm = 7.0;
  double smallestVolume_mm3 = 150.0;  ///< smaller parts are left out
  double smallestLength_mm = 15.0;    ///< parts whose bounding box is shorter are left out
  bool bright = true;                 ///< contrast-enhanced: brighter than the liver; false: darker
  double high = 0.4;                  ///< line-likeness that starts a vessel
  double low = 0.1;                   ///< line-likeness that carries it on
};

/// The vessels inside the liver. Empty where none was found (see note).
struct VesselModel {
  image::Mask mask;      ///< isotropic working grid along the MRI's axes, not the MRI grid
  TriangleMesh surface;  ///< closed; a branch is at least about as wide as the smallest vessel that is looked for
  std::vector<Eigen::Vector3d> centreline_lps_mm;  ///< landmarks, about one per working voxel along the vessels
  std::vector<double> radius_mm;                   ///< per landmark
  std::vector<std::array<int, 2>> edges;           ///< neighbouring landmarks
  VesselTree tree;                                 ///< the same landmarks as branches, see vessel_tree.h
  double contrast = 0.0;                           ///< vessel minus liver, image units
  std::string note;                                ///< what was found or why nothing was, in words
};

/// Vessels in a contrast-enhanced MRI inside a liver mask (any grid). Steps:
/// 1. image and liver on an isotropic grid (smallest MRI spacing, at least 1 mm) round the liver, trilinear; the
/// liver's
///    outermost MRI voxel layer (at most 4 mm) is left out, it mixes liver and surroundings;
/// 2. minus the liver's own smooth brightness (Gaussian mean inside the liver, 12 mm), 0 outside, so that the capsule
///    and the coil's shading make no ridges;
/// 3. line-likeness over four scales (radius / √2), see vesselness.h;
/// 4. hysteresis: voxels above low that hang together with one above high;
/// 5. contrast C = upper quartile of the difference from the liver over the voxels above high, the liver's level
/// without the candidates;
///    vessel = difference above C / 2 within one largest radius of a candidate, or above high itself;
///    nothing counts where C is below three robust standard deviations of the liver, or 5 % of its brightness;
/// 6. parts too small, too short, or with a mean difference below C / 4 are left out;
/// 7. cavities filled; skeleton, pruned and centred; surface.
/// Throws BadInput where the liver is empty or lies outside the image.
VesselModel findVessels(const image::ScalarVolume& mri, const image::Mask& liver, const VesselOptions& options,
                        const Progress& progress = {});
VesselModel findVessels(const image::ScalarVolume& mri, const image::Mask& liver, const Progress& progress = {});

}  // namespace glisson::anatomy
