// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

namespace glisson::dicom::detail {

/// What the main header of a JPEG 2000 code stream says; zero where it is none.
struct Jpeg2000Size {
  std::int64_t width = 0;
  std::int64_t height = 0;
  int components = 0;
  int bits = 0;
  bool isSigned = false;
  bool reversible = false;  ///< wavelet 5-3, which can be undone exactly
};

/// Reads the size without decoding; stream may also be a JP2 file, whose code stream is looked for.
Jpeg2000Size jpeg2000Size(const std::vector<std::uint8_t>& stream);

/// Decodes one grey component into little-endian words of bytesPerPixel (1 or 2), two's complement. Throws BadInput
/// where the stream is damaged or of another size.
std::vector<std::uint8_t> decodeJpeg2000(const std::vector<std::uint8_t>& stream, int rows, int columns,
                                         int bytesPerPixel);

}  // namespace glisson::dicom::detail
