// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "dicom/detail/image_header.h"

class DcmItem;

namespace glisson::dicom {

/// Decides which scale holds for a frame, and its unit and quantity: the rescale where it names a unit of stiffness,
/// else the real-world value map that does, else the rescale, else the map. transformation: holds the rescale; mapping:
/// holds the RealWorldValueMappingSequence, null where there is none. Throws BadInput for a rescale that is no scale.
void readValues(DcmItem& transformation, DcmItem* mapping, Frame& frame, ImageHeader& header);

/// PixelPaddingValue and its range limit, for integers and floating point numbers.
void readPadding(DcmItem& data, ImageHeader& header);

}  // namespace glisson::dicom
