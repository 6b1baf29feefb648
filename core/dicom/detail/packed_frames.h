// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "dicom/file_layout.h"

namespace glisson::dicom {

/// The frames of a segmentation, 1 or 8 bits a pixel: native, run-length or deflated. Throws BadInput for another
/// transfer syntax (naming it), pixels that are truncated, and code streams of another size.
class PackedFrames {
 public:
  PackedFrames(const ByteSource& source, const FileLayout& layout, std::size_t frames, std::size_t pixelsPerFrame,
               int bits);
  /// One byte a pixel: 0 or 1 where bits is 1.
  std::vector<std::uint8_t> frame(std::size_t n) const;

 private:
  const ByteSource& source_;
  const FileLayout& layout_;
  std::size_t pixels_;
  int bits_;
};

}  // namespace glisson::dicom
