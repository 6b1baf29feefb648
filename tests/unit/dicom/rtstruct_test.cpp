// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/rtstruct.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmrt/drtstrct.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "base/error.h"
#include "dicom/detail/keyhole.h"
#include "dicom/detail/reader_process.h"
#include "dicom/write_mr.h"
#include "dicom_bytes.h"
#include "support/support.h"

namespace glisson::dicom {
namespace {

using test::TemporaryFolder;
using testing::HasSubstr;

std::filesystem::path shared(const std::string& name) {
  return test::sharedData() / "dicom_seg_rtstruct" / name;
}

/// A written MR series on the oblique grid of the letter F.
Series writtenSource(const TemporaryFolder& folder) {
  MrSeriesHeader header;
  header.patientName = "PHI^CANARY";
  header.studyUid = "1.2.3";
  header.seriesUid = "1.2.3.4";
  header.frameOfReferenceUid = "1.2.3.9";
  header.seriesNumber = 7;
  writeMrSeries(folder / "mr", header, image::Volume<std::int16_t>(test::letterF().grid, 5));
  return scan(folder / "mr").series.at(0);
}

/// Two contours on slice 2 (one inside the other) and one of 2000 points on slice 5.
StructureSet someContours(const image::Grid& grid) {
  const auto circle = [&](double i, double j, double radius, int k, int points) {
    StructureContour c;
    c.points_lps_mm.resize(3, points);
    for (int n = 0; n < points; ++n) {
      const double angle = 2.0 * std::acos(-1.0) * n / points;
      c.points_lps_mm.col(n) =
          grid.indexToLps({i + radius * std::cos(angle), j + radius * std::sin(angle), static_cast<double>(k)});
    }
    return c;
  };
  StructureSet set;
  Structure liver;
  liver.number = 1;
  liver.name = "liver";
  liver.contours = {circle(9.3, 11.1, 6.7, 2, 40), circle(9.3, 11.1, 2.1, 2, 12), circle(8.0, 12.0, 5.0, 5, 2000)};
  Structure other;
  other.number = 4;
  other.name = "vena cava";
  other.contours = {circle(5.0, 5.0, 1.5, 8, 9)};
  set.structures = {liver, other};
  return set;
}

TEST(RtStruct, comesBackAsItWasWritten) {
  const TemporaryFolder folder;
  const Series source = writtenSource(folder);
  const StructureSet set = someContours(source.grid);
  writeRtStruct(folder / "rt.dcm", set, source, 1);
  const StructureSet back = readRtStruct(folder / "rt.dcm");
  EXPECT_EQ(back.frameOfReferenceUid, "1.2.3.9");
  EXPECT_EQ(back.referencedSeriesUid, "1.2.3.4");
  EXPECT_TRUE(back.warnings.empty()) << back.warnings.front();
  ASSERT_EQ(back.structures.size(), 2U);
  for (std::size_t s = 0; s < 2; ++s) {
    EXPECT_EQ(back.structures[s].number, set.structures[s].number);
    EXPECT_EQ(back.structures[s].name, set.structures[s].name);
    const std::vector<StructureContour> expected = withKeyholes(set.structures[s].contours);
    ASSERT_EQ(back.structures[s].contours.size(), expected.size());
    for (std::size_t c = 0; c < expected.size(); ++c) {
      const auto& a = expected[c].points_lps_mm;
      const auto& b = back.structures[s].contours[c].points_lps_mm;
      ASSERT_EQ(a.cols(), b.cols());
      EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-6);
    }
  }
  EXPECT_EQ(back.structures[0].contours[0].referencedSopInstanceUid, source.sopInstanceUids[2]);
  EXPECT_EQ(back.structures[0].contours[1].referencedSopInstanceUid, source.sopInstanceUids[5]);
  EXPECT_EQ(back.structures[1].contours[0].referencedSopInstanceUid, source.sopInstanceUids[8]);
}

TEST(RtStruct, isValidToAnIndependentReaderWithShortDecimalStrings) {
  const TemporaryFolder folder;
  const Series source = writtenSource(folder);
  writeRtStruct(folder / "rt.dcm", someContours(source.grid), source, 1);
  // DCMTK's own RT module checks type, multiplicity and presence of every attribute of the IOD.
  DcmFileFormat file;
  ASSERT_TRUE(file.loadFile((folder / "rt.dcm").c_str()).good());
  DcmDataset& data = *file.getDataset();
  DRTStructureSetIOD rt;
  EXPECT_TRUE(rt.read(data).good());
  EXPECT_EQ(rt.getROIContourSequence().getNumberOfItems(), 2U);
  const auto textOf = [&data](const DcmTagKey& tag) {
    OFString value;
    EXPECT_TRUE(data.tagExists(tag)) << tag.toString();
    data.findAndGetOFStringArray(tag, value);
    return std::string(value.c_str());
  };
  EXPECT_EQ(textOf(DCM_PatientName), "PHI^CANARY");
  EXPECT_EQ(textOf(DCM_StudyInstanceUID), "1.2.3");
  EXPECT_EQ(textOf(DCM_ApprovalStatus), "UNAPPROVED");
  EXPECT_THAT(textOf(DCM_SeriesDescription), testing::StartsWith("RESEARCH"));
  for (const DcmTagKey& type2 :
       {DCM_PatientBirthDate, DCM_PatientSex, DCM_StudyDate, DCM_StudyTime, DCM_AccessionNumber,
        DCM_ReferringPhysicianName, DCM_StudyID, DCM_OperatorsName, DCM_Manufacturer, DCM_SeriesNumber,
        DCM_StructureSetDate, DCM_StructureSetTime, DCM_PatientID})
    textOf(type2);
  EXPECT_FALSE(textOf(DCM_StructureSetLabel).empty());
  DcmStack stack;
  while (data.search(DCM_ContourData, stack, ESM_afterStackTop, OFTrue).good()) {
    OFString all;
    static_cast<DcmElement*>(stack.top())->getOFStringArray(all, OFFalse);
    std::istringstream parts(all.c_str());
    for (std::string one; std::getline(parts, one, '\\');) EXPECT_LE(one.size(), 16U) << one;
  }
}

TEST(RtStruct, sameInputSameBytesAndAnotherSeedAnotherIdentity) {
  const TemporaryFolder folder;
  const Series source = writtenSource(folder);
  const StructureSet set = someContours(source.grid);
  const auto bytes = [&](const char* name, std::uint64_t seed) {
    writeRtStruct(folder / name, set, source, seed);
    std::ifstream in(folder / name, std::ios::binary);
    std::ostringstream all;
    all << in.rdbuf();
    return all.str();
  };
  const std::string a = bytes("a.dcm", 1);
  EXPECT_EQ(a, bytes("b.dcm", 1));
  EXPECT_NE(a, bytes("c.dcm", 2));
}

TEST(RtStruct, refusesWhatIsNone) {
  const TemporaryFolder folder;
  const Series source = writtenSource(folder);
  EXPECT_THROW(readRtStruct(source.files.front()), BadInput);
  EXPECT_THROW(readRtStruct(folder / "absent.dcm"), BadInput);
  EXPECT_THROW(writeRtStruct(folder / "no" / "rt.dcm", someContours(source.grid), source, 1), BadInput);
  StructureSet bad = someContours(source.grid);
  bad.structures[0].contours[0].points_lps_mm(1, 3) = std::nan("");
  EXPECT_THROW(writeRtStruct(folder / "rt.dcm", bad, source, 1), BadArgument);
  // One number of a contour is lost, or turned into something that is no number.
  writeRtStruct(folder / "rt.dcm", someContours(source.grid), source, 1);
  for (const char* data : {"1\\2\\3\\4", "1\\2\\nan\\4\\5\\6\\7\\8\\9", "1\\2\\1,5"}) {
    DcmFileFormat file;
    ASSERT_TRUE(file.loadFile((folder / "rt.dcm").c_str()).good());
    DcmItem* roi = nullptr;
    DcmItem* contour = nullptr;
    ASSERT_TRUE(file.getDataset()->findAndGetSequenceItem(DCM_ROIContourSequence, roi).good());
    ASSERT_TRUE(roi->findAndGetSequenceItem(DCM_ContourSequence, contour).good());
    contour->putAndInsertString(DCM_ContourData, data);
    ASSERT_TRUE(file.saveFile((folder / "changed.dcm").c_str(), EXS_LittleEndianImplicit).good());
    EXPECT_THROW(readRtStruct(folder / "changed.dcm"), BadInput) << data;
  }
}

TEST(RtStruct, saysWhoseItIsAsItsImagesDo) {
  const TemporaryFolder folder;
  const Series source = writtenSource(folder);
  writeRtStruct(folder / "rt.dcm", someContours(source.grid), source, 1);
  const Origin origin = readRtStruct(folder / "rt.dcm").origin;
  EXPECT_EQ(origin.patientKey.size(), 64U);
  EXPECT_EQ(origin.patientKey, source.patientKey);
  EXPECT_EQ(origin.studyUid, source.studyUid);
  // Empty parts at the end of a name make no other patient; another name does; no name at all says nothing.
  const auto keyOf = [&folder](const char* name, const char* id) {
    DcmFileFormat file;
    file.loadFile((folder / "rt.dcm").c_str());
    file.getDataset()->putAndInsertString(DCM_PatientName, name);
    file.getDataset()->putAndInsertString(DCM_PatientID, id);
    file.saveFile((folder / "other.dcm").c_str(), EXS_LittleEndianExplicit);
    return readRtStruct(folder / "other.dcm").origin.patientKey;
  };
  EXPECT_EQ(keyOf("A^B", "1"), keyOf("A^B^^^", "1"));
  EXPECT_NE(keyOf("A^B", "1"), keyOf("A^C", "1"));
  EXPECT_NE(keyOf("A^B", "1"), keyOf("A^B", "2"));
  EXPECT_EQ(keyOf("", ""), "");
}

TEST(RtStruct, whatIsNotPlainIsReadByTheReaderProcess) {
  const TemporaryFolder folder;
  const Series source = writtenSource(folder);
  writeRtStruct(folder / "rt.dcm", someContours(source.grid), source, 1);
  DcmFileFormat file;
  ASSERT_TRUE(file.loadFile((folder / "rt.dcm").c_str()).good());
  ASSERT_TRUE(file.saveFile((folder / "deflated.dcm").c_str(), EXS_DeflatedLittleEndianExplicit).good());
  const StructureSet here = readRtStruct(folder / "rt.dcm"), there = readRtStruct(folder / "deflated.dcm");
  ASSERT_EQ(there.structures.size(), here.structures.size());
  for (std::size_t s = 0; s < here.structures.size(); ++s) {
    EXPECT_EQ(there.structures[s].name, here.structures[s].name);
    ASSERT_EQ(there.structures[s].contours.size(), here.structures[s].contours.size());
    for (std::size_t c = 0; c < here.structures[s].contours.size(); ++c) {
      EXPECT_EQ(there.structures[s].contours[c].points_lps_mm, here.structures[s].contours[c].points_lps_mm);
      EXPECT_EQ(there.structures[s].contours[c].referencedSopInstanceUid,
                here.structures[s].contours[c].referencedSopInstanceUid);
    }
  }
  EXPECT_EQ(there.frameOfReferenceUid, here.frameOfReferenceUid);
  EXPECT_EQ(there.referencedSeriesUid, here.referencedSeriesUid);
  EXPECT_EQ(there.origin.patientKey, here.origin.patientKey);
  EXPECT_EQ(there.origin.studyUid, here.origin.studyUid);
  // A crash, a hang, an answer that makes no sense: a reason. The word makes the file odd: its element is out of order.
  const std::filesystem::path usual = readerProgram();
  const auto saidOf = [&folder](const std::string& word) -> std::string {
    std::filesystem::copy_file(folder / "rt.dcm", folder / "odd.dcm",
                               std::filesystem::copy_options::overwrite_existing);
    std::ofstream(folder / "odd.dcm", std::ios::app | std::ios::binary)
        << test::DicomBytes::tag(0x00081040) + test::DicomBytes::little(word.size(), 4) + word;
    try {
      return std::to_string(readRtStruct(folder / "odd.dcm").structures.size()) + " structures";
    } catch (const BadInput& e) {
      return e.what();
    }
  };
  setReaderProgram(GLISSON_FAULTY_READER);
  EXPECT_EQ(saidOf("fair"), "2 structures");
  EXPECT_THAT(saidOf("FAULT-CRASH "), HasSubstr("crash (signal SIGSEGV)"));
  EXPECT_THAT(saidOf("FAULT-LOOP"), HasSubstr("takes longer to decode than its size allows"));
  EXPECT_THAT(saidOf("FAULT-LIE "), HasSubstr("a message that makes no sense"));
  setReaderProgram("/no/such/glisson-reader");
  EXPECT_THAT(saidOf("fair"), HasSubstr("reader process, which cannot be started"));
  setReaderProgram(usual);
}

TEST(RtStruct, realOnesAreRead) {
  GLISSON_NEEDS_DATA("dicom_seg_rtstruct");
  const StructureSet small = readRtStruct(shared("rt-utils/rt.dcm"));
  ASSERT_EQ(small.structures.size(), 1U);
  EXPECT_EQ(small.structures[0].name, "ROI-1");
  EXPECT_EQ(small.referencedSeriesUid, "2.16.840.1.114362.1.11940992.23790159890.563423471.893.88");
  ASSERT_EQ(small.structures[0].contours.size(), 2U);
  for (const StructureContour& c : small.structures[0].contours) EXPECT_GE(c.points_lps_mm.cols(), 3);
  for (const char* name : {"rt-utils/invalid_reference_rt.dcm", "rt-utils/non_existent_reference_rt.dcm"})
    EXPECT_FALSE(readRtStruct(shared(name)).structures.empty()) << name;
  const StructureSet large = readRtStruct(shared("dicompyler/rtss.dcm"));
  std::size_t contours = 0;
  std::size_t inPlane = 0;
  Eigen::Index points = 0;
  for (const Structure& s : large.structures) {
    contours += s.contours.size();
    for (const StructureContour& c : s.contours) {
      points += c.points_lps_mm.cols();
      const auto z = c.points_lps_mm.row(2);
      if (z.maxCoeff() - z.minCoeff() < 1e-3) ++inPlane;
    }
  }
  // As counted by pydicom.
  EXPECT_EQ(large.structures.size(), 10U);
  EXPECT_EQ(contours, 441U);
  EXPECT_EQ(points, 88158);
  EXPECT_EQ(inPlane, contours);  // drawn on axial CT
}

}  // namespace
}  // namespace glisson::dicom
