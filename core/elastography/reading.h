// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "elastography/statistics.h"

namespace glisson::elastography {

/// A measured change of a liver's stiffness by this share of the mean, or more, is a true change with 95 % confidence:
/// the repeatability coefficient of 2-D gradient-echo elastography at 60 Hz [qiba2022mre].
inline constexpr double repeatabilityCoefficient = 0.19;

/// A mean over less than this, over all slices or on one, hangs on a few waves: said, and still given. Our own limits.
inline constexpr double smallestRegion_mm2 = 500.0, smallestOnSlice_mm2 = 100.0;

/// Why a slice says nothing, or little, about the liver's stiffness.
enum class SliceFault {
  None,
  NoReliableWave,  ///< technical failure: outlined, and not one voxel counts
  MostlyWithout,   ///< less than a tenth of what is outlined counts
  Small            ///< less than smallestOnSlice_mm2 counts
};
const char* nameOf(SliceFault fault);  ///< as in JSON: "no-reliable-wave"

/// What is wrong with a slice by its statistics; the weightiest where there is more.
SliceFault faultOf(const Statistics& slice);

/// What a reader has to know beside a mean, after the QIBA profile's list for reading liver elastography [qiba2022mre].
struct Reading {
  double shareMeasured = 0.0;     ///< of the voxels that were outlined, 0 to 1
  double meanChange = 0.0;        ///< what leaving out the rim and what is excluded changed, relative to without
  double changeToBeReal_kPa = 0;  ///< repeatabilityCoefficient of the mean
  bool small = false;             ///< less than smallestRegion_mm2 counts
  /// A slice and what is wrong with it.
  struct Slice {
    int slice = 0;  ///< k index of the map
    SliceFault fault = SliceFault::None;
  };
  std::vector<Slice> slices;  ///< as in Measurement::slices
  int failed = 0;             ///< slices without a reliable wave
};

/// That of a measurement.
Reading readingOf(const Measurement& measurement);

}  // namespace glisson::elastography
