// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "elastography/mean_interval.h"
#include "elastography/stiffness_map.h"

namespace glisson::elastography {

/// Statistics of the voxels that count. NaN where there are none (and for the SD of one voxel).
struct Statistics {
  std::size_t n = 0;              ///< voxels that count: finite, > 0, confident
  std::size_t n_before_mask = 0;  ///< voxels of the (eroded) region of interest
  double area_mm2 = 0.0;          ///< n × in-plane voxel area
  double mean_kPa = 0.0;
  double median_kPa = 0.0;  ///< mean of the two middle values where n is even
  double sd_kPa = 0.0;      ///< sample standard deviation, divisor n − 1
  double min_kPa = 0.0;
  double max_kPa = 0.0;
};

/// How well a mean is known. Neighbouring voxels of an elastogram share noise (the inversion pools them), so n voxels
/// count as n / correlated only: the sum of the autocorrelation over in-plane shifts, up to the first square
/// shell of shifts whose mean correlation is below 0.1.
struct MeanUncertainty {
  double correlatedVoxels = 1.0;         ///< ≥ 1
  double se_kPa = 0.0;                   ///< SD √(correlated / n); not-a-number for fewer than two voxels
  double low_kPa = 0.0, high_kPa = 0.0;  ///< mean ± 1.96 se
};

/// Statistics of one slice of the map.
struct SliceStatistics {
  int slice = 0;  ///< k index of the map
  Statistics statistics;
};

/// Which voxels of a region of interest are measured.
struct MeasureOptions {
  double confidenceThreshold = defaults::confidenceThreshold;  ///< of 1; 0 takes every voxel
  int erosion_pixels = 0;                                      ///< inner region of interest, in each slice
  double erosion_mm = 0.0;               ///< the same in millimetres from the outline; both may be given
  const image::Mask* exclude = nullptr;  ///< voxels to leave out (large vessels), on the map's grid; not eroded
  double poisson = defaults::poisson;    ///< for the conversion to the other modulus
};

/// Stiffness of a region of interest.
struct Measurement {
  StiffnessQuantity quantity = StiffnessQuantity::Shear;  ///< of every *_kPa below but youngs and shear
  Statistics pooled;
  MeanUncertainty uncertainty;          ///< of the pooled mean
  MeanInterval interval;                ///< of the pooled mean, by correlation length and by slices
  std::vector<SliceStatistics> slices;  ///< slices with region-of-interest voxels, in order of k
  double areaWeightedMean_kPa = 0.0;    ///< Σ (mean_i area_i) / Σ area_i over slices
  double youngs_mean_kPa = 0.0;         ///< pooled mean as E = 2 (1 + ν) µ
  double shear_mean_kPa = 0.0;          ///< pooled mean as µ
  double poisson = defaults::poisson;   ///< used for the conversion
  std::size_t drawn = 0;                ///< voxels of the region of interest as it was given
  std::size_t rim = 0;                  ///< of these left out by the erosion
  std::size_t excluded = 0;             ///< left out by MeasureOptions::exclude
  double meanOfAll_kPa = 0.0;           ///< pooled mean without leaving out rim and what is excluded
  std::size_t notFinite = 0;            ///< left out: not finite
  std::size_t notPositive = 0;          ///< left out: ≤ 0
  std::size_t lowConfidence = 0;        ///< left out: finite, > 0, below the threshold
  std::size_t noConfidence = 0;         ///< left out: finite, > 0, where the confidence map says nothing
  std::vector<std::string> warnings;    ///< "Pa or kPa?", most voxels left out; texts of diagnostics among them
  Diagnostics diagnostics;
};

/// Stiffness statistics inside a region of interest given on the map's own grid.
/// Throws BadInput where the mask is on another grid, empty, empty after erosion, or no voxel is left (with the
/// counts).
Measurement measure(const StiffnessMap& map, const image::Mask& roi, const MeasureOptions& options = {});

/// Of the mean over the voxels of counts, a mask on the map's grid.
MeanUncertainty meanUncertainty(const image::ScalarVolume& values_kPa, const image::Mask& counts);

/// Statistics of plain values, kPa; voxelArea_mm2 scales the area.
Statistics statisticsOf(std::vector<double> values_kPa, double voxelArea_mm2);

}  // namespace glisson::elastography
