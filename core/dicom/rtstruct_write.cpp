// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include "base/error.h"
#include "base/sha256.h"
#include "dicom/detail/keyhole.h"
#include "dicom/detail/writer.h"
#include "dicom/rtstruct.h"
#include "dicom/write_mr.h"

namespace glisson::dicom {
namespace {

/// The slice that a contour was drawn on: as it says, else the nearest one.
std::size_t sliceOf(const StructureContour& contour, const Series& source) {
  const auto& uids = source.sopInstanceUids;
  if (source.frames.empty()) {
    const auto named = std::find(uids.begin(), uids.end(), contour.referencedSopInstanceUid);
    if (named != uids.end() && !contour.referencedSopInstanceUid.empty())
      return static_cast<std::size_t>(named - uids.begin());
  }
  const Eigen::Vector3d centre = contour.points_lps_mm.rowwise().mean();
  const double k = std::round(source.grid.lpsToIndex(centre).z());
  return static_cast<std::size_t>(std::clamp(k, 0.0, static_cast<double>(source.grid.size.z() - 1)));
}

void referToImage(DcmItem& holder, const Series& source, std::size_t slice) {
  referToSlice(Writer(holder).newItem(DCM_ContourImageSequence), source, slice);
}

std::string contourData(const StructureContour& contour) {
  std::string data;
  for (Eigen::Index n = 0; n < contour.points_lps_mm.cols(); ++n)
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      data += (data.empty() ? "" : "\\") + decimalString(contour.points_lps_mm(axis, n));
  return data;
}

void check(const StructureSet& structures, const Series& source) {
  checkReferable(source, "an RT Structure Set");
  for (const Structure& s : structures.structures) {
    if (s.name.size() > 64) throw BadInput("the name of a structure is longer than 64 characters");
    for (const StructureContour& c : s.contours)
      if (c.points_lps_mm.cols() < 3 || !c.points_lps_mm.allFinite())
        throw BadArgument("structure number " + std::to_string(s.number) +
                          " has a contour of fewer than 3 points, or one that is not finite");
  }
}

/// References, structures and contours.
void writeStructures(DcmDataset& data, const StructureSet& structures, const Series& source, const std::string& frame) {
  Writer root(data);
  DcmItem& frameItem = root.newItem(DCM_ReferencedFrameOfReferenceSequence);
  Writer(frameItem).text(DCM_FrameOfReferenceUID, frame);
  DcmItem& study = Writer(frameItem).newItem(DCM_RTReferencedStudySequence);
  Writer(study).text(DCM_ReferencedSOPClassUID, UID_RETIRED_DetachedStudyManagementSOPClass);
  Writer(study).text(DCM_ReferencedSOPInstanceUID, source.studyUid);
  DcmItem& series = Writer(study).newItem(DCM_RTReferencedSeriesSequence);
  Writer(series).text(DCM_SeriesInstanceUID, source.uid.substr(0, source.uid.find('#')));
  for (std::size_t k = 0; k < static_cast<std::size_t>(source.grid.size.z()); ++k) referToImage(series, source, k);

  for (const Structure& s : structures.structures) {
    Writer roi(root.newItem(DCM_StructureSetROISequence));
    roi.number(DCM_ROINumber, s.number);
    roi.text(DCM_ReferencedFrameOfReferenceUID, frame);
    roi.text(DCM_ROIName, s.name);
    roi.text(DCM_ROIGenerationAlgorithm, "MANUAL");
  }
  long index = 0;
  for (const Structure& s : structures.structures) {
    DcmItem& item = root.newItem(DCM_ROIContourSequence);
    Writer(item).text(DCM_ROIDisplayColor, "192\\64\\64");
    // Contours that flip what they enclose are written as such, all of a structure or none (DICOM PS3.3, C.8.8.6.3).
    const bool exclusiveOr =
        std::any_of(s.contours.begin(), s.contours.end(), [](const StructureContour& c) { return c.exclusiveOr; });
    for (const StructureContour& c : exclusiveOr ? s.contours : withKeyholes(s.contours)) {
      DcmItem& contour = Writer(item).newItem(DCM_ContourSequence);
      referToImage(contour, source, sliceOf(c, source));
      Writer(contour).text(DCM_ContourGeometricType, exclusiveOr ? "CLOSEDPLANAR_XOR" : "CLOSED_PLANAR");
      Writer(contour).number(DCM_NumberOfContourPoints, static_cast<long>(c.points_lps_mm.cols()));
      Writer(contour).number(DCM_ContourNumber, ++index);
      Writer(contour).text(DCM_ContourData, contourData(c));
    }
    Writer(item).number(DCM_ReferencedROINumber, s.number);
  }
  long observation = 0;
  for (const Structure& s : structures.structures) {
    Writer item(root.newItem(DCM_RTROIObservationsSequence));
    item.number(DCM_ObservationNumber, ++observation);
    item.number(DCM_ReferencedROINumber, s.number);
    item.text(DCM_RTROIInterpretedType, "ORGAN");
    item.text(DCM_ROIInterpreter, "");
  }
  root.text(DCM_ApprovalStatus, "UNAPPROVED");
}

std::string digest(const StructureSet& structures) {
  std::string all;
  for (const Structure& s : structures.structures) {
    all += std::to_string(s.number) + s.name;
    for (const StructureContour& c : s.contours) all += (c.exclusiveOr ? "^" : "|") + contourData(c);
  }
  return sha256(all.data(), all.size());
}

}  // namespace

void writeRtStruct(const std::filesystem::path& file, const StructureSet& structures, const Series& source,
                   std::uint64_t seed) {
  check(structures, source);
  DcmDataset image;
  readSourceHeader(source, image);
  const std::string base = "rtstruct/" + source.uid + "/" + source.frameOfReferenceUid + "/" + std::to_string(seed) +
                           "/" + digest(structures);
  DcmFileFormat format;
  DcmDataset& data = *format.getDataset();
  const DerivedHeader header{UID_RTStructureSetStorage, "RTSTRUCT", "RESEARCH contours", 9000 + source.number % 1000,
                             base};
  writeDerivedHeader(data, image, source, header);
  for (const DcmTagKey& tag : {DCM_ContentDate, DCM_ContentTime})
    data.findAndDeleteElement(tag);  // of images and reports
  Writer w(data);
  const std::string frame =
      structures.frameOfReferenceUid.empty() ? frameOfReference(source) : structures.frameOfReferenceUid;
  w.text(DCM_FrameOfReferenceUID, frame);
  w.text(DCM_OperatorsName, "");
  w.text(DCM_StructureSetLabel, "RESEARCH");
  w.text(DCM_StructureSetDate, "");
  w.text(DCM_StructureSetTime, "");
  writeStructures(data, structures, source, frame);
  // Implicit value representations: an explicit DS holds at most 64 KiB, which long contours exceed.
  saveDicom(format, file, EXS_LittleEndianImplicit);
}

}  // namespace glisson::dicom
