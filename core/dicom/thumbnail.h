// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "dicom/series.h"

namespace glisson::dicom {

/// A small grey picture, row 0 at the top, 0 black. Square pixels: slices with other row than column spacing keep their
/// shape.
struct Thumbnail {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> grey;
  std::string whyNone;  ///< a reason where there is no picture (width 0)
};

/// The middle slice of a series (the lower of two), averaged down so that its longer side has at most size_px pixels
/// and windowed from the 1st to the 99th percentile of its values (MONOCHROME1 is not turned over). Reads that slice
/// alone. No picture, with the reason: colours, unreadable series, pixels that may hold text about the patient
/// (BurnedInAnnotation YES, or a secondary capture that does not deny it). Throws BadArgument where size_px < 8.
Thumbnail thumbnail(const Series& series, int size_px = 128);

}  // namespace glisson::dicom
