#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/quantity.h"
#include "image/volume.h"

namespace glisson::comparison {

/// How far apart two retractions of one liver place the same tissue, mm.
struct Difference {
  double mean_mm = 0.0, p95_mm = 0.0, max_mm = 0.0;  ///< over the body's voxels
  double at_retractor_mm = 0.0;                      ///< mean over the contact; 0 where there is no retractor
  bool clinically_significant = false;               ///< at the retractor (else the maximum) ≥ 5 mm
  std::vector<double> vessel_mm;                     ///< per vessel landmark, where there are any
  double vesselMean_mm = 0.0, vesselP95_mm = 0.0, vesselMax_mm = 0.0;
  double vesselFractionBeyond = 0.0;                 ///< share of landmarks ≥ 5 mm apart
};

}  // namespace glisson::comparison
