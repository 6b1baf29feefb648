// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/progress.h"
#include "dicom/series.h"

namespace glisson::session {

/// A region that lies beside the images of a folder and could be taken as outlines.
struct OfferedRegion {
  enum class Kind { Structure, Segment, Mask, Contours } kind = Kind::Mask;
  std::filesystem::path file;
  std::string name;  ///< of structure, segment or contours; empty for masks
  int number = 0;    ///< of structure or segment; label of a mask, 0 where it holds only one
};

/// Structures of RT Structure Sets, segments of DICOM Segmentations, contour files and volume files that look like
/// masks (each of their labels), among what a scan found and left out. At most 64 files are looked at; what cannot be
/// read is passed over, since the list of files left out says why. In order of file and number.
std::vector<OfferedRegion> offeredRegions(const dicom::ScanResult& scan, const Progress& progress = {});

}  // namespace glisson::session
