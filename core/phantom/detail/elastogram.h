// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "phantom/detail/torso.h"
#include "phantom/phantom.h"

namespace glisson::phantom {

/// What the elastography part needs from the anatomy; all on the MRE grid.
struct ElastogramInput {
  image::Grid grid;
  const std::vector<float>* body_mm = nullptr;    ///< signed distance to the skin
  const std::vector<float>* liver_mm = nullptr;   ///< signed distance to the liver's surface
  const std::vector<float>* vessel_mm = nullptr;  ///< signed distance to the liver's veins
  double shear_kPa = 2.1;                         ///< mean over the liver's confident voxels
  std::uint64_t seed = 1;
};

/// Fills the stiffness, confidence, wave and colour volumes, the noise-free map, the liver's mask on the MRE grid and
/// the stiffness part of the truth.
/// - Shear modulus: mean · (1 + smooth field within ±15 %), in one patient of four with a stiffer region.
/// - Confidence: low within 4 mm of the capsule, at veins wider than 5 mm, in a deep region the waves hardly reach, and
///   outside the liver; there the stiffness is wrong, as an inversion is there.
/// - Wave: 60 Hz shear waves from a driver on the right anterior wall; phase = 2π f ∫ ds / c with c = sqrt(µ / ρ)
///   along straight rays, exponential attenuation, one weaker reflected wave; at 4 equal parts of the period, each with
///   its own noise.
void fillElastogram(const ElastogramInput& input, PhantomPatient& patient);

}  // namespace glisson::phantom
