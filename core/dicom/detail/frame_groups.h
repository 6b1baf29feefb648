// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "dicom/detail/image_header.h"

class DcmDataset;

namespace glisson::dicom {

/// Fills header.frames: position, orientation, spacing, rescale and kinds of every frame, from the functional groups of
/// a multi-frame file or from the data set of a single image. frames has been checked against the pixel data. Throws
/// BadInput, naming the attribute (and the frame).
void readFrames(DcmDataset& data, std::uint64_t frames, ImageHeader& header);

}  // namespace glisson::dicom
