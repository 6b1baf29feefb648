#pragma once

#include "inversion/waves.h"

namespace glisson::inversion {

/// What is done about motion that is no shear wave (compression, the body moving as a whole), before the inversion.
/// All of these are linear and the same everywhere, so that a shear wave stays a wave of the same wavenumber; noise
/// goes the same way.
enum class BulkFilter {
  Auto,  ///< Local with local waves, HighPass with the Laplacian
  None,
  Local,     ///< with local waves only: motion that is affine across a window is fitted beside the wave
  HighPass,  ///< minus a Gaussian mean over the slice's masked voxels: halves a wave of the cutoff wavelength
  Curl       ///< needs three directions: ∇ × u has no compression in it. In the plane its normal component only
};

/// u − Gaussian mean; σ = cutoff √(2 ln 2) / 2π. The mean is taken over masked voxels only (weights divided by their
/// sum). Throws BadArgument where the cutoff is not positive.
void highPass(Waves& waves, double cutoff_mm, const Progress& progress = {});

/// The curl from local polynomial fits (window radius_mm); the directions become its components along the index axes
/// (2-D: one, ∂u_y/∂x − ∂u_x/∂y). Voxels whose window leaves the mask drop out of the mask. Throws BadInput where there
/// are not three directions with known encodings that span space.
void curl(Waves& waves, double radius_mm, int dimensions, const Progress& progress = {});

}  // namespace glisson::inversion
