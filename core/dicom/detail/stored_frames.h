// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dicom/detail/image_header.h"

namespace glisson::dicom {

/// Why the pixels of a transfer syntax cannot be decoded, naming the codec; nothing where they can.
std::optional<std::string> undecodable(const std::string& transferSyntax);

/// Whether a transfer syntax always loses information.
bool isLossy(const std::string& transferSyntax);

/// Whether the code stream of a JPEG 2000 image was made with the wavelet that cannot be undone exactly.
bool hasLossyWavelet(const ImageHeader& header, const ByteSource& source);

/// The stored pixels of one file, decoded in this process. Native ones are read at their place in the file; compressed
/// ones are decoded frame by frame, after the code stream has been seen to hold an image of the size that the header
/// states.
class StoredFrames {
 public:
  /// Throws BadInput where the transfer syntax cannot be decoded or the file cannot be parsed.
  StoredFrames(const ImageHeader& header, const ByteSource& source);
  ~StoredFrames();
  StoredFrames(const StoredFrames&) = delete;
  StoredFrames& operator=(const StoredFrames&) = delete;

  /// header.frameBytes() bytes of a stored picture, little endian. Throws BadInput where the code stream is damaged or
  /// of another size.
  std::vector<std::uint8_t> read(int frame);

 private:
  struct Decoder;
  std::vector<std::uint8_t> readNative(int frame) const;

  const ImageHeader& header_;
  const ByteSource& source_;
  std::unique_ptr<Decoder> decoder_;
};

}  // namespace glisson::dicom
