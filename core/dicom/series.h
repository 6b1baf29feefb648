// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "base/progress.h"
#include "dicom/map_quantity.h"
#include "image/volume.h"

namespace glisson::dicom {

/// What a series is for. Guessed, always with a reason; the user can correct it.
enum class SeriesRole { Anatomical, Magnitude, Wave, Stiffness, Confidence, ColourCopy, Other, Phase };

/// Lower-case name as used in JSON: "anatomical", "magnitude", "wave", "stiffness", "confidence", "colour-copy",
/// "other", "phase" (raw phase images of an elastography acquisition).
std::string name(SeriesRole role);

/// The role of that name. Throws BadInput with the names that there are.
SeriesRole roleNamed(const std::string& name);

/// A file that takes no part, and why. Data, not an exception.
struct SkippedFile {
  std::filesystem::path file;
  std::string reason;
};

/// What the files say about how a volume came about: to tell what belongs to one acquisition.
struct Acquired {
  std::string uid;                      ///< AcquisitionUID; empty where absent, or where slices differ
  std::optional<int> number;            ///< AcquisitionNumber, where all slices have the same
  std::optional<double> time_s;         ///< of its earliest slice; to compare, never to show
  std::vector<std::string> references;  ///< UIDs of series and images that it was made of or refers to
  std::string manufacturer, sequenceName, imageType;
  bool phaseCoded = false;             ///< GE's private image type is not magnitude
  bool elastographyStep = false;       ///< names its time step in a vibration period
  bool rescaled = false;               ///< values are not the stored ones
  std::optional<double> privateScale;  ///< Philips' own, where it differs from the rescale and no unit is named
};

/// One volume's worth of files, ordered by position along the slice normal.
struct Series {
  std::string uid;  ///< SeriesInstanceUID (a suffix "#2" ... where one UID held several volumes: echoes, image types)
  std::string studyUid;
  std::string frameOfReferenceUid;  ///< empty where absent
  std::string patientKey;           ///< SHA-256 of the patient's identity: to tell patients apart, never to show;
                                    ///< empty where the files name none
  std::string modality;
  std::string description;  ///< SeriesDescription, control characters removed
  int number = 0;           ///< SeriesNumber
  SeriesRole role = SeriesRole::Other;
  std::string roleReason;                    ///< a sentence
  std::vector<std::filesystem::path> files;  ///< in slice order; one entry for a multi-frame file
  std::vector<std::string> sopInstanceUids;  ///< in slice order (one for multi-frame)
  std::vector<int> frames;  ///< of a multi-frame file or mosaic: its frame (from 0) for every slice; else empty
  std::string sopClassUid;
  image::Grid grid;                     ///< LPS mm, from ImagePositionPatient along the normal
  std::string studyDate;                ///< as in the file, to compare, never to show
  bool colour = false;                  ///< samples per pixel > 1 or palette
  bool lossy = false;                   ///< compressed with loss: values are not the measured ones
  bool burnedIn = false;                ///< its pixels may hold text about the patient
  int temporalIndex = -1;               ///< time step, from 0, where volumes of one series follow each other; else -1
  int encodingDirection = -1;           ///< of motion (raw elastography), from 0; -1 where not known
  std::optional<double> vibration_Hz;   ///< of a raw elastography acquisition, where the file says so
  std::optional<std::string> unit;      ///< "Pa", "kPa", ... where the role and the vendor say so
  std::vector<int> fileOfSlice;         ///< of a multi-frame object cut into several files: which of files; else empty
  std::vector<double> unevenSlices_mm;  ///< where slices lie unevenly or one is missing (error says so): heights above
                                        ///< the first one along the normal; else empty
  std::optional<MapQuantity> quantity;  ///< where a code of the file says so
  bool masked = false;                  ///< a stiffness map that is called a masked copy: without what is not trusted
  Acquired acquired;
  std::vector<std::string> warnings;  ///< texts, those of diagnostics among them
  Diagnostics diagnostics;
  std::optional<std::string> error;    ///< why it cannot be read as a volume; readSeries throws BadInput with it
  std::optional<std::string> noScale;  ///< why its values are no measure (two scales); readMap throws BadInput with it
  std::shared_ptr<const void> folder;  ///< keeps the private folder of an unpacked archive while files are needed
};

/// What lies below a folder.
struct ScanResult {
  std::vector<Series> series;        ///< ordered by series number, then uid
  std::vector<SkippedFile> skipped;  ///< ordered by path
};

/// Reads every file below a folder, whatever its extension; or one file; or what a DICOMDIR lists (and no more; what is
/// missing is in skipped); or a ZIP archive, unpacked into a private folder (mode 0700) that lives as long as a series
/// of it. Groups into series, guesses roles, checks geometry. Never throws for a bad file: it is listed in skipped,
/// with the reason. Special files (FIFO, device, socket), links that leave the folder or loop, are skipped unopened.
/// Plain files are parsed here, all others in a process of their own with limits (readerProgram).
/// Throws BadInput where the path does not exist.
ScanResult scan(const std::filesystem::path& path, const Progress& progress = {});

/// Pixel values with the rescale applied per slice (in double, stored as float), checked against the header before
/// anything is allocated. Throws BadInput (series.error, truncated pixels, colour, undecodable syntax: names file and
/// tag).
image::ScalarVolume readSeries(const Series& series, const Progress& progress = {});

/// A map with what of it holds no value, as not-a-number: padding, and stored values that its scale is not defined for.
struct ReadMap {
  image::ScalarVolume values;
  std::int64_t padding = 0;       ///< voxels
  std::int64_t outsideRange = 0;  ///< voxels
};

/// As readSeries, for maps whose values are measured.
ReadMap readMap(const Series& series, const Progress& progress = {});

/// Adds a diagnostic and its text.
void tell(Series& series, DiagnosticCode code, std::vector<std::pair<std::string, DiagnosticValue>> arguments = {});

/// The series without its error where that is only that slices lie unevenly or one is missing (unevenSlices_mm): for
/// statistics, which count each slice by itself. Its grid is then no place but a stack, as far apart as the nearest
/// two.
Series asStack(const Series& series);

/// The only series with this role, or the best of several by a stated rule. Throws BadInput where there is none, naming
/// the roles that are there.
const Series& findRole(const ScanResult& scan, SeriesRole role);

/// Roles set by hand: a series by its uid (of all its volumes where no "#n" is given) or its number.
using RoleOverrides = std::map<std::string, SeriesRole>;

/// Gives the series named in overrides their role, with the reason "set by hand"; findRole prefers them to guessed
/// ones. Returns the names that no series has.
std::vector<std::string> applyRoles(ScanResult& scan, const RoleOverrides& overrides);

/// The program that parses and decodes what is not plain, in a process of its own: set by setReaderProgram, else
/// glisson-reader beside the running program, in ../libexec/glisson or in ../glisson-reader. Empty where there is none:
/// then such files are skipped, with a reason that says so, and plain ones are read as ever.
std::filesystem::path readerProgram();
void setReaderProgram(const std::filesystem::path& program);

}  // namespace glisson::dicom
