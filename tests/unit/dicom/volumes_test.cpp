// SPDX-License-Identifier: GPL-3.0-or-later
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/error.h"
#include "dicom/series.h"
#include "dicom/write_mr.h"
#include "dicom_bytes.h"
#include "support/support.h"

namespace glisson::dicom {
namespace {

using test::DicomBytes;
using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;

std::string ds(std::uint32_t tag, double value) {
  return DicomBytes::element(tag, "DS", std::to_string(value));
}

/// Slices 5 mm apart with their place as pixel value; name and value are given by the place in the list.
void writeStack(const TemporaryFolder& folder, const std::vector<int>& places,
                const std::function<void(DicomBytes&, int)>& change = {}) {
  for (std::size_t n = 0; n < places.size(); ++n) {
    DicomBytes d;
    d.sopUid += "." + std::to_string(n + 1);
    d.position = "0\\0\\" + std::to_string(5 * places[n]);
    d.extra0020 = DicomBytes::element(0x00201041, "DS", "0");  // SliceLocation: of no weight
    d.pixels.clear();
    for (int pixel = 0; pixel < 12; ++pixel)
      d.pixels += DicomBytes::little(static_cast<unsigned>(100 * places[n] + pixel), 2);
    if (change) change(d, static_cast<int>(n));
    d.write(folder / ("f" + std::to_string(n)));
  }
}

TEST(Volumes, areOrderedByPositionWhateverTheFilesAreCalled) {
  const TemporaryFolder folder;
  writeStack(folder, {3, 0, 2, 1});
  const ScanResult found = scan(folder.path());
  ASSERT_EQ(found.series.size(), 1U);
  const image::ScalarVolume v = readSeries(found.series.front());
  EXPECT_EQ(v.grid.size, Eigen::Vector3i(4, 3, 4));
  EXPECT_TRUE(v.grid.spacing_mm.isApprox(Eigen::Vector3d(3, 2, 5)));
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 4; ++i) EXPECT_EQ(v.at(i, j, k), static_cast<float>(100 * k + 4 * j + i));
}

TEST(Volumes, twoEchoesAreSplitAndNeverInterleaved) {
  const TemporaryFolder folder;
  writeStack(folder, {0, 1, 2, 0, 1, 2}, [](DicomBytes& d, int n) {
    d.extra0018 = ds(0x00180081, n < 3 ? 10.4 : 4.6);
    if (n < 3) d.pixels = std::string(24, '\0');
  });
  const ScanResult found = scan(folder.path());
  ASSERT_EQ(found.series.size(), 2U);
  EXPECT_EQ(found.series[0].uid, "1.2.3.4");
  EXPECT_EQ(found.series[1].uid, "1.2.3.4#2");
  EXPECT_EQ(readSeries(found.series[0]).at(1, 0, 2), 201.0F);  // echo time 4.6 comes first
  EXPECT_EQ(readSeries(found.series[1]).at(1, 0, 2), 0.0F);
}

TEST(Volumes, unexplainedDuplicatesAreRefusedAndCopiesAreSkipped) {
  const TemporaryFolder folder;
  writeStack(folder, {0, 1, 1});
  EXPECT_THAT(scan(folder.path()).series.at(0).error.value_or(""), HasSubstr("'f1', 'f2'"));
  const TemporaryFolder copies;
  writeStack(copies, {0, 1, 2, 1}, [](DicomBytes& d, int n) {
    if (n == 3) d.sopUid = "1.2.3.4.1.2";
  });
  const ScanResult found = scan(copies.path());
  EXPECT_FALSE(found.series.at(0).error);
  EXPECT_THAT(found.skipped.at(0).reason, HasSubstr("is a copy of 'f1'"));
}

TEST(Volumes, gapsAreNamedAndNothingIsAveraged) {
  const TemporaryFolder folder;
  writeStack(folder, {0, 1, 2, 4});
  const Series missing = scan(folder.path()).series.at(0);
  EXPECT_THAT(missing.error.value_or(""), AllOf(HasSubstr("missing at 15 mm"), HasSubstr("'f2' and 'f3'")));
  EXPECT_DOUBLE_EQ(missing.grid.spacing_mm.z(), 5.0);
  EXPECT_THROW(readSeries(missing), BadInput);
  const TemporaryFolder other;
  writeStack(other, {0, 1, 2, 3}, [](DicomBytes& d, int n) {
    if (n == 3) d.position = "0\\0\\17.5";
  });
  EXPECT_THAT(scan(other.path()).series.at(0).error.value_or(""), HasSubstr("unevenly spaced"));
}

TEST(Volumes, mixedSizeOrientationAndFrameOfReferenceNameTheFiles) {
  const TemporaryFolder folder;
  writeStack(folder, {0, 1, 2}, [](DicomBytes& d, int n) {
    if (n == 2) d.spacing = "2\\4";
  });
  EXPECT_THAT(scan(folder.path()).series.at(0).error.value_or(""),
              AllOf(HasSubstr("pixel spacing"), HasSubstr("'f2'"), HasSubstr("'f0', 'f1'")));
  const TemporaryFolder sizes;
  writeStack(sizes, {0, 1, 2}, [](DicomBytes& d, int n) {
    if (n == 0) {
      d.rows = 4;
      d.columns = 3;
    }
  });
  EXPECT_THAT(scan(sizes.path()).series.at(0).error.value_or(""), HasSubstr("size"));
}

TEST(Pixels, rescaleOfEachSliceSignAndStoredBits) {
  const TemporaryFolder folder;
  writeStack(folder, {0, 1, 2}, [](DicomBytes& d, int n) {
    d.rescale = ds(0x00281052, -10.0 * n) + ds(0x00281053, 0.5 * (n + 1));
    d.stored = 12;
    d.highBit = 11;
    d.representation = 1;
    d.pixels.clear();
    for (int pixel = 0; pixel < 12; ++pixel) d.pixels += DicomBytes::little(pixel % 2 == 0 ? 0xF7FF : 0x7800, 2);
  });
  const image::ScalarVolume v = readSeries(scan(folder.path()).series.at(0));
  for (int k = 0; k < 3; ++k) {
    // 0x7FF is the largest 12-bit number, 0x800 the smallest; the upper four bits are none of the pixel.
    EXPECT_FLOAT_EQ(v.at(0, 0, k), static_cast<float>(0.5 * (k + 1) * 2047 - 10.0 * k));
    EXPECT_FLOAT_EQ(v.at(1, 0, k), static_cast<float>(0.5 * (k + 1) * -2048 - 10.0 * k));
  }
}

TEST(Pixels, eightAndThirtyTwoBits) {
  const TemporaryFolder folder;
  DicomBytes d;
  d.allocated = d.stored = 8;
  d.highBit = 7;
  d.representation = 1;
  d.pixels = std::string("\x80\x7f\xff\x01", 4) + std::string(8, '\0');
  d.pixelVr = "OB";
  const auto eight = readSeries(scan(d.write(folder / "eight")).series.at(0));
  EXPECT_THAT(std::vector<float>(eight.values.begin(), eight.values.begin() + 4), ElementsAre(-128, 127, -1, 1));
  d.allocated = d.stored = 32;
  d.highBit = 31;
  d.pixels = DicomBytes::little(0x80000000, 4) + DicomBytes::little(70000, 4) + std::string(40, '\0');
  d.pixelVr = "OW";
  const auto wide = readSeries(scan(d.write(folder / "wide")).series.at(0));
  EXPECT_EQ(wide.values[0], -2147483648.0F);
  EXPECT_EQ(wide.values[1], 70000.0F);
}

TEST(Pixels, bigEndianFilesHoldTheSameValues) {
  const TemporaryFolder folder;
  for (const unsigned bits : {8U, 16U})
    for (const char* vr : {"OB", "OW"}) {
      if (bits == 16 && vr[1] == 'B') continue;  // 16-bit pixels are words
      DicomBytes d;
      d.allocated = d.stored = bits;
      d.highBit = bits - 1;
      d.pixelVr = vr;
      d.pixels.clear();
      for (unsigned n = 0; n < 12; ++n) d.pixels += DicomBytes::little(n * 17 + 1, static_cast<int>(bits / 8));
      d.write(folder / "little");
      DcmFileFormat file;  // DCMTK turns the bytes round
      ASSERT_TRUE(file.loadFile((folder / "little").c_str()).good());
      ASSERT_TRUE(file.saveFile((folder / "big").c_str(), EXS_BigEndianExplicit).good());
      const auto big = readSeries(scan(folder / "big").series.at(0));
      EXPECT_EQ(big.values, readSeries(scan(folder / "little").series.at(0)).values) << bits << vr;
      EXPECT_EQ(big.values[11], 188.0F);
    }
}

TEST(Roles, geProductsAreKnownByTheirNumbers) {
  const TemporaryFolder folder;
  image::Volume<std::int16_t> map(test::letterF().grid, 2100);
  MrSeriesHeader header;
  header.studyUid = "1.2.3";
  header.frameOfReferenceUid = "1.2.3.9";
  const auto roleOf = [&](int number, const std::string& sequence, const std::string& description) {
    header.seriesNumber = number;
    header.pulseSequence = sequence;
    header.seriesDescription = description;
    header.seriesUid = "1.2.3.4." + std::to_string(number) + (sequence.empty() ? "1" : "2");
    const auto where = folder / (sequence + std::to_string(number));
    writeMrSeries(where, header, map);
    const ScanResult found = scan(where);
    EXPECT_EQ(found.series.size(), 1U);
    EXPECT_FALSE(found.series.at(0).roleReason.empty());
    return found.series.at(0);
  };
  const Series stiffness = roleOf(401, "epimre", "a");
  EXPECT_EQ(stiffness.role, SeriesRole::Stiffness);
  EXPECT_EQ(stiffness.unit.value_or(""), "Pa");
  EXPECT_EQ(readSeries(stiffness).values, std::vector<float>(map.values.size(), 2100.0F));
  EXPECT_TRUE(stiffness.grid.sameGeometry(map.grid, 1e-3));
  EXPECT_EQ(roleOf(405, "epimre", "a").role, SeriesRole::Wave);
  EXPECT_EQ(roleOf(407, "fgremre", "a").role, SeriesRole::Confidence);
  EXPECT_EQ(roleOf(4, "fgremre", "a").role, SeriesRole::Magnitude);
  EXPECT_EQ(roleOf(3, "", "Ax LAVA").role, SeriesRole::Anatomical);
  EXPECT_EQ(roleOf(9, "", "MRE stiffness (kPa)").role, SeriesRole::Stiffness);
  EXPECT_EQ(roleOf(10, "", "MRE confidence").role, SeriesRole::Confidence);
  image::Volume<std::array<std::uint8_t, 3>> colours(map.grid, {1, 2, 3});
  header.seriesUid = "1.2.3.4.77";
  writeMrColourSeries(folder / "colour", header, colours);
  const Series copy = scan(folder / "colour").series.at(0);
  EXPECT_EQ(copy.role, SeriesRole::ColourCopy);
  EXPECT_THROW(readSeries(copy), BadInput);

  const ScanResult all = scan(folder.path());
  EXPECT_EQ(findRole(all, SeriesRole::Wave).number, 405);
  EXPECT_THROW(findRole(ScanResult{}, SeriesRole::Stiffness), BadInput);
}

}  // namespace
}  // namespace glisson::dicom
