#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dicom/file_layout.h"

namespace glisson::dicom {

enum class PixelKind { Integer, Float, Double };

/// value = slope * stored + intercept
struct Rescale {
  double slope = 1.0;
  double intercept = 0.0;
  bool operator==(const Rescale&) const = default;
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
  /// What may tell two images of one position apart, strongest first: {attribute, value}.
  std::vector<std::pair<std::string, std::string>> kinds;
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
  std::string modality, description, imageType, manufacturer, sequenceName, unit;
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
struct RefusedFile : std::exception {
  std::string reason;
  std::string seriesUid;  ///< empty where unknown, or where the file holds no image
  const char* what() const noexcept override { return reason.c_str(); }
};

/// Reads and checks the header of an image in this process. Throws RefusedFile, with a reason that does not repeat the
/// file's name. For files of unknown origin: readHeaderSafely (reader_process.h).
ImageHeader readImageHeader(const std::filesystem::path& file, ByteSource& source);
/// The same where the layout is known already.
ImageHeader readImageHeader(const std::filesystem::path& file, const ByteSource& source, const FileLayout& layout);

}  // namespace glisson::dicom
