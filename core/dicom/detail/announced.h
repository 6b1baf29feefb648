// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "dicom/series.h"

class DcmDataset;

namespace glisson::dicom {

struct ImageHeader;

/// What an image says about the others that belong to it; 0 or empty where it says nothing.
struct Announced {
  int images = 0;                ///< of its acquisition (ImagesInAcquisition)
  int slices = 0;                ///< of its volume (NumberOfSlices, or the maker's own count)
  std::string concatenationUid;  ///< of a multi-frame object that was cut into several files
  int part = 0, parts = 0;       ///< which of these files it is, from 1, and of how many
};

/// Never throws: counts only cross-check what is there, so that a senseless one is as good as none.
Announced announcedBy(DcmDataset& data);

/// Says of each volume of a series that its headers announce more images or slices than are there.
void checkCounts(const std::vector<ImageHeader>& headers, std::vector<Series>& volumes);

/// Why the parts of a cut multi-frame object among the headers are no whole; empty where they are one (or none is cut).
std::string missingParts(const std::vector<const ImageHeader*>& headers);

}  // namespace glisson::dicom
