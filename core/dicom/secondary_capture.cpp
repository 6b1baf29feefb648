// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/secondary_capture.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include "base/error.h"
#include "base/sha256.h"
#include "dicom/detail/writer.h"
#include "dicom/write_mr.h"

namespace glisson::dicom {

void writeSecondaryCapture(const std::filesystem::path& file, const CapturedPicture& p, int number, bool identifies,
                           const Series& source, std::uint64_t seed) {
  if (source.files.empty()) throw BadArgument("a Secondary Capture needs a series whose patient and study it shares");
  if (p.width < 1 || p.height < 1 || p.width > 65535 || p.height > 65535 ||
      p.rgb.size() != 3 * static_cast<std::size_t>(p.width) * static_cast<std::size_t>(p.height))
    throw BadArgument("a picture of " + std::to_string(p.width) + " x " + std::to_string(p.height) +
                      " pixels cannot become a Secondary Capture");
  const std::string series = "sc/" + source.uid + "/" + std::to_string(seed);
  DcmDataset image;
  readSourceHeader(source, image);
  DcmFileFormat format;
  DcmDataset& data = *format.getDataset();
  writeDerivedHeader(
      data, image, source,
      {UID_SecondaryCaptureImageStorage, "OT", "RESEARCH pictures", 9400 + source.number % 1000, series, false});
  Writer root(data);
  root.text(DCM_SOPInstanceUID,
            uidFrom(series + "/" + std::to_string(number) + "/" + sha256(p.rgb.data(), p.rgb.size())));
  root.number(DCM_InstanceNumber, number);
  root.text(DCM_ConversionType, "WSD");
  root.text(DCM_BodyPartExamined, "LIVER");
  root.text(DCM_ImageType, "DERIVED\\SECONDARY");
  root.text(DCM_PatientOrientation, "");
  root.text(DCM_BurnedInAnnotation, identifies ? "YES" : "NO");
  root.text(DCM_RecognizableVisualFeatures, "NO");
  root.text(DCM_LossyImageCompression, "00");
  root.text(DCM_ImageComments, "Research use only, not for clinical use");
  root.text(DCM_DerivationDescription, p.description);
  root.word(DCM_SamplesPerPixel, 3);
  root.text(DCM_PhotometricInterpretation, "RGB");
  root.word(DCM_PlanarConfiguration, 0);
  root.word(DCM_Rows, p.height);
  root.word(DCM_Columns, p.width);
  root.word(DCM_BitsAllocated, 8);
  root.word(DCM_BitsStored, 8);
  root.word(DCM_HighBit, 7);
  root.word(DCM_PixelRepresentation, 0);
  std::vector<std::uint8_t> bytes = p.rgb;
  if (bytes.size() % 2) bytes.push_back(0);  // values have even length
  Writer::check(data.putAndInsertUint8Array(DCM_PixelData, bytes.data(), static_cast<unsigned long>(bytes.size())),
                DCM_PixelData);
  saveDicom(format, file, EXS_LittleEndianExplicit);
}

}  // namespace glisson::dicom
