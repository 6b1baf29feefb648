// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "dicom/detail/image_header.h"
#include "dicom/series.h"

namespace glisson::dicom {

/// One slice of a volume, as its file describes it.
struct SliceFacts {
  const ImageHeader* header = nullptr;
  const Frame* frame = nullptr;
};

/// What the slices of one volume say together: unit, quantity, scale and acquisition; what they disagree in is told, or
/// becomes series.noScale. slices must not be empty.
void takeFacts(const std::vector<SliceFacts>& slices, Series& series);

}  // namespace glisson::dicom
