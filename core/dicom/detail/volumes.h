// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "dicom/detail/image_header.h"
#include "dicom/series.h"

namespace glisson::dicom {

/// Turns the images of one SeriesInstanceUID into volumes: splits images of one position by what tells them apart
/// (echo, image type, time ...), orders by position along the normal, checks the geometry. What cannot be one regular
/// volume gets an error that names the files; nothing is averaged or interleaved. headers must not be empty; roles are
/// not set here.
std::vector<Series> buildVolumes(const std::vector<ImageHeader>& headers);

}  // namespace glisson::dicom
