// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/offered_regions.h"

#include <algorithm>
#include <set>

#include "base/error.h"
#include "base/text.h"
#include "dicom/file_layout.h"
#include "dicom/rtstruct.h"
#include "dicom/seg.h"
#include "image/io.h"
#include "roi/contour_io.h"
#include "session/volume_files.h"

namespace glisson::session {

namespace {

namespace fs = std::filesystem;
using Kind = OfferedRegion::Kind;
using Regions = std::vector<OfferedRegion>;

constexpr std::size_t mostFiles = 64;
constexpr const char* structureSetClass = "1.2.840.10008.5.1.4.1.1.481.3";

std::string classOf(const fs::path& file) {
  try {
    dicom::ByteSource source(file);
    return dicom::readLayout(source).sopClassUid;
  } catch (const std::exception&) {
    return {};  // no DICOM file
  }
}

void addStructures(const fs::path& file, Regions& found) {
  for (const dicom::Structure& s : dicom::readRtStruct(file).structures)
    if (!s.contours.empty()) found.push_back({Kind::Structure, file, s.name, s.number});
}

void addSegments(const fs::path& file, Regions& found) {
  for (const dicom::Segment& s : dicom::readSegmentation(file).segments)
    found.push_back({Kind::Segment, file, s.label, s.number});
}

void addContours(const fs::path& file, Regions& found) {
  const roi::ContourStack contours = roi::readContours(file);
  if (!contours.polygons.empty()) found.push_back({Kind::Contours, file, contours.name, 0});
}

void addMask(const fs::path& file, Regions& found) {
  const image::ScalarVolume volume = image::readVolume(file);
  if (lookOf(file.filename().string(), volume) != VolumeLook::Mask) return;
  std::set<int> labels;
  for (const float v : volume.values)
    if (v > 0.0F) labels.insert(static_cast<int>(v));
  if (labels.size() == 1) {
    found.push_back({Kind::Mask, file, {}, 0});
  } else {
    for (const int label : labels) found.push_back({Kind::Mask, file, {}, label});
  }
}

}  // namespace

Regions offeredRegions(const dicom::ScanResult& scan, const Progress& progress) {
  std::vector<fs::path> files;
  for (const dicom::SkippedFile& f : scan.skipped) files.push_back(f.file);
  for (const dicom::Series& s : scan.series)
    if (isVolume(s)) files.push_back(s.files.front());
  std::sort(files.begin(), files.end());
  Regions found;
  std::size_t looked = 0;
  for (const fs::path& file : files) {
    progress.check();
    std::error_code unknown;
    if (looked == mostFiles || !fs::is_regular_file(file, unknown)) continue;
    Regions here;
    try {
      if (image::isVolumeFile(file)) {
        addMask(file, here);
      } else if (lowerCase(file.extension().string()) == ".json") {
        addContours(file, here);
      } else if (const std::string sop = classOf(file); sop == structureSetClass) {
        addStructures(file, here);
      } else if (!sop.empty() && dicom::isSegmentation(file)) {
        addSegments(file, here);
      } else {
        continue;
      }
    } catch (const std::exception&) {
      here.clear();  // the list of files left out has it
    }
    ++looked;
    found.insert(found.end(), here.begin(), here.end());
  }
  return found;
}

}  // namespace glisson::session
