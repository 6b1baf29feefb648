// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Structure sets and segmentations as they are parsed, here or in a reader process, and as messages of the latter.
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "dicom/file_layout.h"
#include "dicom/rtstruct.h"
#include "dicom/seg.h"

namespace glisson::dicom::detail {

inline constexpr std::size_t maxSegFrames = 100'000;
inline constexpr std::size_t maxSegments = 4096;

struct SegFrame {
  Eigen::Vector3d position_lps_mm = Eigen::Vector3d::Zero();
  int segment = 0;
  std::string sourceSopInstanceUid;  ///< empty where it names none
};

/// Segmentations of the older storage class hold one segment a frame; those of the newer one a label at every pixel.
inline constexpr const char* labelMapStorage = "1.2.840.10008.5.1.4.1.1.66.7";

/// What the header of a Segmentation says; its frames hold one byte a pixel once unpacked, or two (16-bit labels,
/// little-endian).
struct SegHeader {
  SegmentationSet about;  ///< segments without their masks
  int rows = 0, columns = 0, bits = 1;
  bool fractional = false;
  bool labelMap = false;  ///< pixels hold segment numbers, 0 for none; frames name no segment
  int maximum = 1;        ///< of a fractional frame
  Eigen::Vector3d row = Eigen::Vector3d::UnitX(), column = Eigen::Vector3d::UnitY();
  double rowSpacing_mm = 1.0, columnSpacing_mm = 1.0;
  std::optional<double> sliceSpacing_mm, thickness_mm;
  std::vector<SegFrame> frames;

  std::size_t pixels() const { return static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns); }
  /// Of a frame once unpacked.
  std::size_t frameBytes() const { return pixels() * (bits == 16 ? 2 : 1); }
};

/// Parse with DCMTK in the process that calls. Throw BadInput with a reason that does not name the file.
StructureSet parseStructures(const ByteSource& source, const FileLayout& layout);
SegHeader parseSegHeader(const ByteSource& source, const FileLayout& layout);

std::string toMessage(const StructureSet& set);
std::string toMessage(const SegHeader& header);

/// What a message says, checked: counts, finite numbers, ranges, clean text. Throw BadInput.
StructureSet structuresFrom(const std::string& message);
SegHeader segHeaderFrom(const std::string& message);

}  // namespace glisson::dicom::detail
