// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "image/volume.h"

namespace glisson::dicom {

/// A unique identifier "2.25.<integer>" made of the first 128 bits of SHA-256(text): same text, same identifier.
std::string uidFrom(const std::string& text);

/// A decimal string (DS) of at most 16 characters that is as near to the value as 16 characters allow.
/// Throws BadArgument where the value is not finite.
std::string decimalString(double value);

/// What every image of one MR series has in common, as a GE scanner writes it.
struct MrSeriesHeader {
  std::string patientName = "PHANTOM";  ///< PN
  std::string patientId = "PHANTOM";
  std::string patientBirthDate;  ///< DA or empty (Type 2)
  std::string patientSex;        ///< CS or empty (Type 2)
  std::string studyUid;
  std::string studyId;
  std::string studyDescription;
  std::string date = "20200101";  ///< DA, of study, series, acquisition and content
  std::string time = "120000";    ///< TM
  std::string seriesUid;
  std::string frameOfReferenceUid;
  int seriesNumber = 1;
  std::string seriesDescription;
  std::vector<std::string> imageType{"ORIGINAL", "PRIMARY", "OTHER"};
  std::string scanningSequence = "GR";
  std::string sequenceVariant = "SS";
  std::string scanOptions;
  std::string acquisitionType = "2D";
  std::string pulseSequence;  ///< private (0019,109C): "fgremre", "epimre", "LAVA" ...
  std::string contrastAgent;  ///< empty: none given
  double repetitionTime_ms = 50.0;
  double echoTime_ms = 20.0;
  double flipAngle_deg = 25.0;
  double sliceThickness_mm = 0.0;  ///< 0: as the grid's spacing
  double windowCenter = 0.0;
  double windowWidth = 1.0;
  std::string derivation;  ///< DerivationDescription of a computed map; empty for acquired images
};

/// What was written, in slice order.
struct WrittenSeries {
  std::vector<std::filesystem::path> files;
  std::vector<std::string> sopInstanceUids;
};

/// Writes one MR Image Storage object per slice (signed 16 bit, Explicit VR Little Endian) into a folder that is made
/// where it is missing: IM-0001.dcm for k = 0 and so on. SOP instance UIDs derive from the series UID and k.
/// Throws BadInput where a file cannot be written, BadArgument where header or volume are unusable.
WrittenSeries writeMrSeries(const std::filesystem::path& folder, const MrSeriesHeader& header,
                            const image::Volume<std::int16_t>& volume);

/// The same for volumes of one grid that follow each other in time, in one series: slice k of step t is file and
/// instance t · slices + k + 1, and TemporalPositionIdentifier (of NumberOfTemporalPositions) t + 1 tells the steps
/// apart. Throws BadArgument where there is no step or their grids differ.
WrittenSeries writeMrSeries(const std::filesystem::path& folder, const MrSeriesHeader& header,
                            const std::vector<image::Volume<std::int16_t>>& steps);

/// The same for a colour picture of a map: RGB, 3 × 8 bit, MR-modality Secondary Capture with the geometry kept.
WrittenSeries writeMrColourSeries(const std::filesystem::path& folder, const MrSeriesHeader& header,
                                  const image::Volume<std::array<std::uint8_t, 3>>& volume);

}  // namespace glisson::dicom
