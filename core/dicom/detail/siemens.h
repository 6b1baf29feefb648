// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "dicom/detail/image_header.h"

class DcmDataset;

namespace glisson::dicom {

/// The named values of a Siemens CSA header (format SV10), each as text without padding; empty values are left out.
/// Throws BadInput where it is in another format or damaged.
std::map<std::string, std::vector<std::string>> csaValues(const std::uint8_t* bytes, std::size_t count);

/// Turns a mosaic (all slices of a volume tiled into one picture) into its slices: tile sizes and one frame per slice.
/// The number of slices and their direction are those of the CSA header; the picture's own position is that of a
/// picture of the mosaic's size around the first slice's centre. Throws BadInput where the header says too little.
void expandMosaic(DcmDataset& data, ImageHeader& header);

/// Encoding direction, time step and vibration frequency from the comment that research sequences for elastography
/// write, e.g. "MRE: fI[0]dI[1]az[270]po[90]tI[3]VP[50000]..." (VP: period in µs).
ElastographyStep elastographyStep(const std::string& comment);

}  // namespace glisson::dicom
