#pragma once

#include <vector>

#include "dicom/image_header.h"
#include "dicom/series.h"

namespace glisson::dicom {

/// Guesses what the volumes of one SeriesInstanceUID are for, and sets role, roleReason and (where the vendor says so)
/// unit. header: any image of the series.
void setRoles(std::vector<Series>& volumes, const ImageHeader& header);

}  // namespace glisson::dicom
