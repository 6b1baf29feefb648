// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "base/quantity.h"
#include "retraction/simulate.h"

namespace glisson::comparison {

/// How far apart two retractions of one liver place the same tissue, mm.
struct Difference {
  double mean_mm = 0.0, p95_mm = 0.0, max_mm = 0.0;  ///< over the body's voxels
  /// Rigid bar: area-weighted mean over the surface that touches it at the end of either run. Patch: mean over the
  /// nodes of its window (length × diameter at rest, seen along the hoist). 0 if there is no retractor.
  double at_retractor_mm = 0.0;
  /// Of a rigid bar: its travel in the one less that in the other; the mean over its window at rest; the mean over the
  /// contact weighted by the pressures of both.
  std::optional<double> travel_mm, window_at_rest_mm, contact_mean_mm;
  /// What the bar takes in each where it has travelled equally far, N: of the answers, if both have travelled alike,
  /// else at the smaller of their travels, where one bears its own force, and the other what retraction::answersForceAt
  /// says: its path, followed on coarser cells, brought to its answer.
  struct EqualLift {
    double travel_mm = 0.0, force_N = 0.0, other_force_N = 0.0;
    bool alongPath = true;  ///< false: both answers have this travel, and the forces are theirs
  };
  std::optional<EqualLift> equal_lift;
  bool clinically_significant = false;  ///< at the retractor (else the maximum) ≥ 5 mm
  std::vector<double> vessel_mm;        ///< per vessel landmark, where there are any
  double vesselMean_mm = 0.0, vesselP95_mm = 0.0, vesselMax_mm = 0.0;
  double vesselFractionBeyond = 0.0;  ///< share of landmarks ≥ 5 mm apart
};

/// Compares two retractions of the same model grid under the same load. landmarks_mm: vessel centrelines at rest (LPS).
/// Throws BadArgument where the two were not made on the same mesh.
Difference compare(const retraction::Model& model, const retraction::Result& a, const retraction::Result& b,
                   const std::vector<Eigen::Vector3d>& landmarks_mm,
                   Length significant = defaults::clinicallySignificant);

}  // namespace glisson::comparison
