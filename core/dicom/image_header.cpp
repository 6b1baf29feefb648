// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/detail/image_header.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "base/error.h"
#include "dicom/detail/attributes.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include "dicom/detail/frame_groups.h"
#include "dicom/detail/frame_values.h"
#include "dicom/detail/siemens.h"
#include "dicom/detail/stored_frames.h"

namespace glisson::dicom {
namespace {

/// Why a file of this SOP class holds no image; empty where it may.
std::string noImageReason(const std::string& sopClass, const std::string& modality) {
  if (sopClass == UID_RTStructureSetStorage || modality == "RTSTRUCT")
    return "is an RT Structure Set: contours, no image";
  if (sopClass == UID_SegmentationStorage || modality == "SEG") return "is a Segmentation: labels, no image series";
  if (sopClass == UID_MediaStorageDirectoryStorage)
    return "is a DICOMDIR index and no image; what it lists is read where it is given by itself";
  if (modality == "SR") return "is a Structured Report: no image";
  if (modality == "PR") return "is a Presentation State: no image";
  if (modality == "KO") return "is a Key Object Selection: no image";
  return {};
}

int required(DcmItem& data, const DcmTagKey& tag) {
  const auto value = count(data, tag);
  if (!value) throw BadInput(nameOf(tag) + " is missing");
  if (*value == 0) throw BadInput(nameOf(tag) + " is 0");
  return *value;
}

void readPixelDescription(DcmDataset& data, ImageHeader& h) {
  h.rows = required(data, DCM_Rows);
  h.columns = required(data, DCM_Columns);
  h.samples = count(data, DCM_SamplesPerPixel).value_or(1);
  h.bitsAllocated = required(data, DCM_BitsAllocated);
  const std::string photometric = text(data, DCM_PhotometricInterpretation);
  h.palette = photometric == "PALETTE COLOR";
  const bool grey = photometric == "MONOCHROME1" || photometric == "MONOCHROME2";
  h.kind = h.layout.pixels->element == 0x0008   ? PixelKind::Float
           : h.layout.pixels->element == 0x0009 ? PixelKind::Double
                                                : PixelKind::Integer;
  if (h.samples != 1 && h.samples != 3)
    throw BadInput(nameOf(DCM_SamplesPerPixel) + " is " + std::to_string(h.samples) + "; 1 or 3 was expected");
  if (h.samples == 3 && (grey || h.palette))
    throw BadInput("has three samples per pixel but a photometric interpretation for one");
  if (h.samples == 1 && !grey && !h.palette && !(photometric.empty() && h.kind != PixelKind::Integer))
    throw BadInput(nameOf(DCM_PhotometricInterpretation) + " is '" + cleaned(photometric).substr(0, 20) +
                   "', which does not go with one sample per pixel");
  if (h.kind != PixelKind::Integer) {
    const int expected = h.kind == PixelKind::Float ? 32 : 64;
    if (h.bitsAllocated != expected)
      throw BadInput(nameOf(DCM_BitsAllocated) + " is " + std::to_string(h.bitsAllocated) +
                     "; floating point pixels have " + std::to_string(expected));
    h.bitsStored = expected;
    return;
  }
  if (h.bitsAllocated != 8 && h.bitsAllocated != 16 && h.bitsAllocated != 32)
    throw BadInput(nameOf(DCM_BitsAllocated) + " is " + std::to_string(h.bitsAllocated) + "; 8, 16 or 32 can be read");
  h.bitsStored = required(data, DCM_BitsStored);
  if (h.bitsStored > h.bitsAllocated)
    throw BadInput(nameOf(DCM_BitsStored) + " is " + std::to_string(h.bitsStored) + ", more than the " +
                   std::to_string(h.bitsAllocated) + " bits allocated");
  const int highBit = count(data, DCM_HighBit).value_or(h.bitsStored - 1);
  if (highBit != h.bitsStored - 1)
    throw BadInput(nameOf(DCM_HighBit) + " is " + std::to_string(highBit) + " with " + std::to_string(h.bitsStored) +
                   " bits stored; " + std::to_string(h.bitsStored - 1) + " was expected");
  const int representation = count(data, DCM_PixelRepresentation).value_or(0);
  if (representation > 1)
    throw BadInput(nameOf(DCM_PixelRepresentation) + " is " + std::to_string(representation) + "; 0 or 1 was expected");
  h.isSigned = representation == 1;
}

/// The number of frames, after checking that the pixel data hold exactly as many.
std::uint64_t checkedFrameCount(DcmDataset& data, ImageHeader& h, const ByteSource& source, std::uint64_t fileBytes) {
  const double announced = number(data, DCM_NumberOfFrames).value_or(1.0);
  if (announced < 1.0 || announced > 2147483647.0 || announced != std::floor(announced)) {
    std::ostringstream why;
    why << nameOf(DCM_NumberOfFrames) << " is " << announced << "; a whole number from 1 on was expected";
    throw BadInput(why.str());
  }
  const auto frames = static_cast<std::uint64_t>(announced);
  const std::uint64_t frameBytes = h.frameBytes();  // at most 65535² · 3 · 8 < 2^37
  std::ostringstream what;
  what << frames << " frame(s) of " << h.rows << " x " << h.columns << " pixels, " << h.samples << " sample(s) of "
       << h.bitsAllocated << " bits";
  const PixelElement& pixels = *h.layout.pixels;
  if (pixels.encapsulated) {
    if (pixels.fragments.size() < frames)
      throw BadInput("announces " + what.str() + ", but holds " + std::to_string(pixels.fragments.size()) +
                     " compressed fragments");
    if (frames > memoryBudget(fileBytes) / frameBytes)
      throw BadInput("announces " + what.str() + ", beyond the memory budget for a compressed file of " +
                     std::to_string(fileBytes) + " bytes");
    return frames;
  }
  // An element holds less than 2^32 bytes, so that a product which could overflow is too large in any case.
  const bool beyond = frames > (1ULL << 40) / frameBytes;
  const std::uint64_t needed = beyond ? 1ULL << 40 : frames * frameBytes;
  if (pixels.length != needed && pixels.length != needed + needed % 2) {
    std::ostringstream why;
    if (pixels.length < needed) {
      why << "is truncated: it announces " << what.str() << ", but its pixel data have " << pixels.length << " bytes";
      throw BadInput(why.str());
    }
    const std::uint64_t extra = pixels.length - needed;
    bool zeros = extra <= (1U << 20);
    if (zeros)
      for (const std::uint8_t byte : source.bytes(pixels.offset + needed, extra)) zeros = zeros && byte == 0;
    if (!zeros) {
      why << "announces " << what.str() << " (" << needed << " bytes), but its pixel data have " << pixels.length
          << " bytes; which of them are the image is not guessed";
      throw BadInput(why.str());
    }
    h.warnings.push_back("has " + std::to_string(extra) + " bytes of zeros after its pixels");
  }
  return frames;
}

/// Days since some day, of a date "YYYYMMDD"; empty where it is none.
std::optional<double> days(const std::string& date) {
  if (date.size() < 8 || date.find_first_not_of("0123456789") < 8) return {};
  const auto part = [&date](std::size_t at, std::size_t n) { return std::stoi(date.substr(at, n)); };
  return 372.0 * part(0, 4) + 31.0 * part(4, 2) + part(6, 2);
}

/// Seconds of a time "HHMMSS.ffffff"; empty where it is none.
std::optional<double> seconds(const std::string& time) {
  if (time.size() < 6 || time.find_first_not_of("0123456789") < 6) return {};
  const auto part = [&time](std::size_t at) { return std::stoi(time.substr(at, 2)); };
  double fraction = 0.0;
  if (time.size() > 7 && time[6] == '.') {
    double scale = 0.1;
    for (std::size_t n = 7; n < time.size() && time[n] >= '0' && time[n] <= '9'; ++n, scale *= 0.1)
      fraction += scale * (time[n] - '0');
  }
  return 3600.0 * part(0) + 60.0 * part(2) + part(4) + fraction;
}

std::optional<double> acquisitionTime(DcmDataset& data) {
  const std::string both = text(data, DCM_AcquisitionDateTime);
  const std::string date = both.size() >= 14 ? both.substr(0, 8) : text(data, DCM_AcquisitionDate);
  const auto time = seconds(both.size() >= 14 ? both.substr(8) : text(data, DCM_AcquisitionTime));
  if (!time) return {};
  return 86400.0 * days(date).value_or(0.0) + *time;
}

/// UIDs of what the image was made of or refers to.
void addReferences(DcmItem& item, std::vector<std::string>& to) {
  constexpr std::size_t most = 64;
  const auto add = [&to](const std::string& uid) {
    if (!uid.empty() && to.size() < most && std::find(to.begin(), to.end(), uid) == to.end()) to.push_back(uid);
  };
  for (const DcmTagKey& sequence : {DCM_SourceImageSequence, DCM_ReferencedImageSequence})
    for (unsigned long n = 0; n < std::min<unsigned long>(itemCount(item, sequence), most); ++n)
      add(shownText(*itemOf(item, sequence, n), DCM_ReferencedSOPInstanceUID));
  for (unsigned long n = 0; n < std::min<unsigned long>(itemCount(item, DCM_ReferencedSeriesSequence), most); ++n)
    add(shownText(*itemOf(item, DCM_ReferencedSeriesSequence, n), DCM_SeriesInstanceUID));
  for (unsigned long n = 0; n < std::min<unsigned long>(itemCount(item, DCM_DerivationImageSequence), most); ++n)
    addReferences(*itemOf(item, DCM_DerivationImageSequence, n), to);
}

void readAcquisition(DcmDataset& data, ImageHeader& h) {
  h.acquisitionUid = shownText(data, DCM_AcquisitionUID);
  h.acquisition_s = acquisitionTime(data);
  try {
    const auto value = number(data, DCM_AcquisitionNumber);
    if (value && std::abs(*value) < 2e9) h.acquisitionNumber = static_cast<int>(*value);
  } catch (const BadInput&) {  // no number: as good as none
  }
  addReferences(data, h.references);
  if (DcmItem* shared = itemOf(data, DCM_SharedFunctionalGroupsSequence)) addReferences(*shared, h.references);
  if (DcmItem* frame = itemOf(data, DCM_PerFrameFunctionalGroupsSequence)) addReferences(*frame, h.references);
  const std::string scale = privateText(data, 0x2005, 0x0E, "Philips MR Imaging DD 001");
  double factor = 0.0;
  const auto [end, problem] = std::from_chars(scale.data(), scale.data() + scale.size(), factor);
  if (problem == std::errc() && end == scale.data() + scale.size() && std::isfinite(factor)) h.privateScale = factor;
}

/// Whether the pixels may hold text about the patient: it says so, or it is a picture of a screen that does not deny
/// it.
bool saysBurnedIn(DcmDataset& data, const std::string& sopClass) {
  const std::string said = text(data, DCM_BurnedInAnnotation);
  return said == "YES" || (said != "NO" && sopClass.starts_with(UID_SecondaryCaptureImageStorage));
}

bool isValidUid(const std::string& uid) {
  return uid.size() <= 64 && uid.find_first_not_of("0123456789.") == std::string::npos;
}

/// Throws BadInput where the file holds no image. image: whether it claims to hold one.
void readKind(DcmDataset& data, ImageHeader& h, bool& image) {
  h.sopClassUid = shownText(data, DCM_SOPClassUID);
  if (h.sopClassUid.empty()) h.sopClassUid = h.layout.sopClassUid;
  h.modality = shownText(data, DCM_Modality);
  const std::string reason = noImageReason(h.sopClassUid, h.modality);
  image = reason.empty() && h.layout.pixels.has_value();
  if (!reason.empty()) throw BadInput(reason);
  if (!h.layout.pixels) throw BadInput("holds no pixel data");
}

/// Of series, study, patient and image. Throws BadInput where there is no series.
void readIdentity(DcmDataset& data, ImageHeader& h) {
  h.seriesUid = text(data, DCM_SeriesInstanceUID);
  if (h.seriesUid.empty()) throw BadInput(nameOf(DCM_SeriesInstanceUID) + " is missing or empty");
  if (!isValidUid(h.seriesUid))
    throw BadInput(nameOf(DCM_SeriesInstanceUID) + " is no valid UID (digits and dots, at most 64)");
  const Origin origin = originOf(data);
  h.studyUid = origin.studyUid;
  h.studyDate = origin.studyDate;
  h.patientKey = origin.patientKey;
  h.frameOfReferenceUid = shownText(data, DCM_FrameOfReferenceUID);
  h.sopInstanceUid = text(data, DCM_SOPInstanceUID);
  if (!isValidUid(h.sopInstanceUid)) {
    h.warnings.push_back(nameOf(DCM_SOPInstanceUID) + " is no valid UID");
    h.sopInstanceUid.clear();
  }
}

void readDescription(DcmDataset& data, const ByteSource& source, ImageHeader& h) {
  h.description = shownText(data, DCM_SeriesDescription);
  h.imageType = shownText(data, DCM_ImageType);
  h.manufacturer = shownText(data, DCM_Manufacturer);
  h.sequenceName = cleaned(privateText(data, 0x0019, 0x9C, "GEMS_ACQU_01"));
  if (h.sequenceName.empty()) h.sequenceName = shownText(data, DCM_SequenceName);
  h.lossy =
      text(data, DCM_LossyImageCompression) == "01" || isLossy(h.layout.transferSyntax) || hasLossyWavelet(h, source);
  h.burnedIn = saysBurnedIn(data, h.sopClassUid);
  h.step = elastographyStep(text(data, DCM_ImageComments));
  if (h.lossy) h.warnings.push_back("was compressed with loss: its values are not the measured ones");
}

/// Of series and image; what is no number is told and does without.
void readNumbers(DcmDataset& data, ImageHeader& h) {
  try {
    const double value = number(data, DCM_SeriesNumber).value_or(0.0);
    if (std::abs(value) < 2e9) h.seriesNumber = static_cast<int>(value);
    const double instance = number(data, DCM_InstanceNumber).value_or(0.0);
    if (std::abs(instance) < 2e9) h.instanceNumber = static_cast<int>(instance);
  } catch (const BadInput&) {
    h.warnings.push_back(nameOf(DCM_SeriesNumber) + " or " + nameOf(DCM_InstanceNumber) + " is no number");
  }
}

ImageHeader parsed(const std::filesystem::path& file, const ByteSource& source, const FileLayout& layout,
                   std::uint64_t fileBytes) {
  ImageHeader h;
  h.file = file;
  h.layout = layout;
  bool image = true;
  RefusedFile refused;
  try {
    DcmDataset data;
    parseHeader(source, h.layout, data);
    h.warnings = h.layout.warnings;
    readKind(data, h, image);
    readIdentity(data, h);
    readDescription(data, source, h);
    readNumbers(data, h);
    readAcquisition(data, h);
    h.announced = announcedBy(data);
    readPixelDescription(data, h);
    readPadding(data, h);
    const std::uint64_t frames = checkedFrameCount(data, h, source, fileBytes);
    readFrames(data, frames, h);
    if (h.imageType.find("MOSAIC") != std::string::npos && frames == 1) expandMosaic(data, h);
    return h;
  } catch (const BadInput& e) {
    refused.reason = e.what();
  } catch (const std::bad_alloc&) {
    refused.reason = "asks for more memory than there is";
    refused.outOfMemory = true;
  }
  if (image) refused.seriesUid = h.seriesUid;
  throw refused;
}

}  // namespace

ImageHeader readImageHeader(const std::filesystem::path& file, ByteSource& source) {
  const std::uint64_t fileBytes = source.size();
  FileLayout layout;
  try {
    layout = readLayout(source);
  } catch (const BadInput& e) {
    RefusedFile refused;
    refused.reason = e.what();
    throw refused;
  }
  return parsed(file, source, layout, fileBytes);
}

ImageHeader readImageHeader(const std::filesystem::path& file, const ByteSource& source, const FileLayout& layout) {
  return parsed(file, source, layout, source.size());
}

}  // namespace glisson::dicom
