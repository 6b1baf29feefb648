// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <map>
#include <set>

#include "base/error.h"
#include "dicom/detail/attributes.h"
#include "dicom/detail/naming.h"
#include "dicom/detail/parsed_objects.h"
#include "dicom/detail/reader_process.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include "dicom/rtstruct.h"

namespace glisson::dicom {
namespace {

/// Calls body for each item of a sequence, in time linear in their number.
template <typename Body>
void forItems(DcmItem& holder, const DcmTagKey& sequence, Body body) {
  DcmSequenceOfItems* items = nullptr;
  if (holder.findAndGetSequence(sequence, items).bad() || items == nullptr) return;
  for (DcmObject* o = items->nextInContainer(nullptr); o != nullptr; o = items->nextInContainer(o))
    body(*static_cast<DcmItem*>(o));
}

int roiNumber(DcmItem& item, const DcmTagKey& tag) {
  const auto value = number(item, tag);
  if (!value || std::abs(*value) > 2e9 || *value != std::floor(*value))
    throw BadInput(nameOf(tag) + " is missing or no whole number");
  return static_cast<int>(*value);
}

StructureContour readContour(DcmItem& item, const std::string& where, std::vector<std::string>& warnings) {
  StructureContour contour;
  const std::vector<double> xyz = numbers(item, DCM_ContourData);
  if (xyz.size() % 3 != 0)
    throw BadInput(where + ": " + nameOf(DCM_ContourData) + " holds " + std::to_string(xyz.size()) +
                   " numbers, which is no multiple of three (x, y, z)");
  contour.points_lps_mm = Eigen::Map<const Eigen::Matrix3Xd>(xyz.data(), 3, static_cast<Eigen::Index>(xyz.size() / 3));
  if (contour.points_lps_mm.size() > 0 && contour.points_lps_mm.cwiseAbs().maxCoeff() > 1e5)
    throw BadInput(where + ": a point lies more than 100 m from the scanner");
  // The first point repeated at the end is allowed by nobody and written by many.
  const Eigen::Index n = contour.points_lps_mm.cols();
  if (n > 1 && (contour.points_lps_mm.col(0) - contour.points_lps_mm.col(n - 1)).norm() < 1e-6)
    contour.points_lps_mm.conservativeResize(Eigen::NoChange, n - 1);
  try {
    const auto announced = number(item, DCM_NumberOfContourPoints);
    if (announced && *announced != static_cast<double>(n))
      warnings.push_back(where + ": announces another number of points than it holds");
  } catch (const BadInput&) {
    warnings.push_back(where + ": " + nameOf(DCM_NumberOfContourPoints) + " is no number");
  }
  if (DcmItem* image = itemOf(item, DCM_ContourImageSequence))
    contour.referencedSopInstanceUid = shownText(*image, DCM_ReferencedSOPInstanceUID);
  return contour;
}

/// Listed: the images that the set says it was drawn on.
void readReferences(DcmDataset& data, StructureSet& set, std::set<std::string>& listed) {
  forItems(data, DCM_ReferencedFrameOfReferenceSequence, [&](DcmItem& frame) {
    const std::string frameUid = shownText(frame, DCM_FrameOfReferenceUID);
    if (set.frameOfReferenceUid.empty()) set.frameOfReferenceUid = frameUid;
    if (!frameUid.empty()) set.references.push_back({frameUid, {}});
    forItems(frame, DCM_RTReferencedStudySequence, [&](DcmItem& study) {
      // The examination that it was drawn on, which may be filed in another one.
      if (const std::string uid = shownText(study, DCM_ReferencedSOPInstanceUID); !uid.empty())
        set.origin.studyUid = uid;
      forItems(study, DCM_RTReferencedSeriesSequence, [&](DcmItem& series) {
        const std::string uid = shownText(series, DCM_SeriesInstanceUID);
        set.references.push_back({frameUid, uid});
        if (set.referencedSeriesUid.empty())
          set.referencedSeriesUid = uid;
        else if (set.referencedSeriesUid != uid)
          set.warnings.push_back("refers to several image series; the first one is taken");
        forItems(series, DCM_ContourImageSequence,
                 [&](DcmItem& image) { listed.insert(shownText(image, DCM_ReferencedSOPInstanceUID)); });
      });
    });
  });
}

/// What is wrong with the references; contours are placed by their coordinates all the same.
void checkReferences(const std::set<std::string>& listed, StructureSet& set) {
  std::size_t contours = 0, without = 0, elsewhere = 0;
  for (const Structure& s : set.structures)
    for (const StructureContour& c : s.contours) {
      ++contours;
      if (c.referencedSopInstanceUid.empty())
        ++without;
      else if (!listed.empty() && listed.count(c.referencedSopInstanceUid) == 0)
        ++elsewhere;
    }
  const auto say = [&](std::size_t many, const char* what) {
    if (many > 0)
      set.warnings.push_back(std::to_string(many) + " of " + std::to_string(contours) + " contours " + what +
                             "; they are placed by their coordinates");
  };
  if (set.referencedSeriesUid.empty()) set.warnings.push_back("names no image series that it was drawn on");
  say(elsewhere, "refer to images that are not among those the structure set lists");
  if (without < contours) say(without, "name no image");
}

/// The list of structures; where each is, by number.
std::map<int, std::size_t> readList(DcmDataset& data, StructureSet& set) {
  std::map<int, std::size_t> byNumber;
  std::set<std::string> frames;
  forItems(data, DCM_StructureSetROISequence, [&](DcmItem& item) {
    Structure structure;
    structure.number = roiNumber(item, DCM_ROINumber);
    structure.name = shownText(item, DCM_ROIName);
    const std::string frame = shownText(item, DCM_ReferencedFrameOfReferenceUID);
    if (!frame.empty()) frames.insert(frame);
    structure.frameOfReferenceUid = frame;
    if (!byNumber.try_emplace(structure.number, set.structures.size()).second)
      throw BadInput(nameOf(DCM_ROINumber) + " " + std::to_string(structure.number) + " is used twice");
    set.structures.push_back(std::move(structure));
  });
  if (set.frameOfReferenceUid.empty() && !frames.empty()) set.frameOfReferenceUid = *frames.begin();
  if (frames.size() > 1) set.warnings.push_back("has structures in several frames of reference");
  return byNumber;
}

/// The contours of one structure. roi: what it is called in warnings.
void readContours(DcmItem& item, const std::string& roi, Structure& structure, std::vector<std::string>& warnings) {
  std::map<std::string, int> otherKinds;
  int tooShort = 0, moved = 0, index = 0;
  forItems(item, DCM_ContourSequence, [&](DcmItem& contourItem) {
    const std::string where = roi + ", contour " + std::to_string(++index);
    const std::string kind = shownText(contourItem, DCM_ContourGeometricType);
    if (kind != "CLOSED_PLANAR" && kind != "CLOSEDPLANAR_XOR") {
      ++otherKinds[kind];
      return;
    }
    StructureContour contour = readContour(contourItem, where, warnings);
    const std::string offset = shownText(contourItem, DCM_RETIRED_ContourOffsetVector);
    moved += offset.find_first_of("123456789") != std::string::npos ? 1 : 0;
    contour.exclusiveOr = kind == "CLOSEDPLANAR_XOR";
    if (contour.points_lps_mm.cols() < 3)
      ++tooShort;
    else
      structure.contours.push_back(std::move(contour));
  });
  for (const auto& [kind, many] : otherKinds)
    warnings.push_back(roi + ": " + std::to_string(many) + " contour(s) of type '" + kind + "' are left out");
  if (moved > 0)
    warnings.push_back(roi + ": " + std::to_string(moved) +
                       " contour(s) name an offset (ContourOffsetVector), which is not applied: they count where their "
                       "points are");
  if (tooShort > 0)
    warnings.push_back(roi + ": " + std::to_string(tooShort) + " contour(s) of fewer than 3 points are left out");
}

StructureSet readData(DcmDataset& data) {
  StructureSet set;
  if (text(data, DCM_SOPClassUID) != UID_RTStructureSetStorage && text(data, DCM_Modality) != "RTSTRUCT")
    throw BadInput("is no RT Structure Set (modality '" + shownText(data, DCM_Modality) + "')");
  set.origin = originOf(data);
  std::set<std::string> listed;
  readReferences(data, set, listed);
  const std::map<int, std::size_t> byNumber = readList(data, set);
  forItems(data, DCM_ROIContourSequence, [&](DcmItem& item) {
    const int reference = roiNumber(item, DCM_ReferencedROINumber);
    const std::string roi = "structure number " + std::to_string(reference);
    if (const auto known = byNumber.find(reference); known != byNumber.end())
      readContours(item, roi, set.structures[known->second], set.warnings);
    else
      set.warnings.push_back(roi + " has contours but is not listed; it is left out");
  });
  checkReferences(listed, set);
  return set;
}

}  // namespace

namespace detail {

StructureSet parseStructures(const ByteSource& source, const FileLayout& layout) {
  DcmDataset data;
  parseHeader(source, layout, data);
  StructureSet set = readData(data);
  for (const std::string& w : layout.warnings) set.warnings.push_back(w);
  return set;
}

}  // namespace detail

StructureSet readRtStruct(const std::filesystem::path& file) {
  return detail::naming(file, [&]() -> StructureSet {
    ByteSource source(file);
    if (const auto layout = plainLayout(source)) return detail::parseStructures(source, *layout);
    return IsolatedFile(file).structures();
  });
}

}  // namespace glisson::dicom
