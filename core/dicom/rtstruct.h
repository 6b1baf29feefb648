// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "dicom/origin.h"
#include "dicom/series.h"

namespace glisson::dicom {

/// One closed planar contour of an RT Structure Set.
struct StructureContour {
  Eigen::Matrix3Xd points_lps_mm;        ///< 3 × n, not repeated at the end
  std::string referencedSopInstanceUid;  ///< empty where absent
  bool exclusiveOr = false;  ///< CLOSEDPLANAR_XOR: flips what it encloses; else CLOSED_PLANAR, a set of points
};

/// A region of interest of a structure set, with its contours.
struct Structure {
  int number = 0;
  std::string name;
  std::string frameOfReferenceUid;  ///< its own; empty where it names none
  std::vector<StructureContour> contours;
};

/// An image series that a structure set says it was drawn on.
struct ReferencedSeries {
  std::string frameOfReferenceUid, seriesUid;
};

/// An RT Structure Set.
struct StructureSet {
  Origin origin;                             ///< study: the one that it was drawn on
  std::string frameOfReferenceUid;           ///< the first one named
  std::string referencedSeriesUid;           ///< the first one named
  std::vector<ReferencedSeries> references;  ///< all, in order
  std::vector<Structure> structures;
  std::vector<std::string> warnings;
};

/// Reads an RT Structure Set (CLOSED_PLANAR and CLOSEDPLANAR_XOR contours; other types are listed in warnings).
/// A plain file is parsed here, all others in a process of their own with limits, as images are.
/// Throws BadInput (no RTSTRUCT, coordinates not finite or not a multiple of three ...).
StructureSet readRtStruct(const std::filesystem::path& file);

/// Writes an RT Structure Set that refers to the given image series: same patient and study as source (its first file),
/// new series and SOP UIDs derived from seed, SeriesDescription begins "RESEARCH", DS of at most 16 characters.
/// Contours inside others of the same plane are holes, written as keyholes (keyhole.h); a structure with contours that
/// flip what they enclose is written as CLOSEDPLANAR_XOR throughout.
void writeRtStruct(const std::filesystem::path& file, const StructureSet& structures, const Series& source,
                   std::uint64_t seed);

}  // namespace glisson::dicom
