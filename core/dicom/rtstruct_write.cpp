#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/sha256.h"
#include "dicom/detail/attributes.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include "dicom/rtstruct.h"
#include "dicom/write_mr.h"

namespace glisson::dicom {
namespace {

/// Inserts into an item and turns any refusal of DCMTK into our fault: the values are made here.
class Writer {
 public:
  explicit Writer(DcmItem& item) : item_(item) {}

  void text(const DcmTagKey& tag, const std::string& value) {
    check(value.empty() ? item_.insertEmptyElement(tag) : item_.putAndInsertString(tag, value.c_str()), tag);
  }
  void number(const DcmTagKey& tag, long value) { text(tag, std::to_string(value)); }
  DcmItem& newItem(const DcmTagKey& sequence) {
    DcmItem* made = nullptr;
    check(item_.findOrCreateSequenceItem(sequence, made, -2), sequence);
    return *made;
  }
  /// As in source, or empty where source lacks it (Type 2).
  void copy(const DcmTagKey& tag, DcmItem& source) {
    DcmElement* element = nullptr;
    if (source.findAndGetElement(tag, element).good() && element != nullptr)
      check(item_.insert(static_cast<DcmElement*>(element->clone()), OFTrue), tag);
    else
      check(item_.insertEmptyElement(tag), tag);
  }

 private:
  static void check(const OFCondition& status, const DcmTagKey& tag) {
    if (status.bad()) throw BadArgument("an RT Structure Set cannot hold " + nameOf(tag) + ": " + status.text());
  }
  DcmItem& item_;
};

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
  Writer image(Writer(holder).newItem(DCM_ContourImageSequence));
  image.text(DCM_ReferencedSOPClassUID, source.sopClassUid);
  image.text(DCM_ReferencedSOPInstanceUID, source.sopInstanceUids[source.frames.empty() ? slice : 0]);
  if (!source.frames.empty()) image.number(DCM_ReferencedFrameNumber, source.frames[slice] + 1);
}

std::string contourData(const StructureContour& contour) {
  std::string data;
  for (Eigen::Index n = 0; n < contour.points_lps_mm.cols(); ++n)
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      data += (data.empty() ? "" : "\\") + decimalString(contour.points_lps_mm(axis, n));
  return data;
}

void check(const StructureSet& structures, const Series& source) {
  if (source.files.empty() || source.sopInstanceUids.empty())
    throw BadArgument("an RT Structure Set needs an image series to refer to; this one has no files");
  if (source.frames.empty() && source.sopInstanceUids.size() != static_cast<std::size_t>(source.grid.size.z()))
    throw BadArgument("the image series of an RT Structure Set must have one image per slice");
  if (std::any_of(source.sopInstanceUids.begin(), source.sopInstanceUids.end(),
                  [](const std::string& uid) { return uid.empty(); }))
    throw BadInput("an RT Structure Set cannot refer to images without a SOP Instance UID");
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
    for (const StructureContour& c : s.contours) {
      DcmItem& contour = Writer(item).newItem(DCM_ContourSequence);
      referToImage(contour, source, sliceOf(c, source));
      Writer(contour).text(DCM_ContourGeometricType, "CLOSED_PLANAR");
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
    for (const StructureContour& c : s.contours) all += "|" + contourData(c);
  }
  return sha256(all.data(), all.size());
}

void save(DcmFileFormat& format, const std::filesystem::path& file) {
  const auto temporary = file.parent_path() / ("." + file.filename().string() + ".part-" + std::to_string(getpid()));
  std::error_code failed;
  // Implicit value representations: an explicit DS holds at most 64 KiB, which long contours exceed.
  bool good = format.saveFile(temporary.c_str(), EXS_LittleEndianImplicit, EET_ExplicitLength).good();
  if (good) {
    const int descriptor = open(temporary.c_str(), O_RDONLY | O_CLOEXEC);
    good = descriptor >= 0 && fsync(descriptor) == 0;
    if (descriptor >= 0) close(descriptor);
  }
  if (good) std::filesystem::rename(temporary, file, failed);
  if (good && !failed) return;
  std::filesystem::remove(temporary, failed);
  throw BadInput("'" + file.filename().string() +
                 "' cannot be written; is the folder there, writable, and the disk not full?");
}

}  // namespace

void writeRtStruct(const std::filesystem::path& file, const StructureSet& structures, const Series& source,
                   std::uint64_t seed) {
  check(structures, source);
  DcmDataset image;
  try {
    ByteSource bytes(source.files.front());
    const FileLayout layout = readLayout(bytes);
    parseHeader(bytes, layout, image);
  } catch (const BadInput& e) {
    throw BadInput("'" + source.files.front().filename().string() + "' " + e.what());
  }
  const std::string base = "rtstruct/" + source.uid + "/" + source.frameOfReferenceUid + "/" + std::to_string(seed) +
                           "/" + digest(structures);
  DcmFileFormat format;
  DcmDataset& data = *format.getDataset();
  Writer w(data);
  w.copy(DCM_SpecificCharacterSet, image);
  w.text(DCM_SOPClassUID, UID_RTStructureSetStorage);
  w.text(DCM_SOPInstanceUID, uidFrom(base + "/instance"));
  for (const DcmTagKey& tag :
       {DCM_StudyDate, DCM_StudyTime, DCM_AccessionNumber, DCM_ReferringPhysicianName, DCM_PatientName, DCM_PatientID,
        DCM_PatientBirthDate, DCM_PatientSex, DCM_StudyInstanceUID, DCM_StudyID})
    w.copy(tag, image);
  w.text(DCM_Modality, "RTSTRUCT");
  w.text(DCM_Manufacturer, "Glisson");
  w.text(DCM_SeriesDescription, "RESEARCH contours");
  w.text(DCM_OperatorsName, "");
  w.text(DCM_SeriesInstanceUID, uidFrom(base + "/series"));
  w.number(DCM_SeriesNumber, 9000 + source.number % 1000);
  w.text(DCM_StructureSetLabel, "RESEARCH");
  w.text(DCM_StructureSetDate, "");
  w.text(DCM_StructureSetTime, "");
  const std::string frame = !structures.frameOfReferenceUid.empty() ? structures.frameOfReferenceUid
                            : !source.frameOfReferenceUid.empty()   ? source.frameOfReferenceUid
                                                                    : uidFrom(source.uid + "/frame of reference");
  writeStructures(data, structures, source, frame);
  save(format, file);
}

}  // namespace glisson::dicom
