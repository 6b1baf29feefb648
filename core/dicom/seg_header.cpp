// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <set>

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include "base/error.h"
#include "dicom/detail/attributes.h"
#include "dicom/detail/parsed_objects.h"

namespace glisson::dicom::detail {
namespace {

/// The group of a frame, from its own item or from the shared one.
DcmItem* groupOf(DcmItem* frame, DcmItem* shared, const DcmTagKey& sequence) {
  DcmItem* found = frame != nullptr ? itemOf(*frame, sequence) : nullptr;
  return found == nullptr && shared != nullptr ? itemOf(*shared, sequence) : found;
}

Eigen::Vector3d vector3(const std::vector<double>& v, std::size_t first = 0) {
  return {v[first], v[first + 1], v[first + 2]};
}

std::vector<double> exactly(DcmItem* group, const DcmTagKey& tag, std::size_t count, const std::string& where) {
  const std::vector<double> v = group != nullptr ? numbers(*group, tag) : std::vector<double>{};
  if (v.size() != count)
    throw BadInput("has no usable " + nameOf(tag) + where + " (" + std::to_string(v.size()) + " of " +
                   std::to_string(count) + " numbers)");
  return v;
}

void readGeometry(DcmItem* frame, DcmItem* shared, const std::string& where, bool first, SegHeader& h) {
  const auto spacing = exactly(groupOf(frame, shared, DCM_PixelMeasuresSequence), DCM_PixelSpacing, 2, where);
  const auto axes =
      exactly(groupOf(frame, shared, DCM_PlaneOrientationSequence), DCM_ImageOrientationPatient, 6, where);
  const Eigen::Vector3d row = vector3(axes), column = vector3(axes, 3);
  if (!(spacing[0] > 0.0) || !(spacing[1] > 0.0)) throw BadInput("has a pixel spacing that is not positive" + where);
  if (std::abs(row.norm() - 1.0) > 1e-3 || std::abs(column.norm() - 1.0) > 1e-3 || std::abs(row.dot(column)) > 1e-4)
    throw BadInput("has an image orientation that is no pair of perpendicular unit vectors" + where);
  if (first) {
    h.row = row.normalized();
    h.column = (column - column.dot(h.row) * h.row).normalized();
    h.rowSpacing_mm = spacing[0];
    h.columnSpacing_mm = spacing[1];
    if (DcmItem* measures = groupOf(frame, shared, DCM_PixelMeasuresSequence)) {
      h.sliceSpacing_mm = number(*measures, DCM_SpacingBetweenSlices);
      h.thickness_mm = number(*measures, DCM_SliceThickness);
    }
  } else if ((row - h.row).norm() > 1e-3 || (column - h.column).norm() > 1e-3 ||
             std::abs(spacing[0] - h.rowSpacing_mm) > 1e-4 * h.rowSpacing_mm ||
             std::abs(spacing[1] - h.columnSpacing_mm) > 1e-4 * h.columnSpacing_mm) {
    throw BadInput("has frames of different orientation or pixel spacing" + where);
  }
}

int wholeNumber(DcmItem& item, const DcmTagKey& tag, double low, double high) {
  const auto value = number(item, tag);
  if (!value || *value < low || *value > high || *value != std::floor(*value))
    throw BadInput("has " + nameOf(tag) + " missing or out of range");
  return static_cast<int>(*value);
}

void readFrames(DcmDataset& data, std::size_t count, SegHeader& h) {
  DcmItem* shared = itemOf(data, DCM_SharedFunctionalGroupsSequence);
  DcmSequenceOfItems* perFrame = nullptr;
  if (data.findAndGetSequence(DCM_PerFrameFunctionalGroupsSequence, perFrame).bad() || perFrame == nullptr ||
      perFrame->card() != count)
    throw BadInput("has no functional group for each of its " + std::to_string(count) + " frames");
  std::set<std::string> images;
  std::size_t n = 0;
  for (DcmObject* o = perFrame->nextInContainer(nullptr); o != nullptr; o = perFrame->nextInContainer(o), ++n) {
    auto* frame = static_cast<DcmItem*>(o);
    const std::string where = " (frame " + std::to_string(n + 1) + ")";
    readGeometry(frame, shared, where, n == 0, h);
    SegFrame f;
    f.position_lps_mm =
        vector3(exactly(groupOf(frame, shared, DCM_PlanePositionSequence), DCM_ImagePositionPatient, 3, where));
    if (f.position_lps_mm.cwiseAbs().maxCoeff() > 1e5) throw BadInput("lies more than 100 m from the scanner" + where);
    if (!h.labelMap) {
      DcmItem* identification = groupOf(frame, shared, DCM_SegmentIdentificationSequence);
      if (identification == nullptr) throw BadInput("does not say which segment a frame belongs to" + where);
      f.segment = wholeNumber(*identification, DCM_ReferencedSegmentNumber, 1, 65535);
    }
    if (DcmItem* derivation = groupOf(frame, shared, DCM_DerivationImageSequence))
      if (DcmItem* source = itemOf(*derivation, DCM_SourceImageSequence))
        f.sourceSopInstanceUid = shownText(*source, DCM_ReferencedSOPInstanceUID);
    if (!f.sourceSopInstanceUid.empty() && images.insert(f.sourceSopInstanceUid).second)
      h.about.referencedSopInstanceUids.push_back(f.sourceSopInstanceUid);
    h.frames.push_back(std::move(f));
  }
}

void readSegments(DcmDataset& data, bool labelMap, SegmentationSet& set) {
  DcmSequenceOfItems* items = nullptr;
  if (data.findAndGetSequence(DCM_SegmentSequence, items).bad() || items == nullptr)
    throw BadInput("describes no segments");
  for (DcmObject* o = items->nextInContainer(nullptr); o != nullptr; o = items->nextInContainer(o)) {
    auto& item = *static_cast<DcmItem*>(o);
    Segment s;
    s.number = wholeNumber(item, DCM_SegmentNumber, labelMap ? 0 : 1, 65535);
    if (s.number == 0) continue;  // what a label map calls its background
    s.label = shownText(item, DCM_SegmentLabel);
    if (DcmItem* type = itemOf(item, DCM_SegmentedPropertyTypeCodeSequence))
      s.propertyCode = shownText(*type, DCM_CodingSchemeDesignator) + ":" + shownText(*type, DCM_CodeValue);
    for (const Segment& other : set.segments)
      if (other.number == s.number)
        throw BadInput("uses " + nameOf(DCM_SegmentNumber) + " " + std::to_string(s.number) + " twice");
    set.segments.push_back(std::move(s));
    if (set.segments.size() > maxSegments) throw BadInput("describes more than 4096 segments");
  }
  std::sort(set.segments.begin(), set.segments.end(),
            [](const Segment& a, const Segment& b) { return a.number < b.number; });
}

}  // namespace

SegHeader parseSegHeader(const ByteSource& source, const FileLayout& layout) {
  DcmDataset data;
  parseHeader(source, layout, data);
  SegHeader h;
  SegmentationSet& set = h.about;
  const std::string type = shownText(data, DCM_SegmentationType);
  const std::string sopClass = text(data, DCM_SOPClassUID);
  // Label maps were also written under the older storage class, before the newer one was assigned.
  h.labelMap = sopClass == labelMapStorage || type == "LABELMAP";
  if (sopClass != UID_SegmentationStorage && sopClass != labelMapStorage)
    throw BadInput("is no Segmentation (modality '" + shownText(data, DCM_Modality) + "')");
  set.warnings = layout.warnings;
  set.origin = originOf(data);
  set.frameOfReferenceUid = shownText(data, DCM_FrameOfReferenceUID);
  if (DcmItem* series = itemOf(data, DCM_ReferencedSeriesSequence))
    set.referencedSeriesUid = shownText(*series, DCM_SeriesInstanceUID);
  readSegments(data, h.labelMap, set);
  h.rows = wholeNumber(data, DCM_Rows, 1, 65535);
  h.columns = wholeNumber(data, DCM_Columns, 1, 65535);
  h.bits = wholeNumber(data, DCM_BitsAllocated, 1, 64);
  h.fractional = type == "FRACTIONAL";
  const bool known = h.labelMap     ? h.bits == 8 || h.bits == 16
                     : h.fractional ? h.bits == 8
                                    : type == "BINARY" && h.bits == 1;
  if (!known)
    throw BadInput("is of type '" + type + "' with " + std::to_string(h.bits) +
                   " bits a pixel; BINARY with 1, FRACTIONAL with 8 and LABELMAP with 8 or 16 are read");
  if (h.fractional) h.maximum = wholeNumber(data, DCM_MaximumFractionalValue, 1, 255);
  readFrames(data, static_cast<std::size_t>(wholeNumber(data, DCM_NumberOfFrames, 1, maxSegFrames)), h);
  if (h.bits == 16 && layout.pixels && layout.pixels->encapsulated)
    throw BadInput("holds 16-bit labels in a compressed form, which is not read; convert it to an uncompressed one");
  return h;
}

}  // namespace glisson::dicom::detail
