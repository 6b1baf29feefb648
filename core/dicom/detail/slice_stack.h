// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

namespace glisson::dicom {

/// Positions that were rounded to a tenth of a millimetre lie this near to where they are meant.
inline constexpr double roundedWithin_mm = 0.1;

/// The even spacing nearest to a stack of slices.
struct SliceStack {
  double first_mm = 0.0, step_mm = 0.0;  ///< where its first slice is, and how far apart they are
  double off_mm = 0.0;                   ///< largest distance of a slice from its place
  double smallest_mm = 0.0;              ///< between two slices that follow each other
  bool even = false;                     ///< off_mm is within rounding, or a hundredth of the spacing
  bool exact = false;                    ///< not even rounding shows
  std::size_t odd = 1;                   ///< where not even: the slice whose distance from the one before is oddest
  /// Where even: places without a slice, at most ten, each with the slice that follows.
  struct Gap {
    double at_mm;
    std::size_t before;
  };
  std::vector<Gap> missing;
};

/// along_mm: at least two positions, ascending, no two equal. A line is fitted to whole multiples of the usual
/// distance.
SliceStack stackOf(const std::vector<double>& along_mm);

}  // namespace glisson::dicom
