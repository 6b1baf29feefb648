// SPDX-License-Identifier: GPL-3.0-or-later
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcpixel.h>
#include <dcmtk/dcmdata/dcpixseq.h>
#include <dcmtk/dcmdata/dcpxitem.h>
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmjpeg/djencode.h>
#include <dcmtk/dcmjpeg/djrplol.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <set>
#include <sstream>

#include "base/error.h"
#include "base/random.h"
#include "dicom/detail/jpeg2000.h"
#include "dicom/series.h"
#include "support/support.h"

namespace glisson::dicom {
namespace {

using testing::HasSubstr;

std::filesystem::path pydicomFile(const std::string& name) {
  return test::sharedData() / "dicom_seg_rtstruct" / "pydicom_data" / name;
}

/// These files lost their functional groups when they were made anonymous; this gives each frame a place 1.2 mm further
/// on, and leaves the pixels as they are. change may alter the data set.
std::filesystem::path placed(const std::string& name, const std::filesystem::path& to,
                             const std::function<void(DcmDataset&)>& change = {}) {
  DcmFileFormat file;
  EXPECT_TRUE(file.loadFile(pydicomFile(name).c_str()).good());
  DcmDataset& data = *file.getDataset();
  const E_TransferSyntax syntax = data.getOriginalXfer();
  const auto item = [](DcmItem& holder, const DcmTagKey& sequence) -> DcmItem& {
    DcmItem* made = nullptr;
    holder.findOrCreateSequenceItem(sequence, made, -2);
    return *made;
  };
  DcmItem& shared = item(data, DCM_SharedFunctionalGroupsSequence);
  item(shared, DCM_PlaneOrientationSequence).putAndInsertString(DCM_ImageOrientationPatient, "1\\0\\0\\0\\1\\0");
  item(shared, DCM_PixelMeasuresSequence).putAndInsertString(DCM_PixelSpacing, "2\\3");
  for (int n = 0; n < 10; ++n) {
    const std::string position = "0\\0\\" + std::to_string(1.2 * n);
    item(item(data, DCM_PerFrameFunctionalGroupsSequence), DCM_PlanePositionSequence)
        .putAndInsertString(DCM_ImagePositionPatient, position.c_str());
  }
  if (change) change(data);
  EXPECT_TRUE(file.saveFile(to.c_str(), syntax).good());
  return to;
}

image::ScalarVolume readOnly(const std::filesystem::path& file) {
  const ScanResult found = scan(file);
  if (found.series.size() != 1U) throw BadInput(found.skipped.at(0).reason);
  return readSeries(found.series.front());
}

/// The pixels as they lie in the uncompressed file.
std::vector<float> nativePixels() {
  DcmFileFormat file;
  file.loadFile(pydicomFile("emri_small.dcm").c_str());
  const Uint16* pixels = nullptr;
  file.getDataset()->findAndGetUint16Array(DCM_PixelData, pixels);
  return {pixels, pixels + 64 * 64 * 10};
}

TEST(Syntaxes, losslessOnesGiveTheSameVoxels) {
  GLISSON_NEEDS_DATA("dicom_seg_rtstruct");
  const test::TemporaryFolder folder;
  const std::vector<float> truth = nativePixels();
  for (const char* name :
       {"emri_small.dcm", "emri_small_big_endian.dcm", "emri_small_RLE.dcm", "emri_small_jpeg_ls_lossless.dcm"}) {
    const image::ScalarVolume volume = readOnly(placed(name, folder / name));
    EXPECT_EQ(volume.grid.size, Eigen::Vector3i(64, 64, 10));
    EXPECT_TRUE(volume.grid.spacing_mm.isApprox(Eigen::Vector3d(3, 2, 1.2)));
    EXPECT_EQ(volume.values, truth) << name;
    // Without their functional groups the same frames have no place, and that is said.
    EXPECT_THROW(readOnly(pydicomFile(name)), BadInput);
  }
}

TEST(Syntaxes, jpegLosslessGivesTheSameVoxels) {
  GLISSON_NEEDS_DATA("dicom_seg_rtstruct");
  const test::TemporaryFolder folder;
  DJEncoderRegistration::registerCodecs();
  DcmFileFormat file;
  ASSERT_TRUE(file.loadFile(placed("emri_small.dcm", folder / "native").c_str()).good());
  const DJ_RPLossless parameters;
  ASSERT_TRUE(file.getDataset()->chooseRepresentation(EXS_JPEGProcess14SV1, &parameters).good());
  ASSERT_TRUE(file.saveFile((folder / "jpeg").c_str(), EXS_JPEGProcess14SV1).good());
  DJEncoderRegistration::cleanup();
  EXPECT_EQ(readOnly(folder / "jpeg").values, nativePixels());
}

TEST(Syntaxes, theSameImageInEightEncodingsIsTheSameToTheBit) {
  const std::filesystem::path folder = "/usr/lib/python3/dist-packages/pydicom/data/test_files";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "Debian's python3-pydicom is not installed";
  const image::ScalarVolume truth = readOnly(folder / "MR_small.dcm");
  EXPECT_GT(std::set<float>(truth.values.begin(), truth.values.end()).size(), 100U);
  for (const char* name : {"MR_small_RLE.dcm", "MR_small_bigendian.dcm", "MR_small_expb.dcm", "MR_small_implicit.dcm",
                           "MR_small_jp2klossless.dcm", "MR_small_jpeg_ls_lossless.dcm", "MR_small_padded.dcm"}) {
    const image::ScalarVolume v = readOnly(folder / name);
    EXPECT_EQ(v.values, truth.values) << name;
    EXPECT_TRUE(v.grid.sameGeometry(truth.grid, 1e-9)) << name;
  }
}

TEST(Syntaxes, codeStreamsOfAnotherSizeAreRefused) {
  GLISSON_NEEDS_DATA("dicom_seg_rtstruct");
  const test::TemporaryFolder folder;
  const auto taller = [](DcmDataset& data) { data.putAndInsertUint16(DCM_Rows, 65); };
  for (const char* name : {"emri_small_RLE.dcm", "emri_small_jpeg_ls_lossless.dcm", "emri_small_jpeg_2k_lossless.dcm"})
    EXPECT_THROW(readOnly(placed(name, folder / name, taller)), BadInput) << name;
  const auto shorter = [](DcmDataset& data) { data.putAndInsertUint16(DCM_Rows, 63); };
  for (const char* name : {"emri_small_RLE.dcm", "emri_small_jpeg_ls_lossless.dcm", "emri_small_jpeg_2k_lossless.dcm"})
    EXPECT_THROW(readOnly(placed(name, folder / name, shorter)), BadInput) << name;
  const auto eightBits = [](DcmDataset& data) {
    data.putAndInsertUint16(DCM_BitsAllocated, 8);
    data.putAndInsertUint16(DCM_BitsStored, 8);
    data.putAndInsertUint16(DCM_HighBit, 7);
  };
  for (const char* name : {"emri_small_RLE.dcm", "emri_small_jpeg_ls_lossless.dcm", "emri_small_jpeg_2k_lossless.dcm"})
    EXPECT_THROW(readOnly(placed(name, folder / name, eightBits)), BadInput) << name;
}

TEST(Syntaxes, damagedCompressedFilesGiveVoxelsOrAReason) {
  GLISSON_NEEDS_DATA("dicom_seg_rtstruct");
  const test::TemporaryFolder folder;
  Random random(7);
  for (const char* name :
       {"emri_small_RLE.dcm", "emri_small_jpeg_ls_lossless.dcm", "emri_small_jpeg_2k_lossless.dcm", "emri_small.dcm"}) {
    std::ifstream in(placed(name, folder / name), std::ios::binary);
    std::ostringstream all;
    all << in.rdbuf();
    const std::string whole = all.str();
    for (int n = 0; n < 200; ++n) {
      std::string damaged = whole;
      const auto changes = 1 + random.below(20);
      for (std::uint64_t c = 0; c < changes; ++c)
        damaged[132 + random.below(whole.size() - 132)] = static_cast<char>(random.below(256));
      if (n % 5 == 0) damaged.resize(132 + random.below(whole.size() - 132));
      std::ofstream(folder / "damaged", std::ios::binary) << damaged;
      const ScanResult found = scan(folder / "damaged");
      EXPECT_EQ(found.series.empty(), !found.skipped.empty());
      for (const Series& series : found.series) {
        try {
          EXPECT_EQ(readSeries(series).values.size(), series.grid.voxelCount());
        } catch (const BadInput& e) {
          EXPECT_GT(std::string(e.what()).size(), 20U);
        }
      }
    }
  }
}

TEST(Syntaxes, jpeg2000GivesTheSameVoxels) {
  GLISSON_NEEDS_DATA("dicom_seg_rtstruct");
  const test::TemporaryFolder folder;
  const image::ScalarVolume v = readOnly(placed("emri_small_jpeg_2k_lossless.dcm", folder / "j2k"));
  EXPECT_EQ(v.values, nativePixels());
  // A code stream that ends too early is an error, never half a picture.
  DcmFileFormat file;
  ASSERT_TRUE(file.loadFile((folder / "j2k").c_str()).good());
  DcmElement* element = nullptr;
  DcmPixelSequence* fragments = nullptr;
  DcmPixelItem* first = nullptr;
  Uint8* bytes = nullptr;
  ASSERT_TRUE(file.getDataset()->findAndGetElement(DCM_PixelData, element).good());
  ASSERT_TRUE(dynamic_cast<DcmPixelData&>(*element)
                  .getEncapsulatedRepresentation(EXS_JPEG2000LosslessOnly, nullptr, fragments)
                  .good());
  ASSERT_TRUE(fragments->getItem(first, 1).good());
  ASSERT_TRUE(first->getUint8Array(bytes).good());
  const std::vector<std::uint8_t> stream(bytes, bytes + first->getLength());
  EXPECT_EQ(detail::decodeJpeg2000(stream, 64, 64, 2).size(), 8192U);
  for (std::size_t keep = 0; keep < stream.size() - 8; keep += 101)
    EXPECT_THROW(detail::decodeJpeg2000({bytes, bytes + keep}, 64, 64, 2), BadInput) << keep;
  EXPECT_THROW(detail::decodeJpeg2000(stream, 64, 63, 2), BadInput);
  EXPECT_THROW(detail::decodeJpeg2000(stream, 64, 64, 1), BadInput);
  // Unsigned numbers where the header says signed.
  const auto isSigned = [](DcmDataset& data) { data.putAndInsertUint16(DCM_PixelRepresentation, 1); };
  EXPECT_THROW(readOnly(placed("emri_small_jpeg_2k_lossless.dcm", folder / "signed", isSigned)), BadInput);
}

TEST(Syntaxes, floatAndDoublePixelsAreReadAsTheyAre) {
  GLISSON_NEEDS_DATA("dicom_seg_rtstruct");
  const ScanResult asFloat = scan(pydicomFile("parametric_map_float.dcm"));
  const ScanResult asDouble = scan(pydicomFile("parametric_map_double_float.dcm"));
  ASSERT_EQ(asFloat.series.size(), 1U) << asFloat.skipped.at(0).reason;
  ASSERT_EQ(asDouble.series.size(), 1U) << asDouble.skipped.at(0).reason;
  const image::ScalarVolume a = readSeries(asFloat.series.front());
  const image::ScalarVolume b = readSeries(asDouble.series.front());
  EXPECT_EQ(a.values.size(), 128U * 128U);
  EXPECT_GT(std::set<float>(a.values.begin(), a.values.end()).size(), 100U);
  EXPECT_EQ(b.values.size(), 128U * 128U);
  EXPECT_GT(std::set<float>(b.values.begin(), b.values.end()).size(), 100U);
}

TEST(Syntaxes, whatHoldsNoImageIsListed) {
  GLISSON_NEEDS_DATA("dicom_seg_rtstruct");
  const ScanResult found = scan(test::sharedData() / "dicom_seg_rtstruct" / "rt-utils");
  EXPECT_EQ(found.skipped.size(), 3U);
  for (const SkippedFile& s : found.skipped) EXPECT_THAT(s.reason, HasSubstr("RT Structure Set"));
  const ScanResult labels = scan(test::sharedData() / "dicom_seg_rtstruct" / "dcmqi" / "liver.dcm");
  ASSERT_EQ(labels.skipped.size(), 1U);
  EXPECT_THAT(labels.skipped.front().reason, HasSubstr("Segmentation"));
}

TEST(Syntaxes, obliqueImagesWithOtherRowThanColumnSpacingKeepTheirPlace) {
  GLISSON_NEEDS_DATA("dicom_seg_rtstruct");
  const ScanResult found = scan(test::sharedData() / "dicom_seg_rtstruct" / "rt-utils" / "oriented_data");
  ASSERT_EQ(found.series.size(), 1U);
  const Series& s = found.series.front();
  ASSERT_FALSE(s.error) << *s.error;
  // As dcmdump shows them: (0020,0032) of 0.dcm and 2.dcm, (0028,0030) 3.5\2.5, 50 rows, 100 columns.
  EXPECT_EQ(s.grid.size, Eigen::Vector3i(100, 50, 3));
  EXPECT_NEAR(s.grid.spacing_mm.x(), 2.5, 1e-12);
  EXPECT_NEAR(s.grid.spacing_mm.y(), 3.5, 1e-12);
  EXPECT_LT((s.grid.indexToLps({0, 0, 0}) - Eigen::Vector3d(123, -432, 30)).norm(), 1e-6);
  EXPECT_LT((s.grid.indexToLps({0, 0, 2}) - Eigen::Vector3d(122.0159697, -428.1596334, 38.0798058)).norm(), 1e-3);
  const Eigen::Vector3d row(.9541666, -.2080757, .2151061);
  EXPECT_LT((s.grid.indexToLps({99, 0, 0}) - s.grid.indexToLps({0, 0, 0}) - 99 * 2.5 * row).norm(), 1e-3);
  EXPECT_NO_THROW(readSeries(s));
}

}  // namespace
}  // namespace glisson::dicom
