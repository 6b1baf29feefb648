#include "pipeline/sources.h"

#include <algorithm>

#include "base/error.h"
#include "base/text.h"
#include "dicom/rtstruct.h"
#include "dicom/seg.h"
#include "elastography/roi_from_structures.h"
#include "image/io.h"
#include "pipeline/file_names.h"
#include "pipeline/region_file.h"
#include "roi/contour_io.h"
#include "roi/interpolate.h"
#include "roi/plane.h"

namespace glisson::pipeline {
namespace {

void append(std::vector<std::string>& to, const std::vector<std::string>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

/// What a series warns about, and the files left out where they are asked for. These words go into records.
std::vector<std::string> warningsOf(const dicom::ScanResult& scan, const dicom::Series& series, bool skipped) {
  constexpr std::size_t most = 20;
  const FileNames names(scan);
  std::vector<std::string> warnings;
  for (const std::string& w : series.warnings) warnings.push_back(names.hiddenIn(w));
  for (const dicom::SkippedFile& f : scan.skipped)
    if (skipped && warnings.size() < most)
      warnings.push_back("skipped " + names.placeOf(f.file) + ": " + names.hiddenIn(f.reason));
  return warnings;
}

/// The series of that role; where no series has it and there is only one, that one.
const dicom::Series& seriesFor(const dicom::ScanResult& scan, dicom::SeriesRole role) {
  const bool any = std::any_of(scan.series.begin(), scan.series.end(), [&](const auto& s) { return s.role == role; });
  if (!any && scan.series.size() == 1) return scan.series.front();
  return dicom::findRole(scan, role);
}

/// What speaks against taking this series as the stiffness, where it was not chosen by hand.
std::vector<std::string> doubtsAbout(const dicom::ScanResult& scan, const dicom::Series& taken) {
  const std::string which = "series " + std::to_string(taken.number);
  if (taken.role != dicom::SeriesRole::Stiffness)
    return {which + " was taken as the stiffness because it is the only one, but it was recognised as " +
            dicom::name(taken.role) + " (" + taken.roleReason + "): is it a stiffness map?"};
  std::string all;
  int count = 0;
  for (const dicom::Series& s : scan.series)
    if (s.role == dicom::SeriesRole::Stiffness) {
      all +=
          (count++ == 0 ? "" : ", ") + std::to_string(s.number) + " (" + std::to_string(s.grid.size.z()) + " slices)";
    }
  if (count < 2) return {};
  return {std::to_string(count) + " stiffness series are here: " + all + "; " + which + " with " +
          std::to_string(taken.grid.size.z()) +
          " slices was taken: give the folder of another, or its role with --role"};
}

/// The segment that is asked for: by label number, by name, else the one called liver, else the only one.
int segmentNumber(const dicom::SegmentationSet& set, const std::string& name, int label) {
  if (label != 0) return label;
  std::vector<int> found;
  std::string there;
  for (const dicom::Segment& s : set.segments) {
    there += (there.empty() ? "" : ", ") + std::to_string(s.number) + " '" + s.label + "'";
    const bool liver = s.propertyCode == "SCT:10200004" || s.propertyCode == "SRT:T-62000" ||
                       lowerCase(s.label).find("liver") != std::string::npos;
    if (name.empty() ? liver : lowerCase(s.label) == lowerCase(name)) found.push_back(s.number);
  }
  if (found.size() == 1) return found.front();
  if (name.empty() && set.segments.size() == 1) return set.segments.front().number;
  throw BadInput(std::string("the segmentation has ") + (found.empty() ? "no" : "several") +
                 " segments that fit; it holds " + there + ": choose one by its number (--label) or name (--name)");
}

}  // namespace

AnatomicalImage loadImage(const std::filesystem::path& path, const Progress& progress,
                          const dicom::RoleOverrides& roles) {
  AnatomicalImage out;
  if (std::filesystem::is_regular_file(path) && image::isVolumeFile(path)) {
    out.volume = image::readVolume(path);
    for (const auto& [which, role] : roles) out.rolesNotFound.push_back(which);
    return out;
  }
  dicom::ScanResult scan = dicom::scan(path, progress.part(0.0, 0.4));
  out.rolesNotFound = dicom::applyRoles(scan, roles);
  if (scan.series.empty())
    throw BadInput("no image series was found in '" + path.filename().string() + "'" +
                   (scan.skipped.empty() ? "" : ": " + scan.skipped.front().reason));
  const dicom::Series& series = seriesFor(scan, dicom::SeriesRole::Anatomical);
  out.volume = dicom::readSeries(series, progress.part(0.4, 1.0));
  out.frameOfReferenceUid = series.frameOfReferenceUid;
  out.patientKey = series.patientKey;
  out.studyDate = series.studyDate;
  out.studyUid = series.studyUid;
  out.warnings = warningsOf(scan, series, false);
  return out;
}

LoadedStiffness loadStiffness(const std::filesystem::path& path, const MapMeaning& meaning, const Progress& progress) {
  LoadedStiffness out;
  if (std::filesystem::is_regular_file(path) && image::isVolumeFile(path)) {
    if (!meaning.quantity || !meaning.unit)
      throw BadInput("'" + path.filename().string() +
                     "' is a bare map: say what it holds, quantity shear or youngs (--quantity) and unit Pa, kPa or "
                     "<factor>kPa (--unit)");
    out.map = elastography::makeStiffnessMap(image::readVolume(path), *meaning.quantity, *meaning.unit);
    for (const auto& [which, role] : meaning.roles) out.rolesNotFound.push_back(which);
    return out;
  }
  dicom::ScanResult scan = dicom::scan(path, progress.part(0.0, 0.4));
  out.rolesNotFound = dicom::applyRoles(scan, meaning.roles);
  if (scan.series.empty())
    throw BadInput("no image series was found in '" + path.filename().string() + "'" +
                   (scan.skipped.empty() ? "" : ": " + scan.skipped.front().reason));
  const dicom::Series& series = seriesFor(scan, dicom::SeriesRole::Stiffness);
  if (series.colour)
    throw BadInput("the series '" + series.description +
                   "' is in colour: a coloured elastogram is not a stiffness map; "
                   "choose the grey-scale stiffness series");
  const std::optional<std::string> unit = meaning.unit ? meaning.unit : series.unit;
  if (!unit)
    throw BadInput("the series '" + series.description +
                   "' does not say in which unit its stiffness is; give it with --unit (Pa, kPa or <factor>kPa), and "
                   "--quantity (shear or youngs) where it is not the shear modulus");
  // MR elastography reports the shear modulus unless told otherwise.
  out.map = elastography::makeStiffnessMap(dicom::readSeries(series, progress.part(0.4, 0.8)),
                                           meaning.quantity.value_or(StiffnessQuantity::Shear), *unit);
  if (std::none_of(meaning.roles.begin(), meaning.roles.end(),
                   [](const auto& given) { return given.second == dicom::SeriesRole::Stiffness; }))
    append(out.warnings, doubtsAbout(scan, series));
  if (meaning.unit && series.unit && *meaning.unit != *series.unit)
    out.warnings.push_back("the series says that its stiffness is in " + *series.unit + "; it was taken as " +
                           *meaning.unit + ", as asked for");
  if (meaning.quantity == StiffnessQuantity::Youngs)
    out.warnings.push_back(
        "the series was taken as Young's modulus, as asked for; MR elastography reports the shear modulus unless it "
        "says "
        "otherwise (a third of it)");
  out.map.frameOfReferenceUid = series.frameOfReferenceUid;
  out.patientKey = series.patientKey;
  out.studyDate = series.studyDate;
  out.studyUid = series.studyUid;
  append(out.warnings, warningsOf(scan, series, true));
  for (const dicom::Series& s : scan.series)
    if (s.role == dicom::SeriesRole::Confidence && !s.error && s.studyUid == series.studyUid) {
      elastography::attachConfidence(out.map, dicom::readSeries(s, progress.part(0.8, 1.0)));
      break;
    }
  if (!out.map.confidence)
    out.warnings.push_back("there is no confidence map: every voxel of the region of interest counts");
  return out;
}

void checkRolesFound(const dicom::RoleOverrides& roles, const std::vector<std::vector<std::string>>& notFound) {
  for (const auto& [which, role] : roles)
    if (std::all_of(notFound.begin(), notFound.end(), [&which](const std::vector<std::string>& list) {
          return std::find(list.begin(), list.end(), which) != list.end();
        }))
      throw BadInput("no series has the UID or number '" + which.substr(0, 70) +
                     "' that a role was given for; list them with: glisson-cli scan");
}

LoadedRoi loadRoi(const std::filesystem::path& path, const std::string& name, int label, const Progress& progress) {
  LoadedRoi out;
  if (std::filesystem::is_directory(path)) {
    // A folder with one structure set or one contour file in it.
    std::vector<std::filesystem::path> found;
    for (const auto& entry : std::filesystem::directory_iterator(path))
      if (entry.is_regular_file()) found.push_back(entry.path());
    std::sort(found.begin(), found.end());
    std::string last = "the folder is empty";
    for (const auto& file : found) {
      try {
        return loadRoi(file, name, label, progress);
      } catch (const BadInput& e) {
        last = e.what();
      }
    }
    throw BadInput("no region of interest was found in '" + path.filename().string() + "': " + last);
  }
  if (extensionOf(path) == ".json") {
    out.contours = roi::readContours(path);
  } else if (isRegionFile(path)) {
    out.mask = readRegion(path, label, std::nullopt, out.warnings);
  } else if (dicom::isSegmentation(path)) {
    const dicom::SegmentationSet set = dicom::readSegmentation(path);
    append(out.warnings, set.warnings);
    out.mask = dicom::maskOf(set, segmentNumber(set, name, label));
    out.frameOfReferenceUid = set.frameOfReferenceUid;
    out.origin = set.origin;
    out.referencedSeriesUid = set.referencedSeriesUid;
  } else {
    dicom::StructureSet set = dicom::readRtStruct(path);
    append(out.warnings, set.warnings);
    out.contours = elastography::roiFromStructures(set, name);
    if (out.contours->frameOfReferenceUid.empty()) out.contours->frameOfReferenceUid = set.frameOfReferenceUid;
    out.origin = set.origin;
  }
  if (out.contours) out.frameOfReferenceUid = out.contours->frameOfReferenceUid;
  if (label != 0 && !out.mask)
    out.warnings.push_back("a label picks a value of a mask; these are contours: it was not used");
  return out;
}

std::optional<std::string> completeOutlines(LoadedRoi& roi, const image::Grid& mriGrid) {
  if (!roi.contours) return std::nullopt;
  *roi.contours = roi::interpolateBetween(*roi.contours, mriGrid);
  // Outlines that a reader had interpolated before count like those interpolated just now.
  int drawn = 0, interpolated = 0;
  for (const std::vector<std::size_t>& members : roi::polygonsPerSlice(*roi.contours, mriGrid)) {
    const auto holds = [&](roi::PolygonState state) {
      return std::any_of(members.begin(), members.end(), [&](std::size_t p) {
        const roi::Polygon& polygon = roi.contours->polygons[p];
        return !polygon.exclude && polygon.state == state;
      });
    };
    if (holds(roi::PolygonState::Accepted))
      ++drawn;
    else if (holds(roi::PolygonState::Interpolated))
      ++interpolated;
  }
  const int empty = static_cast<int>(roi::emptySlicesBetween(*roi.contours, mriGrid).size());
  if (interpolated + empty == 0) return std::nullopt;
  std::string text = "outlines on " + std::to_string(drawn) + " of " + std::to_string(drawn + interpolated + empty) +
                     " slices; " + std::to_string(interpolated) + " slices between them were interpolated by shape";
  if (empty > 0)
    text += "; " + std::to_string(empty) + " slices stay empty, because the outlines next to them do not overlap";
  return text;
}

elastography::MappedRoi mapRoi(const LoadedRoi& roi, const std::optional<image::Grid>& mriGrid,
                               const elastography::StiffnessMap& map) {
  if (roi.contours) {
    LoadedRoi complete;
    complete.contours = roi.contours;
    const auto completed = mriGrid ? completeOutlines(complete, *mriGrid) : std::nullopt;
    elastography::MappedRoi mapped =
        elastography::mapRoi(*complete.contours, mriGrid, map.values_kPa.grid, map.frameOfReferenceUid);
    if (completed) mapped.warnings.push_back(*completed);
    return mapped;
  }
  if (roi.mask) {
    elastography::MappedRoi mapped = elastography::mapRoi(*roi.mask, map.values_kPa.grid);
    if (!roi.frameOfReferenceUid.empty() && !map.frameOfReferenceUid.empty() &&
        roi.frameOfReferenceUid != map.frameOfReferenceUid)
      mapped.warnings.push_back(
          "the segmentation and the elastogram have different frames of reference: check that they belong together");
    return mapped;
  }
  throw BadArgument("mapRoi: the region of interest is empty");
}

}  // namespace glisson::pipeline
