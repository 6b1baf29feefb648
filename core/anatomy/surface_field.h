// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "image/volume.h"

namespace glisson::anatomy {

/// A smooth field whose set above `level` is the body of a mask.
struct SurfaceField {
  image::ScalarVolume values_mm;  ///< signed distance, about; isotropic lattice along the mask's axes, margin outside
  double level_mm = 0.0;
  double volume_mm3 = 0.0;  ///< of the mask's voxels; the set above level holds it (0.5 % or so)
};

/// The field behind both surfaces (see surface.h). resolution_mm as SurfaceOptions. Throws BadInput where the mask is
/// empty.
SurfaceField surfaceField(const image::Mask& mask, double resolution_mm);

}  // namespace glisson::anatomy
