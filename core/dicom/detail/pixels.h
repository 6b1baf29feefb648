// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "dicom/detail/image_header.h"
#include "dicom/detail/reader_process.h"
#include "dicom/detail/stored_frames.h"

namespace glisson::dicom {

/// The measured values of one file, slice by slice. Pixels of a file that was parsed in a reader process are decoded
/// there; the others are read at their place in the file.
class PixelReader {
 public:
  /// file: where header was read from. Throws BadInput where the transfer syntax cannot be decoded or the file cannot
  /// be read.
  explicit PixelReader(const std::filesystem::path& file);
  ~PixelReader();

  const ImageHeader& header() const { return header_; }

  /// Writes sliceRows × sliceColumns values of a frame with one sample per pixel, rescaled in double, columns fastest.
  /// Throws BadInput or RefusedFile where the code stream is damaged or of another size.
  void read(const Frame& frame, float* values);

  /// Voxels that hold no value.
  struct Undefined {
    std::int64_t padding = 0, outsideRange = 0;
  };
  /// The same with not-a-number where a voxel is padding or its stored value is in no segment of the frame's map.
  Undefined readMap(const Frame& frame, float* values);

 private:
  /// Calls each(bytes, count, values) for each run of pixels of the frame.
  template <typename Each>
  void runs(const Frame& frame, float* values, const Each& each);
  const std::vector<std::uint8_t>& picture(int number);

  ImageHeader header_;
  std::unique_ptr<ByteSource> source_;
  std::unique_ptr<StoredFrames> here_;
  std::unique_ptr<IsolatedFile> elsewhere_;
  std::vector<std::uint8_t> bytes_;
  int held_ = -1;  ///< which picture bytes_ is
};

}  // namespace glisson::dicom
