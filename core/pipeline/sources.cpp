// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/sources.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>

#include "base/error.h"
#include "base/sha256.h"
#include "base/text.h"
#include "dicom/file_layout.h"
#include "dicom/roles.h"
#include "dicom/rtstruct.h"
#include "dicom/seg.h"
#include "elastography/roi_from_structures.h"
#include "image/io.h"
#include "pipeline/file_names.h"
#include "pipeline/region_file.h"
#include "roi/contour_io.h"

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

/// Adds diagnostics and their texts.
template <typename Loaded>
void tell(Loaded& to, const Diagnostics& said) {
  to.diagnostics.add(said);
  append(to.warnings, said.texts());
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

/// Every series as dicom::asStack.
dicom::ScanResult asStacks(dicom::ScanResult scan) {
  for (dicom::Series& s : scan.series) s = dicom::asStack(s);
  return scan;
}

/// Whether a series whose slices lie unevenly has them where the map's lie.
bool usableBeside(const dicom::Series& series, const elastography::StiffnessMap& map) {
  const image::Grid& grid = map.values_kPa.grid;
  const double apart_mm = (series.grid.origin_lps_mm - grid.origin_lps_mm).dot(grid.direction.col(2));
  return std::abs(apart_mm) < 0.1 && map.unevenSlices_mm.size() == series.unevenSlices_mm.size() &&
         std::equal(map.unevenSlices_mm.begin(), map.unevenSlices_mm.end(), series.unevenSlices_mm.begin(),
                    [](double a, double b) { return std::abs(a - b) < 0.1; });
}

std::vector<std::pair<std::string, DiagnosticValue>> unevenness(const dicom::Series& series) {
  double smallest = 1e300, largest = 0.0;
  for (std::size_t k = 1; k < series.unevenSlices_mm.size(); ++k) {
    const double gap = series.unevenSlices_mm[k] - series.unevenSlices_mm[k - 1];
    smallest = std::min(smallest, gap);
    largest = std::max(largest, gap);
  }
  return {{"slices", static_cast<std::int64_t>(series.unevenSlices_mm.size())},
          {"smallest_mm", smallest},
          {"largest_mm", largest}};
}

/// Attaches the confidence series that goes with the map; of a map whose slices lie unevenly only one with the same
/// slices.
void takeConfidence(const dicom::Series& series, const MapMeaning& meaning, LoadedStiffness& out, Diagnostics& said,
                    const Progress& progress) {
  if (out.map.unevenSlices_mm.empty()) {
    readConfidence(series, meaning.confidenceScale, out.map, said, progress);
  } else if (usableBeside(series, out.map)) {
    dicom::Series stack = dicom::asStack(series);
    stack.grid.spacing_mm.z() = out.map.values_kPa.grid.spacing_mm.z();
    readConfidence(stack, meaning.confidenceScale, out.map, said, progress);
  } else {
    said.add(DiagnosticCode::ConfidenceOnOtherSlices, {{"series", static_cast<std::int64_t>(series.number)}});
    out.acquisition.confidence = -1;
  }
}

/// By the code of its property.
bool isLiver(const dicom::Segment& s) {
  return s.propertyCode == "SCT:10200004" || s.propertyCode == "SRT:T-62000";
}

/// The segment that is asked for: by label number, by name, else the one called liver, else the only one.
int segmentNumber(const dicom::SegmentationSet& set, const std::string& name, int label, Diagnostics& said) {
  if (label != 0) return label;
  const auto doubt = [&](const dicom::Segment& s, const char* that) {
    if (name.empty() && !isLiver(s) && !elastography::organNames(s.label))
      said.add(DiagnosticCode::StructureByName, {{"kind", std::string("segment")},
                                                 {"number", static_cast<std::int64_t>(s.number)},
                                                 {"that", std::string(that)}});
    return s.number;
  };
  std::vector<const dicom::Segment*> found;
  std::string there;
  for (const dicom::Segment& s : set.segments) {
    there += (there.empty() ? "" : ", ") + std::to_string(s.number) + " '" + s.label + "'";
    const bool liver = isLiver(s) || lowerCase(s.label).find("liver") != std::string::npos;
    if (name.empty() ? liver : lowerCase(s.label) == lowerCase(name)) found.push_back(&s);
  }
  if (found.size() == 1) return doubt(*found.front(), "with 'liver' in its name");
  if (name.empty() && set.segments.size() == 1) return doubt(set.segments.front(), "there");
  throw BadInput(std::string("the segmentation has ") + (found.empty() ? "no" : "several") +
                 " segments that fit; it holds " + there + ": choose one by its number (--label) or name (--name)");
}

/// Whether a file could hold a region of interest; images of a folder are passed over without being parsed.
bool mayBeRoi(const std::filesystem::path& file) {
  try {
    dicom::ByteSource source(file);
    const std::string sop = dicom::readLayout(source).sopClassUid;
    constexpr const char* structureSet = "1.2.840.10008.5.1.4.1.1.481.3";
    constexpr const char* segmentations = "1.2.840.10008.5.1.4.1.1.66";
    return sop.empty() || sop == structureSet || sop.starts_with(segmentations);
  } catch (const BadInput&) {
    return true;  // no DICOM file, or one that only another reader understands
  }
}

/// The only region of interest below a folder; files of the same bytes are one.
LoadedRoi onlyRoiIn(const std::filesystem::path& folder, const std::string& name, int label, const Progress& progress) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::string last = "the folder is empty", names;
  std::vector<LoadedRoi> found;
  std::set<std::string> seen;
  for (const auto& file : files) {
    if (!mayBeRoi(file)) continue;
    try {
      LoadedRoi roi = loadRoi(file, name, label, progress);
      if (!seen.insert(sha256OfFile(file)).second) continue;
      found.push_back(std::move(roi));
      names += (names.empty() ? "'" : ", '") + file.filename().string() + "'";
    } catch (const BadInput& e) {
      last = e.what();
    }
  }
  if (found.size() > 1)
    throw BadInput("'" + folder.filename().string() + "' holds " + std::to_string(found.size()) +
                   " regions of interest: " + names + "; give the file that is meant");
  if (found.empty()) throw BadInput("no region of interest was found in '" + folder.filename().string() + "': " + last);
  return std::move(found.front());
}

}  // namespace

AnatomicalImage loadImage(const std::filesystem::path& path, const Progress& progress,
                          const dicom::RoleOverrides& roles, const OutlineNames& outlined) {
  AnatomicalImage out;
  if (std::filesystem::is_regular_file(path) && image::isVolumeFile(path)) {
    out.volume = image::readVolume(path, &out.diagnostics);
    append(out.warnings, out.diagnostics.texts(Severity::Warning));
    for (const auto& [which, role] : roles) out.rolesNotFound.push_back(which);
    return out;
  }
  const auto scan = std::make_shared<dicom::ScanResult>(dicom::scan(path, progress.part(0.0, 0.4)));
  out.rolesNotFound = dicom::applyRoles(*scan, roles);
  out.scan = scan;
  if (scan->series.empty())
    throw BadInput("no image series was found in '" + path.filename().string() + "'" +
                   (scan->skipped.empty() ? "" : ": " + scan->skipped.front().reason));
  Diagnostics said;
  const dicom::Series& series = seriesFor(*scan, dicom::SeriesRole::Anatomical, outlined, said);
  out.series = static_cast<int>(&series - scan->series.data());
  out.volume = dicom::readSeries(series, progress.part(0.4, 1.0));
  out.frameOfReferenceUid = series.frameOfReferenceUid;
  out.patientKey = series.patientKey;
  out.studyDate = series.studyDate;
  out.studyUid = series.studyUid;
  out.warnings = warningsOf(*scan, series, false);
  out.diagnostics.add(series.diagnostics);
  tell(out, said);
  return out;
}

LoadedStiffness loadStiffness(const std::filesystem::path& path, const MapMeaning& meaning, const Progress& progress) {
  LoadedStiffness out;
  if (std::filesystem::is_regular_file(path) && image::isVolumeFile(path)) {
    if (!meaning.quantity || !meaning.unit)
      throw BadInput("'" + path.filename().string() +
                     "' is a bare map: say what it holds, quantity shear or youngs (--quantity) and unit Pa, kPa or "
                     "<factor>kPa (--unit)");
    out.map =
        elastography::makeStiffnessMap(image::readVolume(path, &out.diagnostics), *meaning.quantity, *meaning.unit);
    append(out.warnings, out.diagnostics.texts(Severity::Warning));
    for (const auto& [which, role] : meaning.roles) out.rolesNotFound.push_back(which);
    return out;
  }
  const auto scan = std::make_shared<dicom::ScanResult>(dicom::scan(path, progress.part(0.0, 0.4)));
  out.rolesNotFound = dicom::applyRoles(*scan, meaning.roles);
  out.scan = scan;
  if (scan->series.empty())
    throw BadInput("no image series was found in '" + path.filename().string() + "'" +
                   (scan->skipped.empty() ? "" : ": " + scan->skipped.front().reason));
  Diagnostics said;
  const dicom::Series& series =
      seriesFor(*scan, dicom::SeriesRole::Stiffness, meaning.outlined, said, meaning.mayBeUneven);
  const dicom::Series stack = meaning.mayBeUneven ? dicom::asStack(series) : series;
  const bool outlined = said.contains(DiagnosticCode::SeriesByOutline);
  out.map = readStiffness(stack, meaning, said, progress.part(0.4, 0.8));
  if (!dicom::setByHand(series) && !outlined) append(out.warnings, doubtsAbout(*scan, series));
  if (meaning.unit && series.unit && *meaning.unit != *series.unit)
    out.warnings.push_back("the series says that its stiffness is in " + *series.unit + "; it was taken as " +
                           *meaning.unit + ", as asked for");
  if (meaning.quantity == StiffnessQuantity::Youngs && !series.quantity)
    out.warnings.push_back(
        "the series was taken as Young's modulus, as asked for; MR elastography reports the shear modulus unless it "
        "says "
        "otherwise (a third of it)");
  if (!series.unevenSlices_mm.empty()) {
    out.map.unevenSlices_mm = series.unevenSlices_mm;
    said.add(DiagnosticCode::SlicesUneven, unevenness(series));
  }
  out.patientKey = series.patientKey;
  out.studyDate = series.studyDate;
  out.studyUid = series.studyUid;
  append(out.warnings, warningsOf(*scan, series, true));
  out.diagnostics.add(series.diagnostics);
  const bool uneven = !out.map.unevenSlices_mm.empty();
  out.acquisition =
      dicom::partnersOf(uneven ? asStacks(*scan) : *scan, static_cast<int>(&series - scan->series.data()));
  said.add(out.acquisition.diagnostics);
  if (const int c = out.acquisition.confidence; c >= 0)
    takeConfidence(scan->series[static_cast<std::size_t>(c)], meaning, out, said, progress.part(0.8, 1.0));
  if (!out.map.confidence) said.add(DiagnosticCode::NoConfidenceMap);
  tell(out, said);
  return out;
}

void checkRolesFound(const dicom::RoleOverrides& roles, const std::vector<std::vector<std::string>>& notFound) {
  for (const auto& role : roles) {
    const std::string& which = role.first;
    if (std::all_of(notFound.begin(), notFound.end(), [&which](const std::vector<std::string>& list) {
          return std::find(list.begin(), list.end(), which) != list.end();
        }))
      throw BadInput("no series has the UID or number '" + which.substr(0, 70) +
                     "' that a role was given for; list them with: glisson-cli scan");
  }
}

LoadedRoi loadRoi(const std::filesystem::path& path, const std::string& name, int label, const Progress& progress) {
  if (std::filesystem::is_directory(path)) return onlyRoiIn(path, name, label, progress);
  LoadedRoi out;
  if (extensionOf(path) == ".json") {
    out.contours = roi::readContours(path);
  } else if (isRegionFile(path)) {
    out.mask = readRegion(path, label, std::nullopt, out.warnings, &out.diagnostics);
  } else if (dicom::isSegmentation(path)) {
    const dicom::SegmentationSet set = dicom::readSegmentation(path);
    append(out.warnings, set.warnings);
    Diagnostics said;
    const int segment = segmentNumber(set, name, label, said);
    tell(out, said);
    out.mask = dicom::maskOf(set, segment);
    out.frameOfReferenceUid = set.frameOfReferenceUid;
    out.origin = set.origin;
    out.referencedSeriesUid = set.referencedSeriesUid;
    out.names.seriesUid = set.referencedSeriesUid;
    for (const dicom::SegmentFrame& f : set.frames)
      if (f.segment == segment) out.names.planes.push_back({f.position_lps_mm, f.sourceSopInstanceUid});
    out.ofDicom = true;
  } else {
    dicom::StructureSet set = dicom::readRtStruct(path);
    append(out.warnings, set.warnings);
    Diagnostics said;
    out.contours = elastography::roiFromStructures(set, name, label, &said);
    tell(out, said);
    out.origin = set.origin;
    out.ofDicom = true;
  }
  if (out.contours) {
    out.frameOfReferenceUid = out.contours->frameOfReferenceUid;
    out.names.seriesUid = out.contours->seriesUid;
    for (const roi::Polygon& p : out.contours->polygons)
      if (!p.sopInstanceUid.empty() && p.state == roi::PolygonState::Accepted)
        out.names.planes.push_back({p.points_lps_mm.rowwise().mean(), p.sopInstanceUid});
  }
  if (!name.empty() && !out.ofDicom && !(out.contours && lowerCase(out.contours->name) == lowerCase(name))) {
    Diagnostics said;
    said.add(DiagnosticCode::NameNotUsed,
             {{"what", std::string(out.contours ? "a file of outlines" : "a mask or a surface")}});
    tell(out, said);
  }
  if (label != 0 && !out.mask && !out.ofDicom)
    out.warnings.push_back("a label picks a value of a mask; these are contours: it was not used");
  return out;
}

namespace {

/// Where the named images are those of a series in one folder, and the named series is another one in the other folder.
void tellContradiction(const OutlineNames& names, const std::vector<const dicom::ScanResult*>& scans,
                       Diagnostics& said) {
  OutlineNames images = names, series = names;
  images.seriesUid.clear();
  series.planes.clear();
  for (std::size_t here = 0; scans.size() == 2 && here < 2; ++here) {
    const dicom::ScanResult &holder = *scans[here], &other = *scans[1 - here];
    const int drawn = outlinedSeries(holder, images), named = outlinedSeries(other, series);
    if (drawn < 0 || named < 0 || outlinedSeries(holder, series) >= 0 || outlinedSeries(other, images) >= 0) continue;
    said.add(DiagnosticCode::OutlineNamesContradict,
             {{"named", static_cast<std::int64_t>(other.series[static_cast<std::size_t>(named)].number)},
              {"series", static_cast<std::int64_t>(holder.series[static_cast<std::size_t>(drawn)].number)}});
    return;
  }
}

}  // namespace

Diagnostics doubtsAboutOutline(const LoadedRoi& roi, const AnatomicalImage* mri, const LoadedStiffness* mre) {
  Diagnostics said;
  std::vector<const dicom::ScanResult*> scans;
  if (mri != nullptr && mri->scan) scans.push_back(mri->scan.get());
  if (mre != nullptr && mre->scan) scans.push_back(mre->scan.get());
  tellContradiction(roi.names, scans, said);
  said.add(planesOffTheirImages(roi.names, scans, roi.mask ? "frames of the segmentation" : "contours"));
  if (!roi.names.empty() && mri != nullptr && mri->series >= 0 && outlinedSeries(*mri->scan, roi.names) < 0) {
    const std::int64_t taken = mri->scan->series[static_cast<std::size_t>(mri->series)].number;
    const int there = mre != nullptr && mre->scan ? outlinedSeries(*mre->scan, roi.names) : -1;
    if (there >= 0)
      said.add(DiagnosticCode::OutlinedSeriesNotTaken,
               {{"named", static_cast<std::int64_t>(mre->scan->series[static_cast<std::size_t>(there)].number)},
                {"taken", taken},
                {"what", std::string("MRI")}});
    else
      said.add(DiagnosticCode::OutlinedSeriesAbsent, {{"taken", taken}, {"what", std::string("MRI")}});
  }
  if (roi.ofDicom && roi.frameOfReferenceUid.empty() && (mri != nullptr || mre != nullptr))
    said.add(DiagnosticCode::OutlineFrameMissing, {{"image", std::string(mri != nullptr ? "MRI" : "elastogram")}});
  return said;
}

}  // namespace glisson::pipeline
