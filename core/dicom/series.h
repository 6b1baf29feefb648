#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "image/volume.h"

namespace glisson::dicom {

/// What a series is for. Guessed, always with a reason; the user can correct it.
enum class SeriesRole { Anatomical, Magnitude, Wave, Stiffness, Confidence, ColourCopy, Other };

/// Lower-case name as used in JSON: "anatomical", "magnitude", "wave", "stiffness", "confidence", "colour-copy",
/// "other".
std::string name(SeriesRole role);

/// A file that takes no part, and why. Data, not an exception.
struct SkippedFile {
  std::filesystem::path file;
  std::string reason;
};

/// One volume's worth of files, ordered by position along the slice normal.
struct Series {
  std::string uid;  ///< SeriesInstanceUID (a suffix "#2" ... where one UID held several volumes: echoes, image types)
  std::string studyUid;
  std::string frameOfReferenceUid;  ///< empty where absent
  std::string patientKey;           ///< SHA-256 of the patient's identity: to tell patients apart, never to show
  std::string modality;
  std::string description;  ///< SeriesDescription, control characters removed
  int number = 0;           ///< SeriesNumber
  SeriesRole role = SeriesRole::Other;
  std::string roleReason;                    ///< a sentence
  std::vector<std::filesystem::path> files;  ///< in slice order; one entry for a multi-frame file
  std::vector<std::string> sopInstanceUids;  ///< in slice order (one for multi-frame)
  std::vector<int> frames;                   ///< of a multi-frame file: its frame (from 0) for every slice; else empty
  std::string sopClassUid;
  image::Grid grid;                 ///< LPS mm, from ImagePositionPatient along the normal
  bool colour = false;              ///< samples per pixel > 1 or palette
  std::optional<std::string> unit;  ///< "Pa", "kPa", ... where the role and the vendor say so
  std::vector<std::string> warnings;
  std::optional<std::string> error;  ///< why it cannot be read as a volume; readSeries throws BadInput with it
};

struct ScanResult {
  std::vector<Series> series;        ///< ordered by series number, then uid
  std::vector<SkippedFile> skipped;  ///< ordered by path
};

/// Reads every file below a folder (or one file, or a DICOMDIR's folder), whatever its extension; groups into series,
/// guesses roles, checks geometry. Never throws for a bad file: it is listed in skipped, with the reason. Special files
/// (FIFO, device, socket), links that leave the folder or loop, are skipped unopened.
/// Throws BadInput where the path does not exist.
ScanResult scan(const std::filesystem::path& path, const Progress& progress = {});

/// Pixel values with the rescale applied per slice (in double, stored as float), checked against the header before
/// anything is allocated. Throws BadInput (series.error, truncated pixels, colour, undecodable syntax: names file and
/// tag).
image::ScalarVolume readSeries(const Series& series, const Progress& progress = {});

/// The only series with this role, or the best of several by a stated rule. Throws BadInput where there is none, naming
/// the roles that are there.
const Series& findRole(const ScanResult& scan, SeriesRole role);

}  // namespace glisson::dicom
