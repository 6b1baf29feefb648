#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "commands/outlines.h"
#include "dicom/series.h"
#include "session/parameters.h"

namespace glisson::session {

/// How stiffness is measured.
struct MeasureSettings {
  bool innerRoi = false;
  int erosion_pixels = 3;  ///< of the elastogram, where innerRoi is on
  bool operator==(const MeasureSettings&) const = default;
};

/// A case as it is kept: schema "glisson/case/1" (resources/schemas/case.schema.json). Beside case.json lie
/// contours.json and scene.json, which the command line reads; case.json holds their SHA-256, and its own.
struct CaseRecord {
  std::filesystem::path source;  ///< the DICOM folder, file or archive; written relative and absolute
  std::string seriesUid;         ///< of the image drawn on
  dicom::RoleOverrides roles;    ///< of series, set by hand
  commands::Outlines outlines;
  Parameters parameters;
  MeasureSettings measure;
  std::string sceneJson;  ///< text of scene.json
  int version = 0;        ///< grows by one with each saving; set by writeCaseRecord
};

inline constexpr int keptVersions = 10;

/// Writes contours.json, scene.json and case.json, each as a whole, case.json last; what was there before is kept in
/// versions/<n>/, the newest keptVersions of them. Returns the new version. Throws BadInput where the folder cannot be
/// written to: the case that was there stays readable.
int writeCaseRecord(const CaseRecord& record, const std::filesystem::path& folder);

/// Reads a case. file: case.json or its folder. Throws BadInput that names the file where anything differs from what
/// was saved (a flipped bit, an edit by hand), naming the newest version that is whole; and as readContours does.
CaseRecord readCaseRecord(const std::filesystem::path& file);

/// Versions that are kept beside a case, oldest first: folders that readCaseRecord takes.
std::vector<std::filesystem::path> versionsOf(const std::filesystem::path& folder);

/// Whether this is a case file, or a folder that holds one.
bool isCase(const std::filesystem::path& path);

}  // namespace glisson::session
