// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <zlib.h>

#include <cstring>
#include <functional>

#include "said.h"

namespace glisson::dicom {
namespace {

using test::DicomBytes;
using test::TemporaryFolder;
using testing::HasSubstr;

TEST(Hostile, theUnchangedImageIsRead) {
  EXPECT_THAT(saidOfImage([](DicomBytes&) {}), HasSubstr("[read]"));
}

TEST(Hostile, filesThatAreNoDicom) {
  EXPECT_THAT(saidOfBytes(""), HasSubstr("is empty"));
  EXPECT_THAT(saidOfBytes("hello, this is a text file"), HasSubstr("is not a DICOM file"));
  EXPECT_THAT(saidOfBytes(std::string("\x89PNG\r\n\x1a\n") + std::string(300, 'x')), HasSubstr("is not a DICOM file"));
  EXPECT_THAT(saidOfBytes(std::string(128, '\0') + "DICM"), HasSubstr("truncated header"));
  EXPECT_THROW(scan("/no/such/folder"), BadInput);
}

TEST(Hostile, everyTruncationEndsWithAReasonAndNeverWithPixels) {
  const std::string whole = DicomBytes().bytes();
  const TemporaryFolder folder;
  for (std::size_t keep = 0; keep < whole.size(); keep += 3) {
    const std::string said = saidOf(DicomBytes::write(folder / "cut", whole.substr(0, keep)));
    EXPECT_THAT(said, Not(HasSubstr("[read]"))) << keep;
    EXPECT_FALSE(said.empty()) << keep;
  }
}

TEST(Hostile, everySingleByteChangedEndsWellOrWithAReason) {
  const std::string whole = DicomBytes().bytes();
  const TemporaryFolder folder;
  int read = 0, refused = 0;
  for (std::size_t at = 128; at < whole.size(); ++at)
    for (const int value : {0x00, 0xFF, 0x80}) {
      std::string changed = whole;
      changed[at] = static_cast<char>(value);
      const std::string said = saidOf(DicomBytes::write(folder / "changed", changed));
      EXPECT_FALSE(said.empty()) << at;
      ++(said.find("[read]") != std::string::npos ? read : refused);
    }
  // A name or a pixel may change; a length, a tag or a size may not.
  std::printf("  %d read, %d refused\n", read, refused);
  EXPECT_GT(read, 0);
  EXPECT_GT(refused, 0);
}

TEST(Hostile, nestingBombsAreRefusedInEitherEncoding) {
  for (const int depth : {65, 5600, 100000}) {
    std::string bomb;
    for (int n = 0; n < depth; ++n)
      bomb += DicomBytes::element(0x00081140, "SQ", "", 0xFFFFFFFFLL) + DicomBytes::tag(0xFFFEE000) +
              DicomBytes::little(0xFFFFFFFF, 4);
    EXPECT_THAT(saidOfImage([&](DicomBytes& d) { d.extra0008 = bomb; }), HasSubstr("more than 64 deep")) << depth;
  }
  std::string implicit;  // defined lengths, from the inside out: no value representation says that these are sequences
  for (int n = 0; n < 3000; ++n) {
    const std::string item = DicomBytes::tag(0xFFFEE000) + DicomBytes::little(implicit.size(), 4) + implicit;
    implicit = DicomBytes::tag(0x00081140) + DicomBytes::little(item.size(), 4) + item;
  }
  EXPECT_THAT(saidOfBytes(DicomBytes::meta("1.2.840.10008.1.2") + implicit), HasSubstr("more than 64 deep"));
}

TEST(Hostile, imageSizesThatThePixelsDoNotBearOut) {
  EXPECT_THAT(saidOfImage([](DicomBytes& d) { d.frames = "2147483647"; }), HasSubstr("is truncated"));
  EXPECT_THAT(saidOfImage([](DicomBytes& d) { d.frames = "-1"; }), HasSubstr("NumberOfFrames"));
  EXPECT_THAT(saidOfImage([](DicomBytes& d) { d.frames = "99999999999999999999"; }), HasSubstr("NumberOfFrames"));
  EXPECT_THAT(saidOfImage([](DicomBytes& d) { d.rows = d.columns = 65535; }), HasSubstr("is truncated"));
  EXPECT_THAT(saidOfImage([](DicomBytes& d) { d.rows = 0; }), HasSubstr("Rows (0028,0010) is 0"));
  EXPECT_THAT(saidOfImage([](DicomBytes& d) { d.pixels += "\1\1\1\1"; }), HasSubstr("is not guessed"));
  EXPECT_THAT(saidOfImage([](DicomBytes& d) { d.pixels += std::string(4, '\0'); }),
              AllOf(HasSubstr("4 bytes of zeros"), HasSubstr("[read]")));
  EXPECT_THAT(saidOfImage([](DicomBytes& d) { d.pixelLength = 4000000000LL; }), HasSubstr("is truncated"));
  EXPECT_THAT(saidOfImage([](DicomBytes& d) { d.stored = 17; }), HasSubstr("BitsStored"));
  EXPECT_THAT(saidOfImage([](DicomBytes& d) { d.stored = 12; }), HasSubstr("HighBit"));
  EXPECT_THAT(saidOfImage([](DicomBytes& d) { d.allocated = 12; }), HasSubstr("BitsAllocated"));
  EXPECT_THAT(saidOfImage([](DicomBytes& d) {
                d.extraBeforePixels = DicomBytes::element(0x00280010, "UL", DicomBytes::little(3, 4));
              }),
              HasSubstr("must be one 16-bit unsigned number"));
  EXPECT_THAT(saidOfImage([](DicomBytes& d) { d.extraBeforePixels = DicomBytes::us(0x00280011, 3); }),
              HasSubstr("occurs twice with different values"));
}

TEST(Hostile, geometryThatIsNone) {
  for (const char* spacing : {"0\\1", "-1\\1", "nan\\nan", "1,64\\1,64", "1.64", "1e999\\1", "", "1\\2\\3", "inf\\1"})
    EXPECT_THAT(saidOfImage([&](DicomBytes& d) { d.spacing = spacing; }), HasSubstr("PixelSpacing")) << spacing;
  for (const char* position : {"", "1\\2", "1e308\\0\\0", "a\\b\\c"})
    EXPECT_THAT(saidOfImage([&](DicomBytes& d) { d.position = position; }), HasSubstr("ImagePositionPatient"))
        << position;
  for (const char* orientation : {"0\\0\\0\\0\\0\\0", "1\\0\\0\\0.001\\1\\0", "1\\0\\0\\1\\0\\0", "1\\0\\0"})
    EXPECT_THAT(saidOfImage([&](DicomBytes& d) { d.orientation = orientation; }), HasSubstr("ImageOrientationPatient"))
        << orientation;
}

TEST(Hostile, rescaleThatIsNone) {
  const auto intercept = DicomBytes::element(0x00281052, "DS", "5");
  EXPECT_THAT(saidOfImage([&](DicomBytes& d) { d.rescale = intercept; }), HasSubstr("has only one of"));
  EXPECT_THAT(saidOfImage([&](DicomBytes& d) { d.rescale = intercept + DicomBytes::element(0x00281053, "DS", "0"); }),
              HasSubstr("RescaleSlope (0028,1053) is 0"));
  EXPECT_THAT(saidOfImage([&](DicomBytes& d) { d.rescale = intercept + DicomBytes::element(0x00281053, "DS", "nan"); }),
              HasSubstr("no finite decimal number"));
}

TEST(Hostile, transferSyntaxesThatLie) {
  EXPECT_THAT(saidOfImage([](DicomBytes& d) { d.syntax = "1.2.3.4"; }), HasSubstr("unknown transfer syntax '1.2.3.4'"));
  EXPECT_THAT(saidOfImage([](DicomBytes& d) { d.syntax = "1.2.840.10008.1.2"; }), HasSubstr("written with explicit"));
  EXPECT_THAT(saidOfImage([](DicomBytes& d) { d.syntax = "1.2.840.10008.1.2.2"; }), HasSubstr("byte order"));
  EXPECT_THAT(saidOfImage([](DicomBytes& d) { d.syntax = "1.2.840.10008.1.2.1.99"; }), HasSubstr("damaged"));
  // A run-length syntax whose pixels are native.
  EXPECT_THAT(saidOfImage([](DicomBytes& d) { d.syntax = "1.2.840.10008.1.2.5"; }),
              HasSubstr("declares compressed pixels"));
  EXPECT_THAT(saidOfBytes(DicomBytes().dataset()), AllOf(HasSubstr("no DICOM preamble"), HasSubstr("[read]")));
}

std::string deflated(const std::string& plain) {
  z_stream z{};
  deflateInit2(&z, 9, Z_DEFLATED, -MAX_WBITS, 9, Z_DEFAULT_STRATEGY);
  std::string out(plain.size() + 1000, '\0');
  std::string in = plain;
  z.next_in = reinterpret_cast<Bytef*>(in.data());
  z.avail_in = static_cast<uInt>(in.size());
  z.next_out = reinterpret_cast<Bytef*>(out.data());
  z.avail_out = static_cast<uInt>(out.size());
  deflate(&z, Z_FINISH);
  out.resize(out.size() - z.avail_out);
  deflateEnd(&z);
  return out;
}

TEST(Hostile, deflatedFilesAreReadAndBombsAreNot) {
  const std::string syntax = "1.2.840.10008.1.2.1.99";
  DicomBytes image;
  EXPECT_THAT(saidOfBytes(DicomBytes::meta(syntax) + deflated(image.dataset())), HasSubstr("[read]"));
  image.rows = 5000;
  image.columns = 5000;
  image.pixels = std::string(50'000'000, '\0');
  EXPECT_THAT(saidOfBytes(DicomBytes::meta(syntax) + deflated(image.dataset())),
              HasSubstr("beyond 100 times its size"));
}

TEST(Hostile, coloursAreNoMeasuredValues) {
  const std::string said = saidOfImage([](DicomBytes& d) {
    d.samples = 3;
    d.photometric = "RGB";
    d.allocated = d.stored = 8;
    d.highBit = 7;
    d.pixels = std::string(36, '\2');
    d.extraBeforePixels = "";
  });
  EXPECT_THAT(said, HasSubstr("coloured elastogram is not a stiffness map"));
}

TEST(Hostile, specialFilesAndLinksAreSkippedUnopened) {
  const TemporaryFolder folder;
  const TemporaryFolder elsewhere;
  DicomBytes().write(folder / "image");
  DicomBytes().write(elsewhere / "other");
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  namespace fs = std::filesystem;
  fs::create_symlink("/dev/zero", folder / "zero");
  fs::create_directory_symlink(folder.path(), folder / "loop");
  fs::create_symlink(elsewhere / "other", folder / "outside");
  fs::create_symlink(folder / "nothing", folder / "dangling");
  const ScanResult found = scan(folder.path());
  ASSERT_EQ(found.series.size(), 1U);
  ASSERT_EQ(found.skipped.size(), 5U);
  EXPECT_THAT(found.skipped[0].reason, HasSubstr("leads nowhere"));
  EXPECT_THAT(found.skipped[1].reason, HasSubstr("is a link"));
  EXPECT_THAT(found.skipped[2].reason, HasSubstr("leaves the folder"));
  EXPECT_THAT(found.skipped[3].reason, HasSubstr("no regular file"));
  EXPECT_THAT(found.skipped[4].reason, HasSubstr("leaves the folder"));
}

TEST(Hostile, aRefusedSliceMakesItsSeriesIncomplete) {
  const TemporaryFolder folder;
  for (int k = 0; k < 4; ++k) {
    DicomBytes d;
    d.sopUid += std::to_string(k);
    d.position = "0\\0\\" + std::to_string(5 * k);
    if (k == 3) d.spacing = "0\\0";
    d.write(folder / ("slice" + std::to_string(k)));
  }
  EXPECT_THAT(saidOf(folder.path()), AllOf(HasSubstr("it is incomplete: 'slice3'"), Not(HasSubstr("[read]"))));
}

TEST(Hostile, identityNeverShowsAndStillTellsPatientsApart) {
  const TemporaryFolder folder;
  DicomBytes d;
  d.write(folder / "one");
  std::string other = d.bytes();
  const std::size_t at = other.find("PHI^CANARY");
  other.replace(at, 10, "PHI^CANARX");
  DicomBytes::write(folder / "two", other);
  const std::string one = scan(folder / "one").series.at(0).patientKey;
  EXPECT_EQ(one.size(), 64U);
  EXPECT_NE(one, scan(folder / "two").series.at(0).patientKey);
}

}  // namespace
}  // namespace glisson::dicom
