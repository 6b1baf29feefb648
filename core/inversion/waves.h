// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "image/volume.h"

namespace glisson::inversion {

/// Complex amplitude of a wave, u(x, t) = Re(U(x) exp(iωt)).
using ComplexVolume = image::Volume<std::complex<float>>;

/// Phase images of one motion-encoding direction: N ≥ 3 offsets that part one vibration period evenly, in order of
/// time, all on one grid. Values in rad, wrapped or not.
struct PhaseOffsets {
  Eigen::Vector3d encoding_lps = Eigen::Vector3d::Zero();  ///< motion that counts, unit length; zero: unknown
  std::vector<image::ScalarVolume> offsets_rad;
};

/// How stored phase values become radians: rad = slope · (value − zero).
struct PhaseScale {
  double slope_rad = 1.0;
  double zero = 0.0;
  std::string reason;  ///< in words
};

/// Found from the values: radians (within ± π), milliradians (± 3142), 12 bit signed (± 4096), 12 bit unsigned
/// (0 ... 4095). Wrapped phase fills its range wherever there is noise, so the largest value (within 2 %) tells.
/// Throws BadInput, with the range, where it fits none: then the scale must be given.
PhaseScale phaseScale(const std::vector<image::ScalarVolume>& phases);

/// Applies a scale in place.
void toRadians(image::ScalarVolume& phase, const PhaseScale& scale);

/// How steps of 2π are taken out of the phase.
enum class Unwrapping {
  Temporal,  ///< differences of consecutive offsets, wrapped into ± π: right while no step of the wave exceeds π
  Quality,   ///< these differences unwrapped in each slice, best voxels first [ghiglia1998]
  Auto       ///< Temporal; Quality for a direction where wrapped steps jump from voxel to voxel
};

/// How waves are made of phase offsets.
struct WaveOptions {
  Unwrapping unwrapping = Unwrapping::Auto;
  std::optional<image::Mask> mask;  ///< voxels with signal; empty: found from the temporal noise (N ≥ 4)
};

/// First harmonic of every direction, with noise that went the same way.
struct Waves {
  image::Grid grid;
  image::Mask mask;  ///< voxels with signal
  /// Motion along one encoding direction.
  struct Direction {
    Eigen::Vector3d encoding_lps = Eigen::Vector3d::Zero();
    ComplexVolume wave;                ///< rad
    std::vector<ComplexVolume> noise;  ///< harmonics 2 ... N/2 (two at most), rad: no wave, and E|n|² equals that of
                                       ///< the noise in wave; empty for N = 3
    bool spatiallyUnwrapped = false;
    double jumping = 0.0;    ///< fraction of masked voxels where a wrapped step jumps by more than π to the next voxel
    double noise_rad = 0.0;  ///< standard deviation of the phase noise in the mask; 0 where N = 3
  };
  std::vector<Direction> directions;
  std::vector<std::string> warnings;
};

/// Steps δ_t = φ_{t+1} − φ_t remove any phase that does not move. With φ_t = φ_0 + Re(U e^{2πit/N}) harmonic m of the
/// steps is (e^{2πim/N} − 1) times that of φ, so U = (2/N) Σ δ_t e^{−2πit/N} / (e^{2πi/N} − 1).
/// Without a mask a voxel has signal where steps agree within 3 × 3 pixels as they do below a phase noise of 0.6 rad,
/// the mean over all steps and directions; wrapped steps agree as well as others. Throws BadInput: fewer than three
/// offsets, other numbers or grids, values that are not finite, or an empty mask.
Waves firstHarmonic(const std::vector<PhaseOffsets>& directions, const WaveOptions& options = {},
                    const Progress& progress = {});

/// Unwraps slice by slice inside the mask: from the best voxel outwards, always on to the neighbour of best quality
/// [ghiglia1998]. Quality: the spread of wrapped differences to the neighbours. Each connected part is shifted by a
/// multiple of 2π so that its median lies within ± π.
void unwrapSlices(image::ScalarVolume& phase_rad, const image::Mask& mask);

}  // namespace glisson::inversion
