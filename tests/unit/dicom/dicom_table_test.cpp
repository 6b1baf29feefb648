// SPDX-License-Identifier: GPL-3.0-or-later

// One test for each row of the table "case -> right behaviour" for DICOM input; E: error, W: warning, A: accepted.
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <sys/stat.h>

#include <chrono>
#include <fstream>
#include <set>

#include "dicom/detail/image_header.h"
#include "said.h"

namespace glisson::dicom {
namespace {

using test::DicomBytes;
using test::TemporaryFolder;
using testing::AllOf;
using testing::HasSubstr;

std::string ds(std::uint32_t tag, const std::string& value) {
  return DicomBytes::element(tag, "DS", value);
}
const auto isRefused = Not(HasSubstr("[read]"));
const auto isRead = HasSubstr("[read]");

/// What a stack of slices gives, each changed by its place.
std::string saidOfStack(int slices, const std::function<void(DicomBytes&, int)>& change) {
  const TemporaryFolder folder;
  for (int k = 0; k < slices; ++k) {
    DicomBytes d;
    d.sopUid += "." + std::to_string(k);
    d.position = "0\\0\\" + std::to_string(5 * k);
    change(d, k);
    d.write(folder / ("f" + std::to_string(100 + k)));
  }
  return saidOf(folder.path());
}

TEST(DicomTable, row01_E_noDicomTruncatedHeaderTruncatedPixels) {
  for (const std::string& bytes : {std::string(), std::string("text, no more"),
                                   "\x89PNG\r\n\x1a\n" + std::string(400, 'p'), std::string(128, '\0') + "DICM"})
    EXPECT_THAT(saidOfBytes(bytes), isRefused);
  const std::string whole = DicomBytes().bytes();
  EXPECT_THAT(saidOfBytes(whole.substr(0, 300)), AllOf(isRefused, HasSubstr("offset")));
  EXPECT_THAT(saidOfBytes(whole.substr(0, whole.size() - 2)), AllOf(isRefused, HasSubstr("truncated")));
}

TEST(DicomTable, row02_W_noPreambleForeignPreambleOrderOddLengthUnknownVr) {
  EXPECT_THAT(saidOfBytes(DicomBytes().dataset()), AllOf(isRead, HasSubstr("no DICOM preamble")));
  std::string bytes = DicomBytes().bytes();
  EXPECT_THAT(saidOfBytes(bytes.replace(0, 4,
                                        "\x7f"
                                        "ELF")),
              AllOf(isRead, HasSubstr("executable in its preamble")));
  EXPECT_THAT(saidOfBytes(bytes.replace(0, 4, std::string("II*\0", 4))), AllOf(isRead, HasSubstr("TIFF")));
  EXPECT_THAT(saidOfImage([](DicomBytes& d) {
                d.extra0008 = DicomBytes::element(0x00080070, "LO", "m") + DicomBytes::element(0x00080022, "DA", "");
              }),
              AllOf(isRead, HasSubstr("out of order")));
  EXPECT_THAT(saidOfImage([](DicomBytes& d) {
                d.extra0008 = DicomBytes::tag(0x00080070) + "LO" + DicomBytes::little(3, 2) + "abc";
              }),
              AllOf(isRead, HasSubstr("odd length")));
  EXPECT_THAT(saidOfImage([](DicomBytes& d) {
                d.extra0020 =
                    DicomBytes::tag(0x00211001) + "QQ" + DicomBytes::little(0, 2) + DicomBytes::little(2, 4) + "ab";
              }),
              AllOf(isRead, HasSubstr("unknown value representation")));
}

TEST(DicomTable, row03_E_lengthsBeyondTheFileNestingBombsA_privateUn) {
  EXPECT_THAT(saidOfImage([](DicomBytes& d) { d.extra0020 = DicomBytes::element(0x00209999, "LO", "x", 60000); }),
              AllOf(isRefused, HasSubstr("beyond the end")));
  std::string deep;
  for (int n = 0; n < 65; ++n)
    deep += DicomBytes::element(0x00081140, "SQ", "", 0xFFFFFFFFLL) + DicomBytes::tag(0xFFFEE000) +
            DicomBytes::little(0xFFFFFFFF, 4);
  EXPECT_THAT(saidOfImage([&](DicomBytes& d) { d.extra0008 = deep; }), AllOf(isRefused, HasSubstr("64 deep")));
  // As Siemens writes private blocks: kind unknown, bytes of any content.
  EXPECT_THAT(saidOfImage([](DicomBytes& d) {
                d.extra0020 = DicomBytes::element(0x00290010, "LO", "SIEMENS CSA HEADER") +
                              DicomBytes::element(0x00291010, "UN", std::string(5000, '\xfe'));
              }),
              isRead);
}

TEST(DicomTable, row04_E_sizesThatContradict) {
  for (const auto& change : std::vector<std::function<void(DicomBytes&)>>{
           [](DicomBytes& d) { d.rows = d.columns = 65535; }, [](DicomBytes& d) { d.rows = 0; },
           [](DicomBytes& d) { d.frames = "2147483647"; }, [](DicomBytes& d) { d.frames = "-3"; },
           [](DicomBytes& d) { d.stored = 17; }, [](DicomBytes& d) { d.highBit = 14; },
           [](DicomBytes& d) { d.allocated = 24; },
           [](DicomBytes& d) { d.extraBeforePixels = DicomBytes::element(0x00280010, "UL", DicomBytes::little(3, 4)); },
           [](DicomBytes& d) { d.extraBeforePixels = DicomBytes::us(0x00280011, 5); }})
    EXPECT_THAT(saidOfImage(change), isRefused);
}

TEST(DicomTable, row05_E_colourAndPalette) {
  EXPECT_THAT(saidOfImage([](DicomBytes& d) { d.photometric = "PALETTE COLOR"; }),
              AllOf(isRefused, HasSubstr("coloured elastogram is not a stiffness map")));
  EXPECT_THAT(saidOfImage([](DicomBytes& d) {
                d.photometric = "RGB";
                d.samples = 3;
                d.allocated = d.stored = 8;
                d.highBit = 7;
                d.pixels = std::string(36, '\2');
              }),
              AllOf(isRefused, HasSubstr("coloured elastogram is not a stiffness map")));
}

TEST(DicomTable, row06_skipped_noPixels) {
  DicomBytes d;
  d.pixelTag = 0x00420011;
  d.pixelVr = "OB";
  EXPECT_THAT(saidOfBytes(d.bytes()), AllOf(isRefused, HasSubstr("holds no pixel data")));
}

TEST(DicomTable, row07_A_floatAndDoublePixels) {
  const TemporaryFolder folder;
  DicomBytes d;
  d.allocated = d.stored = 32;
  d.highBit = 31;
  d.pixelTag = 0x7FE00008;
  d.pixelVr = "OF";
  d.pixels.clear();
  for (int n = 0; n < 12; ++n) {
    const float value = 0.1F * static_cast<float>(n);
    d.pixels.append(reinterpret_cast<const char*>(&value), 4);
  }
  const auto v = readSeries(scan(d.write(folder / "float")).series.at(0));
  for (int n = 0; n < 12; ++n) EXPECT_EQ(v.values[static_cast<std::size_t>(n)], 0.1F * static_cast<float>(n));
}

TEST(DicomTable, row08_E_transferSyntaxesAndCodeStreamsThatLie) {
  for (const char* syntax : {"1.2.3.4", "1.2.840.10008.1.2", "1.2.840.10008.1.2.2", "1.2.840.10008.1.2.5",
                             "1.2.840.10008.1.2.4.90", "1.2.840.10008.1.2.1.99"})
    EXPECT_THAT(saidOfImage([&](DicomBytes& d) { d.syntax = syntax; }), isRefused) << syntax;
  // One fragment of nonsense in each compressed syntax.
  for (const char* end : {"5", "4.50", "4.57", "4.70", "4.80", "4.90", "4.91"})
    EXPECT_THAT(saidOfImage([&](DicomBytes& d) {
                  d.syntax = std::string("1.2.840.10008.1.2.") + end;
                  d.pixelVr = "OB";
                  d.pixelLength = 0xFFFFFFFFLL;
                  d.pixels = DicomBytes::tag(0xFFFEE000) + DicomBytes::little(0, 4) + DicomBytes::tag(0xFFFEE000) +
                             DicomBytes::little(100, 4) + std::string(100, '\7') + DicomBytes::tag(0xFFFEE0DD) +
                             DicomBytes::little(0, 4);
                }),
                isRefused)
        << end;
}

TEST(DicomTable, row09_A_compressedSyntaxesW_lossy) {
  const TemporaryFolder folder;
  DicomBytes d;
  d.extraBeforePixels = DicomBytes::element(0x00282110, "CS", "01");
  EXPECT_THAT(saidOfBytes(d.bytes()), AllOf(isRead, HasSubstr("compressed with loss")));
  EXPECT_TRUE(scan(d.write(folder / "lossy")).series.at(0).lossy);
  EXPECT_FALSE(scan(DicomBytes().write(folder / "native")).series.at(0).lossy);
  // Bit-exactness of big endian, deflate, RLE, JPEG lossless, JPEG-LS and JPEG 2000: Syntaxes.* and Pixels.*.
}

TEST(DicomTable, row10_rescaleE_zeroNanHalfA_perSliceW_realWorldMap) {
  for (const std::string& wrong :
       {ds(0x00281052, "1") + ds(0x00281053, "0"), ds(0x00281052, "1") + ds(0x00281053, "nan"), ds(0x00281053, "2")})
    EXPECT_THAT(saidOfImage([&](DicomBytes& d) { d.rescale = wrong; }), isRefused);
  const TemporaryFolder folder;
  for (int k = 0; k < 3; ++k) {
    DicomBytes d;
    d.sopUid += std::to_string(k);
    d.position = "0\\0\\" + std::to_string(5 * k);
    d.rescale = ds(0x00281052, "0") + ds(0x00281053, std::to_string(0.1 * (k + 1)));
    d.write(folder / std::to_string(k));
  }
  const auto v = readSeries(scan(folder.path()).series.at(0));
  for (int k = 0; k < 3; ++k) EXPECT_FLOAT_EQ(v.at(0, 0, k), static_cast<float>(0.1 * (k + 1) * 257.0));
  const auto fd = [](std::uint32_t tag, double value) {
    return DicomBytes::element(tag, "FD", std::string(reinterpret_cast<const char*>(&value), 8));
  };
  const std::string map = fd(0x00409224, 1.0) + fd(0x00409225, 7.0);
  const std::string item = DicomBytes::tag(0xFFFEE000) + DicomBytes::little(map.size(), 4) + map;
  EXPECT_THAT(saidOfImage([&](DicomBytes& d) {
                d.rescale = ds(0x00281052, "0") + ds(0x00281053, "2");
                d.extraBeforePixels = DicomBytes::element(0x00409096, "SQ", item);
              }),
              AllOf(isRead, HasSubstr("differs from its rescale")));
  // Philips keeps a second scale in private attributes: the public one counts alone.
  DicomBytes philips;
  philips.rescale = ds(0x00281052, "0") + ds(0x00281053, "2");
  philips.extra0020 = "";
  philips.extraBeforePixels =
      DicomBytes::element(0x20050010, "LO", "Philips MR Imaging DD 001") + fd(0x2005100E, 100.0);
  const auto p = readSeries(scan(philips.write(folder / "philips")).series.at(0));
  EXPECT_EQ(p.values.front(), 514.0F);
}

TEST(DicomTable, row12_E_spacingPositionOrientation) {
  for (const char* spacing : {"0\\0", "-1\\1", "nan\\1", "1,64\\1,64", "1.64"})
    EXPECT_THAT(saidOfImage([&](DicomBytes& d) { d.spacing = spacing; }), isRefused) << spacing;
  for (const char* position : {"", "1e308\\0\\0"})
    EXPECT_THAT(saidOfImage([&](DicomBytes& d) { d.position = position; }), isRefused) << position;
  for (const char* orientation : {"0\\0\\0\\0\\0\\0", "1\\0\\0\\0.001\\1\\0"})
    EXPECT_THAT(saidOfImage([&](DicomBytes& d) { d.orientation = orientation; }), isRefused) << orientation;
}

TEST(DicomTable, row13_A_obliqueFeetFirstAnisotropicLandmarkRoundTrip) {
  const TemporaryFolder folder;
  for (const char* orientation : {"1\\0\\0\\0\\1\\0", "-1\\0\\0\\0\\-1\\0", "0\\1\\0\\0\\0\\-1", "1\\0\\0\\0\\0\\-1",
                                  "0.8\\0.6\\0\\-0.36\\0.48\\0.8"}) {
    for (int k = 0; k < 3; ++k) {
      DicomBytes d;
      d.sopUid += std::to_string(k);
      d.orientation = orientation;
      d.spacing = "2.5\\1.25";
      std::vector<double> o;
      std::istringstream text(orientation);
      for (std::string part; std::getline(text, part, '\\');) o.push_back(std::stod(part));
      const Eigen::Vector3d normal = Eigen::Vector3d(o[0], o[1], o[2]).cross(Eigen::Vector3d(o[3], o[4], o[5]));
      const Eigen::Vector3d at = Eigen::Vector3d(-40, 12, 77) + 7.0 * k * normal;
      std::ostringstream position;
      position.precision(12);
      position << at.x() << "\\" << at.y() << "\\" << at.z();
      d.position = position.str();
      d.extra0018 = ds(0x00180050, "4");  // thinner than the distance of the slices
      d.write(folder / std::to_string(k));
    }
    const Series s = scan(folder.path()).series.at(0);
    ASSERT_FALSE(s.error) << *s.error;
    EXPECT_TRUE(s.grid.spacing_mm.isApprox(Eigen::Vector3d(1.25, 2.5, 7.0), 1e-9)) << s.grid.spacing_mm;
    EXPECT_LT((s.grid.indexToLps({0, 0, 0}) - Eigen::Vector3d(-40, 12, 77)).norm(), 1e-6);
    const Eigen::Vector3d index(1.3, 0.2, 1.9);
    EXPECT_LT((s.grid.lpsToIndex(s.grid.indexToLps(index)) - index).norm(), 1e-6);
  }
}

TEST(DicomTable, row14_A_instanceNumbersHaveNoWeight) {
  for (const std::vector<std::string>& numbers :
       {std::vector<std::string>{"3", "2", "1"}, {"7", "7", "7"}, {"", "", ""}, {"9", "1", "5"}})
    EXPECT_THAT(saidOfStack(3,
                            [&](DicomBytes& d, int k) {
                              d.extraNumber =
                                  DicomBytes::element(0x00200013, "IS", numbers[static_cast<std::size_t>(k)]);
                            }),
                isRead);
}

TEST(DicomTable, row15_W_missingSliceWithItsPlace) {
  EXPECT_THAT(saidOfStack(4,
                          [](DicomBytes& d, int k) {
                            if (k == 3) d.position = "0\\0\\20";
                          }),
              AllOf(isRefused, HasSubstr("a slice is missing at 15 mm")));
}

TEST(DicomTable, row16_splitOrE_duplicatePositions) {
  EXPECT_THAT(saidOfStack(4, [](DicomBytes& d, int k) { d.position = "0\\0\\" + std::to_string(5 * (k / 2)); }),
              AllOf(isRefused, HasSubstr("several images lie at one position")));
  EXPECT_THAT(saidOfStack(4,
                          [](DicomBytes& d, int k) {
                            d.position = "0\\0\\" + std::to_string(5 * (k / 2));
                            d.extra0018 = ds(0x00180081, k % 2 == 0 ? "4.6" : "2.3");
                          }),
              AllOf(isRead, HasSubstr("volume 2 of 2"), HasSubstr("echo time 2.3")));
}

TEST(DicomTable, row17_E_gantryTilt) {
  EXPECT_THAT(saidOfStack(3, [](DicomBytes& d,
                                int k) { d.position = "0\\" + std::to_string(k) + "\\" + std::to_string(5 * k); }),
              AllOf(isRefused, HasSubstr("gantry tilt")));
}

TEST(DicomTable, row18_E_mixturesNameTheFiles) {
  EXPECT_THAT(saidOfStack(3, [](DicomBytes& d, int k) { d.spacing = k == 1 ? "2\\4" : "2\\3"; }),
              AllOf(isRefused, HasSubstr("pixel spacing"), HasSubstr("'f101'")));
  EXPECT_THAT(
      saidOfStack(3, [](DicomBytes& d, int k) { d.orientation = k == 1 ? "0\\1\\0\\1\\0\\0" : "1\\0\\0\\0\\1\\0"; }),
      AllOf(isRefused, HasSubstr("orientation"), HasSubstr("'f101'")));
  EXPECT_THAT(saidOfStack(3,
                          [](DicomBytes& d, int k) {
                            if (k == 1) std::swap(d.rows, d.columns);
                          }),
              AllOf(isRefused, HasSubstr("size"), HasSubstr("'f101'")));
}

TEST(DicomTable, row19_A_singleSliceForStatistics) {
  EXPECT_THAT(saidOfImage([](DicomBytes&) {}),
              AllOf(isRead, HasSubstr("single slice"), HasSubstr("a 3-D model is not")));
}

TEST(DicomTable, row21_A_enhancedMultiFrame) {
  GLISSON_NEEDS_DATA("mr750_and_odd_series");
  const std::pair<const char*, std::size_t> volumes[] = {{"philips_enhanced", 4}, {"siemens_multiframe", 1}};
  for (const auto& [folder, count] : volumes) {
    const ScanResult found = scan(test::sharedData() / "mr750_and_odd_series" / folder);
    EXPECT_EQ(found.series.size(), count) << folder;
    std::set<std::vector<float>> different;
    for (const Series& s : found.series) {
      EXPECT_FALSE(s.error) << folder;
      EXPECT_EQ(s.frames.size(), 8U) << folder;
      different.insert(readSeries(s).values);
    }
    EXPECT_EQ(different.size(), count) << folder << ": a volume is read twice";
  }
}

TEST(DicomTable, row22_A_characterSetsAndHostileIdentities) {
  for (const std::string& id :
       {std::string("../../x"), std::string("$(id)"), std::string(64000, 'A'), std::string("a\0b", 3),
        std::string("\xe2\x80\xae"
                    "gnp"),
        std::string("\xff\xfe\x80"), std::string("%n%s%s")}) {
    std::string image = DicomBytes().bytes();
    const std::string marked = DicomBytes::element(0x00100020, "LO", "PHI^CANARY");
    image.replace(image.find(marked), marked.size(), DicomBytes::element(0x00100020, "LO", id));
    const std::string description = DicomBytes::element(0x0008103E, "LO", id.substr(0, 60));
    image.replace(image.find(DicomBytes::tag(0x00100010)), 0, description);
    EXPECT_THAT(saidOfBytes(image), isRead) << id.substr(0, 10);
  }
}

TEST(DicomTable, row23_skipped_thousandsOfJunkFilesAndSpecialOnes) {
  const TemporaryFolder folder;
  for (int n = 0; n < 5000; ++n) std::ofstream(folder / ("junk" + std::to_string(n))) << "junk " << n;
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  std::filesystem::create_symlink("/dev/zero", folder / "zero");
  std::filesystem::create_directory_symlink(folder.path(), folder / "loop");
  DicomBytes().write(folder / "image");
  const auto begin = std::chrono::steady_clock::now();
  const ScanResult found = scan(folder.path());
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  EXPECT_EQ(found.series.size(), 1U);
  EXPECT_EQ(found.skipped.size(), 5003U);
  EXPECT_LT(seconds.count(), 10.0);
}

TEST(DicomTable, row24_inputsAreOpenedReadOnlyAndNeverTouched) {
  const TemporaryFolder folder;
  const auto file = DicomBytes().write(folder / "image");
  std::filesystem::permissions(file, std::filesystem::perms::owner_read);
  const auto before = std::filesystem::last_write_time(file);
  EXPECT_THAT(saidOf(file), isRead);
  EXPECT_EQ(std::filesystem::last_write_time(file), before);
  int files = 0;
  for ([[maybe_unused]] const auto& e : std::filesystem::directory_iterator(folder.path())) ++files;
  EXPECT_EQ(files, 1);
}

}  // namespace
}  // namespace glisson::dicom
