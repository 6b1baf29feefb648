// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/error.h"
#include "dicom/measurement_report.h"
#include "dicom/pmap.h"
#include "dicom/rtstruct.h"
#include "dicom/secondary_capture.h"
#include "dicom/seg.h"
#include "elastography/roi_from_structures.h"
#include "elastography/statistics.h"
#include "exchange/picture_file.h"
#include "pipeline/detail/export_case.h"

namespace glisson::pipeline::detail {
namespace {

std::vector<dicom::Segment> liverSegment(const image::Mask& mask) {
  return {{1, "liver", "SCT:10200004", mask}};
}

dicom::ReportedStiffness reported(const std::string& name, std::optional<int> slice,
                                  const elastography::Statistics& s) {
  return {name, slice, s.n, s.area_mm2, s.mean_kPa, s.median_kPa, s.sd_kPa, s.min_kPa, s.max_kPa};
}

}  // namespace

void exportRtStruct(ExportCase& c) {
  const dicom::Series& mri = c.mri();
  dicom::StructureSet set;
  set.frameOfReferenceUid = mri.frameOfReferenceUid;
  set.referencedSeriesUid = mri.uid;
  roi::ContourStack contours = c.contours();
  contours.name = "liver";
  set.structures.push_back(elastography::toStructure(contours, 1));
  dicom::writeRtStruct(c.file("rtstruct.dcm"), set, mri, c.request().seed);
}

void exportSegmentation(ExportCase& c) {
  dicom::writeSegmentation(c.file("seg.dcm"), liverSegment(c.liver()), c.mri(), c.request().seed);
}

void exportParametricMap(ExportCase& c) {
  const dicom::Series& mre = c.mre();
  image::ScalarVolume values = c.stiffness().values_kPa;
  std::size_t missing = 0;
  for (float& v : values.values)
    if (!std::isfinite(v)) {
      v = 0.0f;
      ++missing;
    }
  if (missing > 0) c.warn(std::to_string(missing) + " voxels of the stiffness map are not finite: written as 0");
  dicom::writeParametricMap(c.file("pmap.dcm"), values, c.stiffness().quantity, mre, c.request().seed);
}

void exportReport(ExportCase& c) {
  const dicom::Series& mre = c.mre();
  const image::Mask& roi = c.liverOnMre();
  elastography::MeasureOptions options;
  options.poisson = c.scene().setup.poisson;
  const elastography::Measurement m = elastography::measure(c.stiffness(), roi, options);
  for (const std::string& w : m.warnings) c.warn(w);
  const dicom::WrittenSegmentation seg =
      dicom::writeSegmentation(c.file("sr-seg.dcm"), liverSegment(roi), mre, c.request().seed);
  std::vector<dicom::ReportedStiffness> regions = {reported("liver", {}, m.pooled)};
  std::string without;
  for (const elastography::SliceStatistics& s : m.slices) {
    const std::string slice = std::to_string(s.slice + 1);
    if (s.statistics.n > 0)
      regions.push_back(reported("liver, slice " + slice, s.slice, s.statistics));
    else
      without += (without.empty() ? "" : ", ") + slice;
  }
  if (!without.empty())
    c.warn("no voxel of the region of interest counts on slice " + without + ": left out of the report");
  dicom::writeMeasurementReport(c.file("sr.dcm"), regions, m.quantity, seg, mre, c.request().seed);
}

void exportCaptures(ExportCase& c) {
  if (c.runFolder().empty())
    throw BadInput("Secondary Captures are made of a run's pictures: give the folder of a run instead of a scene");
  std::vector<std::filesystem::path> pictures;
  for (const auto& entry : std::filesystem::directory_iterator(c.runFolder()))
    if (entry.is_regular_file() && entry.path().extension() == ".png") pictures.push_back(entry.path());
  std::sort(pictures.begin(), pictures.end());
  if (pictures.empty()) throw BadInput("the run holds no pictures; ask for \"overlay\" in the scene's outputs");
  int number = 0;
  for (const auto& p : pictures) {
    exchange::RgbPicture picture = exchange::readPng(p);
    char name[32];
    std::snprintf(name, sizeof name, "sc-%04d.dcm", ++number);
    dicom::writeSecondaryCapture(
        c.file(name), {picture.width, picture.height, std::move(picture.rgb), "Picture of a simulated retraction"},
        number, false, c.mri(), c.request().seed);
  }
}

}  // namespace glisson::pipeline::detail
