// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/quantity.h"
#include "dicom/seg.h"
#include "dicom/series.h"

namespace glisson::dicom {

/// Stiffness statistics of one region, pooled over its slices or on one of them.
struct ReportedStiffness {
  std::string name;          ///< tracking identifier: "liver", "liver, slice 3"
  std::optional<int> slice;  ///< k index of source; empty: the whole segment
  std::size_t n = 0;
  double area_mm2 = 0.0, mean_kPa = 0.0, median_kPa = 0.0, sd_kPa = 0.0, min_kPa = 0.0, max_kPa = 0.0;
};

/// Writes a Comprehensive SR after TID 1500 (Imaging Measurement Report): per region N, area, and mean, median, SD,
/// least and largest elasticity (110830, DCM) in kPa, each with a modifier that names the modulus; tracking
/// identifiers; a reference to the segment (or its frame) and to the images measured. Numbers that are not finite are
/// left out. Throws BadArgument where there is nothing to report, BadInput where the file cannot be written.
void writeMeasurementReport(const std::filesystem::path& file, const std::vector<ReportedStiffness>& regions,
                            StiffnessQuantity quantity, const WrittenSegmentation& segmentation, const Series& source,
                            std::uint64_t seed);

}  // namespace glisson::dicom
