#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dicom/image_header.h"

namespace glisson::dicom {

/// Why the pixels of a transfer syntax cannot be decoded, naming the codec; nothing where they can.
std::optional<std::string> undecodable(const std::string& transferSyntax);

/// Whether a transfer syntax loses information.
bool isLossy(const std::string& transferSyntax);

/// The pixels of one file. Native ones are read at their place in the file; compressed ones are decoded frame by frame,
/// after the code stream has been seen to hold an image of the size that the header states.
class PixelReader {
 public:
  /// Throws BadInput where the transfer syntax cannot be decoded or the file cannot be parsed.
  PixelReader(const ImageHeader& header, const ByteSource& source);
  ~PixelReader();
  PixelReader(const PixelReader&) = delete;
  PixelReader& operator=(const PixelReader&) = delete;

  /// Writes rows × columns values of a frame with one sample per pixel, rescaled in double, columns fastest.
  /// Throws BadInput where the code stream is damaged or of another size.
  void read(const Frame& frame, float* values);

 private:
  struct Decoder;
  void checkCodeStreams() const;

  const ImageHeader& header_;
  const ByteSource& source_;
  std::unique_ptr<Decoder> decoder_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace glisson::dicom
