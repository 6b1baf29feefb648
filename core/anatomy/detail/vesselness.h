// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "base/progress.h"
#include "image/volume.h"

namespace glisson::anatomy {

/// Image smoothed by a Gaussian of standard deviation sigma_mm, on any grid (kernel cut at 3.5 sigma, normalised at
/// borders).
image::ScalarVolume gaussian(const image::ScalarVolume& image, double sigma_mm);

/// Gaussian mean over the voxels of where only: G*(image·where) / G*where; 0 where none is near.
image::ScalarVolume maskedMean(const image::ScalarVolume& image, const image::Mask& where, double sigma_mm);

/// Line-likeness 0 ... 1 of bright tubes [frangi1998], largest over the scales sigma_mm, inside roi (0 outside).
/// image: isotropic grid, background near zero. Second derivatives of the smoothed image, times sigma²; eigenvalues
/// |l1| ≤ |l2| ≤ |l3|; 0 unless l2, l3 < 0; otherwise (1 − e^(−2 RA²)) e^(−2 RB²) (1 − e^(−S²/2c²)) with RA = |l2/l3|,
/// RB = |l1|/√|l2 l3|, S² = Σ l², and per scale c = the larger of 5 × the median of S in roi (noise and texture do not
/// pass) and 1/4 of its maximum.
image::ScalarVolume vesselness(const image::ScalarVolume& image, const image::Mask& roi,
                               const std::vector<double>& sigma_mm, const Progress& progress = {});

}  // namespace glisson::anatomy
