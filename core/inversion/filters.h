// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "inversion/waves.h"

namespace glisson::inversion {

/// What is done about motion that is no shear wave (compression, the body moving as a whole), before the inversion.
/// Noise goes the same way.
enum class BulkFilter {
  Auto,  ///< HighPass
  None,
  HighPass,  ///< motion that is affine under a Gaussian weight is fitted beside the wave and taken off
             ///< (detail/background.h); the weight's Fourier transform halves at the cutoff wavelength
  Curl       ///< needs three directions: ∇ × u has no compression in it. In the plane its normal component only
};

/// The curl from local polynomial fits (window radius_mm); the directions become its components along the index axes
/// (2-D: one, ∂u_y/∂x − ∂u_x/∂y). Voxels whose window leaves the mask drop out of the mask. Throws BadInput where there
/// are not three directions with known encodings that span space.
void curl(Waves& waves, double radius_mm, int dimensions, const Progress& progress = {});

}  // namespace glisson::inversion
