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

/// What the header of one image file says, checked. Text has been cleaned of control characters.
struct ImageHeader {
  std::filesystem::path file;
  FileLayout layout;
  std::string seriesUid, studyUid, frameOfReferenceUid, sopInstanceUid, sopClassUid;
  std::string patientKey;
  std::string modality, description, imageType, manufacturer, sequenceName, unit;
  int seriesNumber = 0;
  int rows = 0;
  int columns = 0;
  int samples = 1;
  int bitsAllocated = 16;
  int bitsStored = 16;
  bool isSigned = false;
  bool palette = false;
  bool mosaic = false;
  bool lossy = false;
  PixelKind kind = PixelKind::Integer;
  std::vector<Frame> frames;
  std::vector<std::string> warnings;

  bool colour() const { return samples > 1 || palette; }
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

/// Reads and checks the header of an image. Throws RefusedFile, with a reason that does not repeat the file's name.
ImageHeader readImageHeader(const std::filesystem::path& file, ByteSource& source);

}  // namespace glisson::dicom
