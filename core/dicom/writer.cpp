// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <memory>

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include "base/error.h"
#include "base/part_file.h"
#include "base/version.h"
#include "dicom/detail/attributes.h"
#include "dicom/detail/writer.h"
#include "dicom/write_mr.h"

namespace glisson::dicom {

void Writer::check(const OFCondition& status, const DcmTagKey& tag) {
  if (status.bad()) throw BadArgument("a DICOM object cannot hold " + nameOf(tag) + ": " + status.text());
}

void Writer::text(const DcmTagKey& tag, const std::string& value) {
  check(value.empty() ? item_.insertEmptyElement(tag) : item_.putAndInsertString(tag, value.c_str()), tag);
}

void Writer::decimals(const DcmTagKey& tag, std::initializer_list<double> values) {
  std::string all;
  for (const double v : values) all += (all.empty() ? "" : "\\") + decimalString(v);
  text(tag, all);
}

void Writer::word(const DcmTagKey& tag, int value) {
  check(item_.putAndInsertUint16(tag, static_cast<Uint16>(value)), tag);
}

void Writer::longWord(const DcmTagKey& tag, std::uint32_t value) {
  check(item_.putAndInsertUint32(tag, value), tag);
}

void Writer::longWords(const DcmTagKey& tag, const std::vector<std::uint32_t>& values) {
  auto element = std::make_unique<DcmUnsignedLong>(DcmTag(tag));
  check(element->putUint32Array(values.data(), static_cast<unsigned long>(values.size())), tag);
  check(item_.insert(element.get(), OFTrue), tag);
  element.release();  // the item owns it now
}

void Writer::real(const DcmTagKey& tag, double value) {
  check(item_.putAndInsertFloat64(tag, value), tag);
}

void Writer::attributeTag(const DcmTagKey& tag, const DcmTagKey& value) {
  check(item_.putAndInsertTagKey(tag, value), tag);
}

void Writer::code(const DcmTagKey& sequence, const Code& code) {
  Writer w(newItem(sequence));
  w.text(DCM_CodeValue, code.value);
  w.text(DCM_CodingSchemeDesignator, code.scheme);
  w.text(DCM_CodeMeaning, code.meaning);
}

DcmItem& Writer::newItem(const DcmTagKey& sequence) {
  DcmItem* made = nullptr;
  check(item_.findOrCreateSequenceItem(sequence, made, -2), sequence);
  return *made;
}

void Writer::group(const DcmTagKey& sequence, const std::function<void(Writer&)>& fill) {
  Writer w(newItem(sequence));
  fill(w);
}

void Writer::copy(const DcmTagKey& tag, DcmItem& source) {
  DcmElement* element = nullptr;
  if (source.findAndGetElement(tag, element).good() && element != nullptr)
    check(item_.insert(static_cast<DcmElement*>(element->clone()), OFTrue), tag);
  else
    check(item_.insertEmptyElement(tag), tag);
}

std::string frameOfReference(const Series& source) {
  return source.frameOfReferenceUid.empty() ? uidFrom(source.uid + "/frame of reference") : source.frameOfReferenceUid;
}

std::string seriesInstanceUid(const Series& source) {
  return source.uid.substr(0, source.uid.find('#'));
}

void readSourceHeader(const Series& source, DcmDataset& image) {
  try {
    ByteSource bytes(source.files.front());
    const FileLayout layout = readLayout(bytes);
    parseHeader(bytes, layout, image);
  } catch (const BadInput& e) {
    throw BadInput("an image of the source series " + std::string(e.what()));
  }
}

void writeDerivedHeader(DcmDataset& data, DcmDataset& image, const Series& source, const DerivedHeader& h) {
  Writer w(data);
  w.copy(DCM_SpecificCharacterSet, image);
  w.text(DCM_SOPClassUID, h.sopClassUid);
  w.text(DCM_SOPInstanceUID, uidFrom(h.identity + "/instance"));
  for (const DcmTagKey& tag :
       {DCM_StudyDate, DCM_StudyTime, DCM_AccessionNumber, DCM_ReferringPhysicianName, DCM_PatientName, DCM_PatientID,
        DCM_PatientBirthDate, DCM_PatientSex, DCM_StudyInstanceUID, DCM_StudyID})
    w.copy(tag, image);
  for (const DcmTagKey& tag : {DCM_IssuerOfPatientID, DCM_PatientIdentityRemoved, DCM_DeidentificationMethod,
                               DCM_DeidentificationMethodCodeSequence, DCM_LongitudinalTemporalInformationModified})
    if (image.tagExists(tag)) w.copy(tag, image);
  // Content times that are Type 1 get the study's; one that is absent is the first of January 1900, which nobody takes
  // for a measurement.
  const std::string date = text(image, DCM_StudyDate), time = text(image, DCM_StudyTime);
  w.text(DCM_ContentDate, date.empty() ? "19000101" : date);
  w.text(DCM_ContentTime, time.empty() ? "000000" : time);
  w.text(DCM_Modality, h.modality);
  w.text(DCM_Manufacturer, "Glisson");
  w.text(DCM_ManufacturerModelName, "Glisson");
  w.text(DCM_DeviceSerialNumber, "none");
  w.text(DCM_SoftwareVersions, version());
  w.text(DCM_SeriesDescription, h.seriesDescription);
  w.text(DCM_SeriesInstanceUID, uidFrom(h.identity + "/series"));
  w.number(DCM_SeriesNumber, h.seriesNumber);
  w.number(DCM_InstanceNumber, 1);
  if (h.sameFrame) {
    w.text(DCM_FrameOfReferenceUID, frameOfReference(source));
    w.text(DCM_PositionReferenceIndicator, "");
  }
}

void checkReferable(const Series& source, const char* what) {
  if (source.files.empty() || source.sopInstanceUids.empty())
    throw BadArgument(std::string(what) + " needs an image series to refer to; this one has no files");
  if (source.frames.empty() && source.sopInstanceUids.size() != static_cast<std::size_t>(source.grid.size.z()))
    throw BadArgument(std::string("the image series of ") + what + " must have one image per slice");
  if (std::any_of(source.sopInstanceUids.begin(), source.sopInstanceUids.end(),
                  [](const std::string& uid) { return uid.empty(); }))
    throw BadInput(std::string(what) + " cannot refer to images without a SOP Instance UID");
}

namespace {

/// Which of the series' files holds a slice.
std::size_t fileOf(const Series& source, std::size_t slice) {
  if (source.frames.empty()) return slice;
  return source.fileOfSlice.empty() ? 0 : static_cast<std::size_t>(source.fileOfSlice[slice]);
}

}  // namespace

void referToSlice(DcmItem& item, const Series& source, std::size_t slice) {
  Writer image(item);
  image.text(DCM_ReferencedSOPClassUID, source.sopClassUid);
  image.text(DCM_ReferencedSOPInstanceUID, source.sopInstanceUids[fileOf(source, slice)]);
  if (!source.frames.empty()) image.number(DCM_ReferencedFrameNumber, source.frames[slice] + 1);
}

void referToSeries(DcmDataset& data, const Series& source) {
  Writer root(data);
  root.group(DCM_ReferencedSeriesSequence, [&](Writer& series) {
    series.text(DCM_SeriesInstanceUID, seriesInstanceUid(source));
    for (const std::string& uid : source.sopInstanceUids)
      series.group(DCM_ReferencedInstanceSequence, [&](Writer& w) {
        w.text(DCM_ReferencedSOPClassUID, source.sopClassUid);
        w.text(DCM_ReferencedSOPInstanceUID, uid);
      });
  });
}

void writeDimensions(Writer& root, const std::string& uid,
                     const std::vector<std::pair<DcmTagKey, DcmTagKey>>& pointerAndGroup) {
  root.group(DCM_DimensionOrganizationSequence, [&](Writer& w) { w.text(DCM_DimensionOrganizationUID, uid); });
  for (const auto& [pointer, group] : pointerAndGroup)
    root.group(DCM_DimensionIndexSequence, [&, p = pointer, g = group](Writer& w) {
      w.text(DCM_DimensionOrganizationUID, uid);
      w.attributeTag(DCM_DimensionIndexPointer, p);
      w.attributeTag(DCM_FunctionalGroupPointer, g);
    });
}

void writeSharedGeometry(Writer& shared, const image::Grid& g) {
  shared.group(DCM_PixelMeasuresSequence, [&](Writer& w) {
    w.decimals(DCM_PixelSpacing, {g.spacing_mm.y(), g.spacing_mm.x()});  // row spacing first
    w.decimals(DCM_SliceThickness, {g.spacing_mm.z()});
    w.decimals(DCM_SpacingBetweenSlices, {g.spacing_mm.z()});
  });
  shared.group(DCM_PlaneOrientationSequence, [&](Writer& w) {
    const Eigen::Vector3d r = g.direction.col(0), c = g.direction.col(1);
    w.decimals(DCM_ImageOrientationPatient, {r.x(), r.y(), r.z(), c.x(), c.y(), c.z()});
  });
}

void writePlanePosition(Writer& frame, const image::Grid& grid, int k) {
  const Eigen::Vector3d p = grid.indexToLps({0, 0, static_cast<double>(k)});
  frame.group(DCM_PlanePositionSequence, [&](Writer& w) {
    w.decimals(DCM_ImagePositionPatient, {p.x(), p.y(), p.z()});
  });
}

void writeDerivation(Writer& frame, const Series& source, std::size_t slice, const Code& derivation,
                     const Code& purpose) {
  frame.group(DCM_DerivationImageSequence, [&](Writer& w) {
    w.code(DCM_DerivationCodeSequence, derivation);
    DcmItem& image = w.newItem(DCM_SourceImageSequence);
    referToSlice(image, source, slice);
    Writer(image).code(DCM_PurposeOfReferenceCodeSequence, purpose);
  });
}

void writeCodingSchemes(DcmDataset& data) {
  Writer(data).group(DCM_CodingSchemeIdentificationSequence, [](Writer& w) {
    w.text(DCM_CodingSchemeDesignator, "99GLISSON");
    w.text(DCM_CodingSchemeName, "Concepts of Glisson without a standard code");
  });
}

void saveDicom(DcmFileFormat& format, const std::filesystem::path& file, E_TransferSyntax syntax) {
  PartFile part(file);
  if (format.saveFile(part.path().c_str(), syntax, EET_ExplicitLength).bad())
    throw BadInput("'" + file.filename().string() +
                   "' cannot be written; is the folder there, writable, and the disk not full?");
  part.become();
}

}  // namespace glisson::dicom
