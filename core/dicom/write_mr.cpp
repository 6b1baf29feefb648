// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/write_mr.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>

#include "base/error.h"
#include "base/sha256.h"

namespace glisson::dicom {
namespace {

const DcmTagKey gePrivateBlock(0x0019, 0x0010);
const DcmTagKey gePulseSequence(0x0019, 0x109C);

// The values of one attribute, parted by backslashes.
std::string joined(const std::vector<std::string>& parts) {
  std::string all;
  for (const std::string& part : parts) {
    if (!all.empty()) all.push_back('\\');
    all.append(part);
  }
  return all;
}

class MrWriter {
 public:
  explicit MrWriter(DcmDataset& data) : data_(data) {}
  void text(const DcmTagKey& tag, const std::string& value) {
    check(data_.putAndInsertString(tag, value.c_str()), tag);
  }
  void number(const DcmTagKey& tag, int value) { text(tag, std::to_string(value)); }
  void decimal(const DcmTagKey& tag, double value) { text(tag, decimalString(value)); }
  void decimals(const DcmTagKey& tag, std::initializer_list<double> values) {
    std::vector<std::string> parts;
    for (const double v : values) parts.push_back(decimalString(v));
    text(tag, joined(parts));
  }
  void word(const DcmTagKey& tag, std::uint16_t value) { check(data_.putAndInsertUint16(tag, value), tag); }
  void privateText(const DcmTagKey& tag, DcmEVR vr, const std::string& value) {
    auto element =
        std::unique_ptr<DcmElement>(vr == EVR_LO ? static_cast<DcmElement*>(new DcmLongString(DcmTag(tag, DcmVR(vr))))
                                                 : new DcmShortString(DcmTag(tag, DcmVR(vr))));
    check(element->putString(value.c_str()), tag);
    check(data_.insert(element.get()), tag);
    element.release();  // the dataset owns it now
  }
  static void check(const OFCondition& status, const DcmTagKey& tag) {
    if (status.bad())
      throw BadArgument("cannot write DICOM attribute " + std::string(tag.toString().c_str()) + ": " + status.text());
  }

 private:
  DcmDataset& data_;
};

struct Kind {
  const char* sopClass;
  bool colour;
};

void patientAndStudy(MrWriter& w, const MrSeriesHeader& h) {
  w.text(DCM_SpecificCharacterSet, "ISO_IR 192");
  w.text(DCM_StudyDate, h.date);
  w.text(DCM_SeriesDate, h.date);
  w.text(DCM_AcquisitionDate, h.date);
  w.text(DCM_ContentDate, h.date);
  w.text(DCM_StudyTime, h.time);
  w.text(DCM_SeriesTime, h.time);
  w.text(DCM_AcquisitionTime, h.time);
  w.text(DCM_ContentTime, h.time);
  w.text(DCM_AccessionNumber, "");
  w.text(DCM_Modality, "MR");
  w.text(DCM_Manufacturer, "GE MEDICAL SYSTEMS");
  w.text(DCM_ReferringPhysicianName, "");
  w.text(DCM_StudyDescription, h.studyDescription);
  w.text(DCM_SeriesDescription, h.seriesDescription);
  w.text(DCM_ManufacturerModelName, "DISCOVERY MR750");
  w.text(DCM_PatientName, h.patientName);
  w.text(DCM_PatientID, h.patientId);
  w.text(DCM_PatientBirthDate, h.patientBirthDate);
  w.text(DCM_PatientSex, h.patientSex);
  w.text(DCM_StudyInstanceUID, h.studyUid);
  w.text(DCM_SeriesInstanceUID, h.seriesUid);
  w.text(DCM_StudyID, h.studyId);
  w.number(DCM_SeriesNumber, h.seriesNumber);
  w.number(DCM_AcquisitionNumber, 1);
  w.text(DCM_FrameOfReferenceUID, h.frameOfReferenceUid);
  w.text(DCM_PositionReferenceIndicator, "");
  w.text(DCM_BodyPartExamined, "ABDOMEN");
  w.text(DCM_PatientPosition, "HFS");
}

void acquisition(MrWriter& w, const MrSeriesHeader& h) {
  w.text(DCM_ScanningSequence, h.scanningSequence);
  w.text(DCM_SequenceVariant, h.sequenceVariant);
  w.text(DCM_ScanOptions, h.scanOptions);
  w.text(DCM_MRAcquisitionType, h.acquisitionType);
  w.decimal(DCM_RepetitionTime, h.repetitionTime_ms);
  w.decimal(DCM_EchoTime, h.echoTime_ms);
  w.number(DCM_EchoTrainLength, 1);
  w.decimal(DCM_NumberOfAverages, 1);
  w.decimal(DCM_ImagingFrequency, 127.77);
  w.text(DCM_ImagedNucleus, "1H");
  w.number(DCM_EchoNumbers, 1);
  w.decimal(DCM_MagneticFieldStrength, 3);
  w.decimal(DCM_FlipAngle, h.flipAngle_deg);
  w.text(DCM_ContrastBolusAgent, h.contrastAgent);
  if (!h.pulseSequence.empty()) {
    w.privateText(gePrivateBlock, EVR_LO, "GEMS_ACQU_01");
    w.privateText(gePulseSequence, EVR_LO, h.pulseSequence);
  }
}

void plane(MrWriter& w, const MrSeriesHeader& h, const image::Grid& g, int k) {
  const Eigen::Vector3d p = g.indexToLps({0, 0, static_cast<double>(k)});
  const Eigen::Vector3d row = g.direction.col(0);
  const Eigen::Vector3d column = g.direction.col(1);
  w.decimals(DCM_ImagePositionPatient, {p.x(), p.y(), p.z()});
  w.decimals(DCM_ImageOrientationPatient, {row.x(), row.y(), row.z(), column.x(), column.y(), column.z()});
  w.decimals(DCM_PixelSpacing, {g.spacing_mm.y(), g.spacing_mm.x()});  // row spacing first
  w.decimal(DCM_SliceThickness, h.sliceThickness_mm > 0.0 ? h.sliceThickness_mm : g.spacing_mm.z());
  w.decimal(DCM_SpacingBetweenSlices, g.spacing_mm.z());
  w.decimal(DCM_SliceLocation, row.cross(column).dot(p));
}

void checkHeader(const MrSeriesHeader& h, const image::Grid& g, std::size_t values) {
  g.check();
  if (values != g.voxelCount() || g.size.x() > 65535 || g.size.y() > 65535)
    throw BadArgument("MR series: " + std::to_string(values) + " voxels do not fit the grid");
  for (const std::string* uid : {&h.studyUid, &h.seriesUid, &h.frameOfReferenceUid})
    if (uid->empty() || uid->size() > 64)
      throw BadArgument("MR series: study, series and frame of reference need a UID of 1 to 64 characters");
}

/// The slices of `steps` volumes, one after the other; pixels: of image n = step · slices + k.
WrittenSeries writeSlices(const std::filesystem::path& folder, const MrSeriesHeader& h, const image::Grid& g, int steps,
                          const Kind& kind, const std::function<void(DcmDataset&, int)>& pixels) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed)
    throw BadInput("cannot make the folder for a DICOM series: " + failed.message() +
                   "; choose a folder that can be written to");
  WrittenSeries written;
  for (int n = 0; n < steps * g.size.z(); ++n) {
    DcmFileFormat file;
    DcmDataset& data = *file.getDataset();
    MrWriter w(data);
    const std::string uid = uidFrom(h.seriesUid + "/" + std::to_string(n));
    w.text(DCM_ImageType, joined(h.imageType));
    w.text(DCM_SOPClassUID, kind.sopClass);
    w.text(DCM_SOPInstanceUID, uid);
    patientAndStudy(w, h);
    if (kind.colour) {
      w.text(DCM_ConversionType, "WSD");
      w.text(DCM_PatientOrientation, "");
      w.text(DCM_BurnedInAnnotation, "NO");
    }
    acquisition(w, h);
    if (!h.derivation.empty()) w.text(DCM_DerivationDescription, h.derivation);
    w.number(DCM_InstanceNumber, n + 1);
    plane(w, h, g, n % g.size.z());
    if (steps > 1) {
      w.number(DCM_TemporalPositionIdentifier, n / g.size.z() + 1);
      w.number(DCM_NumberOfTemporalPositions, steps);
    }
    w.word(DCM_Rows, static_cast<std::uint16_t>(g.size.y()));
    w.word(DCM_Columns, static_cast<std::uint16_t>(g.size.x()));
    if (!kind.colour) {
      w.decimal(DCM_WindowCenter, h.windowCenter);
      w.decimal(DCM_WindowWidth, h.windowWidth);
    }
    pixels(data, n);

    char name[32];
    std::snprintf(name, sizeof name, "IM-%04d.dcm", n + 1);
    const std::filesystem::path path = folder / name;
    const OFCondition status = file.saveFile(path.string().c_str(), EXS_LittleEndianExplicit);
    if (status.bad())
      throw BadInput("cannot write " + std::string(name) + ": " + status.text() + "; check space and permissions");
    written.files.push_back(path);
    written.sopInstanceUids.push_back(uid);
  }
  return written;
}

}  // namespace

std::string uidFrom(const std::string& text) {
  const std::string hex = sha256(text.data(), text.size());
  // 128 bits as decimal digits: long multiplication by 16, since 2^128 has no standard integer type.
  std::string digits = "0";  // least significant first
  for (std::size_t i = 0; i < 32; ++i) {
    int carry = hex[i] <= '9' ? hex[i] - '0' : hex[i] - 'a' + 10;
    for (char& d : digits) {
      const int v = (d - '0') * 16 + carry;
      d = static_cast<char>('0' + v % 10);
      carry = v / 10;
    }
    for (; carry > 0; carry /= 10) digits.push_back(static_cast<char>('0' + carry % 10));
  }
  return "2.25." + std::string(digits.rbegin(), digits.rend());
}

std::string decimalString(double value) {
  if (!std::isfinite(value)) throw BadArgument("a DICOM decimal string cannot hold a value that is not finite");
  if (value == 0.0) return "0";
  char text[40];
  for (int precision = 15; precision > 0; --precision) {
    std::snprintf(text, sizeof text, "%.*g", precision, value);
    if (std::string(text).size() <= 16) break;
  }
  return text;
}

WrittenSeries writeMrSeries(const std::filesystem::path& folder, const MrSeriesHeader& header,
                            const image::Volume<std::int16_t>& volume) {
  return writeMrSeries(folder, header, std::vector<image::Volume<std::int16_t>>{volume});
}

WrittenSeries writeMrSeries(const std::filesystem::path& folder, const MrSeriesHeader& header,
                            const std::vector<image::Volume<std::int16_t>>& steps) {
  if (steps.empty()) throw BadArgument("MR series: there is no volume to write");
  const image::Grid& g = steps.front().grid;
  for (const auto& step : steps) {
    if (!step.grid.sameGeometry(g)) throw BadArgument("MR series: its time steps lie on different grids");
    checkHeader(header, g, step.values.size());
  }
  const std::size_t slice = static_cast<std::size_t>(g.size.x()) * static_cast<std::size_t>(g.size.y());
  const auto pixels = [&](DcmDataset& data, int n) {
    MrWriter w(data);
    w.word(DCM_SamplesPerPixel, 1);
    w.text(DCM_PhotometricInterpretation, "MONOCHROME2");
    w.word(DCM_BitsAllocated, 16);
    w.word(DCM_BitsStored, 16);
    w.word(DCM_HighBit, 15);
    w.word(DCM_PixelRepresentation, 1);
    const auto& volume = steps[static_cast<std::size_t>(n / g.size.z())];
    const auto* first = volume.values.data() + static_cast<std::size_t>(n % g.size.z()) * slice;
    const std::vector<std::uint16_t> words(first, first + slice);  // two's complement, as PixelRepresentation 1 says
    MrWriter::check(data.putAndInsertUint16Array(DCM_PixelData, words.data(), static_cast<unsigned long>(words.size())),
                    DCM_PixelData);
  };
  return writeSlices(folder, header, g, static_cast<int>(steps.size()), {UID_MRImageStorage, false}, pixels);
}

WrittenSeries writeMrColourSeries(const std::filesystem::path& folder, const MrSeriesHeader& header,
                                  const image::Volume<std::array<std::uint8_t, 3>>& volume) {
  const image::Grid& g = volume.grid;
  checkHeader(header, g, volume.values.size());
  const std::size_t slice = static_cast<std::size_t>(g.size.x()) * static_cast<std::size_t>(g.size.y());
  return writeSlices(folder, header, g, 1, {UID_SecondaryCaptureImageStorage, true}, [&](DcmDataset& data, int k) {
    MrWriter w(data);
    w.word(DCM_SamplesPerPixel, 3);
    w.text(DCM_PhotometricInterpretation, "RGB");
    w.word(DCM_PlanarConfiguration, 0);
    w.word(DCM_BitsAllocated, 8);
    w.word(DCM_BitsStored, 8);
    w.word(DCM_HighBit, 7);
    w.word(DCM_PixelRepresentation, 0);
    const auto* first = volume.values.data() + static_cast<std::size_t>(k) * slice;
    std::vector<std::uint8_t> bytes;
    bytes.reserve(slice * 3 + 1);
    for (const auto* p = first; p != first + slice; ++p) bytes.insert(bytes.end(), p->begin(), p->end());
    if (bytes.size() % 2) bytes.push_back(0);  // values have even length
    MrWriter::check(data.putAndInsertUint8Array(DCM_PixelData, bytes.data(), static_cast<unsigned long>(bytes.size())),
                    DCM_PixelData);
  });
}

}  // namespace glisson::dicom
