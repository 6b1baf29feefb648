#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/quantity.h"
#include "retraction/simulate.h"

namespace glisson::comparison {

/// How far apart two retractions of one liver place the same tissue, mm.
struct Difference {
  double mean_mm = 0.0, p95_mm = 0.0, max_mm = 0.0;  ///< over the body's voxels
  double at_retractor_mm = 0.0;                      ///< mean over the contact; 0 where there is no retractor
  bool clinically_significant = false;               ///< at the retractor (else the maximum) ≥ 5 mm
  std::vector<double> vessel_mm;                     ///< per vessel landmark, where there are any
  double vesselMean_mm = 0.0, vesselP95_mm = 0.0, vesselMax_mm = 0.0;
  double vesselFractionBeyond = 0.0;  ///< share of landmarks ≥ 5 mm apart
};

/// Compares two retractions of the same model grid under the same load. landmarks_mm: vessel centrelines at rest (LPS).
/// Throws BadArgument where the two were not made on the same mesh.
Difference compare(const retraction::Model& model, const retraction::Result& a, const retraction::Result& b,
                   const std::vector<Eigen::Vector3d>& landmarks_mm,
                   Length significant = defaults::clinicallySignificant);

}  // namespace glisson::comparison
