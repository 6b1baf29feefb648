// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "dicom/series.h"

namespace glisson::dicom {

/// A colour picture, row 0 at the top, 3 bytes a pixel, that already shows "Research use only" in its pixels.
struct CapturedPicture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
  std::string description;  ///< what it shows; at most 64 characters, no patient's
};

/// Writes a picture as Secondary Capture in the study of source. identifies: whether its pixels name the patient and
/// date (BurnedInAnnotation YES). All pictures of one seed share one series; number tells them apart. Throws
/// BadArgument where the picture is empty, BadInput where the file cannot be written.
void writeSecondaryCapture(const std::filesystem::path& file, const CapturedPicture& picture, int number,
                           bool identifies, const Series& source, std::uint64_t seed);

}  // namespace glisson::dicom
