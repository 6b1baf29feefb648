// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "dicom/detail/announced.h"
#include "dicom/file_layout.h"
#include "dicom/map_quantity.h"

namespace glisson::dicom {

/// How pixels are stored.
enum class PixelKind { Integer, Float, Double };

/// value = slope * stored + intercept
struct Rescale {
  double slope = 1.0;
  double intercept = 0.0;
  bool operator==(const Rescale&) const = default;
};

/// A run of stored values and what they mean: a line, or a table from the first one on.
struct ValueSegment {
  double first = 0.0, last = 0.0;  ///< stored values, both included
  Rescale line;
  std::vector<double> table;  ///< value of first, first + 1 ...; empty where the line holds
  bool operator==(const ValueSegment&) const = default;
};

/// A real-world value map. Stored values in none of its segments have no value.
using ValueMap = std::vector<ValueSegment>;

/// What is odd about the scale of a frame.
enum class ScaleDoubt {
  None,
  MapUsed,       ///< rescale and map differ; the map is used: the only one with a unit
  RescaleUsed,   ///< they differ; the rescale is used
  NoScale,       ///< a map gives neither slope nor table
  MapsDisagree,  ///< two maps of one quantity give different values: there is no telling
  UnitUnclear,   ///< a map names one unit by its code and another one in words
  TableUnread,   ///< stored values mean something by a modality look-up table only
};

/// What may tell two images of one position from each other, strongest first; WordsAboutValues never does.
enum class FrameKind {
  ImageType,
  ComplexComponent,
  PrivateImageType,
  Quantity,
  EchoNumber,
  EchoTime,
  InversionTime,
  DiffusionBValue,
  TemporalPosition,
  TriggerTime,
  AcquisitionNumber,
  TriggerDelay,
  FrameAcquisitionNumber,
  TimeIndex,
  DimensionIndex1,
  DimensionIndex2,
  DimensionIndex3,
  DimensionIndex4,
  DimensionIndex5,
  WordsAboutValues
};

/// One image plane: a file, or a frame of a multi-frame file.
struct Frame {
  int number = 0;  ///< in its file, from 0
  Eigen::Vector3d position_lps_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d row = Eigen::Vector3d::UnitX();     ///< unit vector of growing column index
  Eigen::Vector3d column = Eigen::Vector3d::UnitY();  ///< unit vector of growing row index
  double rowSpacing_mm = 1.0;                         ///< between rows
  double columnSpacing_mm = 1.0;                      ///< between columns
  std::optional<double> thickness_mm;
  std::optional<double> statedSpacing_mm;  ///< SpacingBetweenSlices: cross-checked only
  Rescale rescale;
  int map = -1;  ///< of the header's maps: the one that holds instead of rescale; -1 where the rescale does
  ScaleDoubt scaleDoubt = ScaleDoubt::None;
  std::string unit;  ///< of the values, in the words of base/map_unit.h where it is one of those; empty where unknown
  std::optional<MapQuantity> quantity;                   ///< where a code says so
  std::vector<std::pair<FrameKind, std::string>> kinds;  ///< with the value of each that the file has
};

/// How the slices of a Siemens mosaic lie in its one picture: row by row, perRow beside each other.
struct MosaicTile {
  int rows = 0;  ///< of one slice; 0 where the image is no mosaic
  int columns = 0;
  int perRow = 0;
};

/// The step of a raw elastography acquisition that an image belongs to; -1 or 0 where unknown.
struct ElastographyStep {
  int direction = -1;  ///< of motion encoding, from 0
  int time = -1;       ///< time step in the vibration period, from 0
  int frequency = -1;  ///< from 0
  double vibration_Hz = 0.0;
};

/// What the header of one image file says, checked. Text has been cleaned of control characters.
struct ImageHeader {
  std::filesystem::path file;
  FileLayout layout;
  std::string seriesUid, studyUid, frameOfReferenceUid, sopInstanceUid, sopClassUid;
  std::string patientKey;
  std::string studyDate;  ///< to compare, never to show
  std::string modality, description, imageType, manufacturer, sequenceName;
  std::string acquisitionUid;
  std::optional<int> acquisitionNumber;
  std::optional<double> acquisition_s;  ///< when it was acquired, seconds since some day; to compare, never to show
  std::vector<std::string> references;  ///< UIDs of series and images that it was made of or refers to
  std::vector<ValueMap> maps;
  std::optional<std::pair<double, double>> padding;  ///< stored values from, to: no image there
  std::optional<double> privateScale;                ///< Philips' own: value = rescaled / (slope * this)
  int seriesNumber = 0;
  int rows = 0;
  int columns = 0;
  int samples = 1;
  int bitsAllocated = 16;
  int bitsStored = 16;
  bool isSigned = false;
  bool palette = false;
  bool lossy = false;
  bool burnedIn = false;  ///< says that its pixels hold text about the patient
  bool isolated = false;  ///< was parsed in a reader process, which decodes its pixels too
  int instanceNumber = 0;
  Announced announced;
  std::filesystem::path contradicted;  ///< another file of this SOP instance and place with other pixels; else empty
  MosaicTile tile;
  ElastographyStep step;
  PixelKind kind = PixelKind::Integer;
  std::vector<Frame> frames;  ///< of a mosaic: its slices
  std::vector<std::string> warnings;

  bool isMosaic() const { return tile.rows > 0; }
  int sliceRows() const { return isMosaic() ? tile.rows : rows; }
  int sliceColumns() const { return isMosaic() ? tile.columns : columns; }
  bool colour() const { return samples > 1 || palette; }
  /// Of one stored picture: a frame, or a whole mosaic.
  std::uint64_t frameBytes() const {
    return static_cast<std::uint64_t>(rows) * static_cast<std::uint64_t>(columns) *
           static_cast<std::uint64_t>(samples) * static_cast<std::uint64_t>(bitsAllocated / 8);
  }
};

/// Identity of a file that was refused after its series was known: a series with such a file is incomplete.
struct RefusedFile : Error {
  RefusedFile() : Error("a file was refused") {}
  std::string reason;
  std::string seriesUid;     ///< empty where unknown, or where the file holds no image
  bool outOfMemory = false;  ///< there may be more of it another time
  const char* what() const noexcept override { return reason.c_str(); }
};

/// Reads and checks the header of an image in this process. Throws RefusedFile, with a reason that does not repeat the
/// file's name. For files of unknown origin: readHeaderSafely (reader_process.h).
ImageHeader readImageHeader(const std::filesystem::path& file, ByteSource& source);
/// The same where the layout is known already.
ImageHeader readImageHeader(const std::filesystem::path& file, const ByteSource& source, const FileLayout& layout);

}  // namespace glisson::dicom
