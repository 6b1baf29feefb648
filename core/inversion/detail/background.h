// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <complex>
#include <vector>

#include "base/progress.h"
#include "image/volume.h"

namespace glisson::inversion::detail {

/// A wave or noise field after the local polynomial fit of each window: u and ∇²u, voxel by voxel; zero where the
/// window leaves the mask.
struct Fitted {
  std::vector<std::complex<float>> value, laplacian;
};

/// Of one motion-encoding direction; noise is what went the same way without being a wave (Waves::Direction::noise).
struct FittedDirection {
  Fitted wave;
  std::vector<Fitted> noise;
};

/// Motion that is no shear wave (compression, the body moving as a whole), estimated beside the wave and taken off
/// `value`, in place. About every voxel, with Gaussian weights over the slice's voxels of `inner`, ∇²u = −r(u − b) is
/// fitted by least squares with one r for all directions and an affine b for each (variable projection [golub2003]):
/// what obeys the wave equation is the wave, however few of its lengths the organ holds, so that the border of a mask
/// takes none of it away. |r| is held at or above least_mm2, the stiffest that counts. Noise is taken off r, and goes
/// the same way. Gives b of every direction's wave, at each voxel of `mask`, for pictures.
std::vector<std::vector<std::complex<float>>> takeBackgroundOff(std::vector<FittedDirection>& fitted,
                                                                const image::Mask& inner, const image::Mask& mask,
                                                                double sigma_mm, double least_mm2,
                                                                const Progress& progress);

}  // namespace glisson::inversion::detail
