#pragma once

#include <complex>
#include <vector>

#include "base/progress.h"
#include "inversion/waves.h"

namespace glisson::inversion::detail {

struct LocalWaveOptions {
  double radius_mm = 0.0;     ///< of the window
  double averaging_mm = 0.0;  ///< radius over which windows are pooled
  double q0_mm2 = 0.0;        ///< squared wavenumber of the textbook's liver; q is sought from q0/8 to 4 q0
  bool affine = true;         ///< affine motion is fitted beside the wave
};

/// Squared wavenumbers, voxel by voxel on the waves' grid; 0 where there is none.
struct LocalWaves {
  std::vector<std::complex<double>> q_mm2;
  std::vector<double> relativeVariance;  ///< of q, |δq|²/|q|²
  std::size_t resolved = 0;
  double correlatedVoxels = 1.0;  ///< of what the fit leaves over: so many of its voxels count as one
};

/// Fits WaveBasis to a window about every voxel of the mask, slice by slice, by least squares over the mask's voxels in
/// it; at least leastCover of the window must lie there. All directions share q. First the energy left over is found on
/// a grid of real q, pooled and minimised; from there Gauss-Newton's method with variable projection [golub2003] finds
/// the complex q of each window, q ← q + g⊥ᴴρ/|g⊥|², ρ = P⊥u, g⊥ = P⊥(∂B/∂q)c; windows are pooled with the weight |g⊥|².
/// Variance: the larger one of what another portion of the noise (Waves::Direction::noise) does to q, and of
/// σ² correlated/|g⊥|² with σ² what the fit leaves over, per degree of freedom (correlated: sum of its autocorrelation).
/// Throws BadInput where no window has room.
LocalWaves fitLocalWaves(const Waves& waves, const LocalWaveOptions& options, const Progress& progress = {});

}  // namespace glisson::inversion::detail
