// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "base/error.h"
#include "base/random.h"
#include "dicom/deidentify.h"
#include "dicom/detail/keyhole.h"
#include "dicom/pmap.h"
#include "dicom/seg.h"
#include "dicom/write_mr.h"
#include "elastography/roi_from_structures.h"
#include "image/io.h"
#include "roi/polygon.h"
#include "support/support.h"

namespace glisson::dicom {
namespace {

using test::TemporaryFolder;
using testing::HasSubstr;

std::filesystem::path shared(const std::string& name) {
  return test::sharedData() / "dicom_seg_rtstruct" / name;
}

Series writtenSource(const TemporaryFolder& folder, const image::Grid& grid) {
  MrSeriesHeader header;
  header.studyUid = "1.2.3";
  header.seriesUid = "1.2.3.4";
  header.frameOfReferenceUid = "1.2.3.9";
  header.seriesNumber = 7;
  writeMrSeries(folder / "mr", header, image::Volume<std::int16_t>(grid, 5));
  return scan(folder / "mr").series.at(0);
}

/// The letter F with a hole through its stem, an island inside the hole, an empty slice in between, and noise.
image::Mask holedF(std::uint64_t seed) {
  image::Mask mask = test::letterF();
  Random random(seed);
  const Eigen::Vector3i n = mask.grid.size;
  for (int k = 1; k < 8; ++k) {
    for (int j = 12; j < 21; ++j)
      for (int i = 3; i < 13; ++i) mask.at(i, j, k) = 1;
    for (int j = 13; j < 20; ++j)
      for (int i = 4; i < 12; ++i) mask.at(i, j, k) = 0;
    mask.at(7, 16, k) = mask.at(8, 16, k) = mask.at(7, 15, k) = 1;
  }
  for (int j = 0; j < n.y(); ++j)
    for (int i = 0; i < n.x(); ++i) mask.at(i, j, 4) = 0;
  for (int j = 0; j < n.y(); ++j)
    for (int i = 0; i < n.x(); ++i)
      if (random.uniform() < 0.3) mask.at(i, j, 6) ^= 1;  // pixels that touch at corners, at the border too
  return mask;
}

/// Voxels of b that lie on the lattice of a, counted where they differ; b may be smaller.
std::size_t differences(const image::Mask& a, const image::Mask& b) {
  std::size_t different = 0;
  image::Mask seen(a.grid);
  for (int k = 0; k < b.grid.size.z(); ++k)
    for (int j = 0; j < b.grid.size.y(); ++j)
      for (int i = 0; i < b.grid.size.x(); ++i) {
        const Eigen::Vector3d index = a.grid.lpsToIndex(b.grid.indexToLps(Eigen::Vector3d(i, j, k)));
        const Eigen::Vector3i at = index.array().round().cast<int>();
        if ((index - at.cast<double>()).norm() > 0.02) return a.values.size();  // not on its lattice
        if (!a.grid.contains(at)) {
          different += b.at(i, j, k);
          continue;
        }
        seen.at(at) = 1;
        different += a.at(at) != b.at(i, j, k) ? 1 : 0;
      }
  for (std::size_t n = 0; n < a.values.size(); ++n) different += seen.values[n] == 0 && a.values[n] != 0 ? 1 : 0;
  return different;
}

TEST(Segmentation, comesBackVoxelForVoxelOnAnObliqueGrid) {
  const TemporaryFolder folder;
  const image::Mask mask = holedF(3);
  const Series source = writtenSource(folder, mask.grid);
  image::Mask other(mask.grid);
  for (std::size_t n = 0; n < other.values.size(); n += 7) other.values[n] = 1;  // overlaps the first
  const WrittenSegmentation written =
      writeSegmentation(folder / "seg.dcm", {{1, "liver", {}, mask}, {2, "other", {}, other}}, source, 1);
  const SegmentationSet back = readSegmentation(folder / "seg.dcm");
  ASSERT_EQ(back.segments.size(), 2U);
  EXPECT_EQ(differences(mask, back.segments[0].mask), 0U);
  EXPECT_EQ(differences(other, back.segments[1].mask), 0U);
  EXPECT_EQ(back.segments[0].propertyCode, "SCT:10200004");
  EXPECT_EQ(back.frameOfReferenceUid, "1.2.3.9");
  EXPECT_EQ(back.referencedSeriesUid, "1.2.3.4");
  EXPECT_EQ(back.referencedSopInstanceUids.size(), 9U);
  EXPECT_EQ(written.frameOfSlice[0][4], 0);  // the empty slice has no frame
  EXPECT_TRUE(isSegmentation(folder / "seg.dcm"));
  EXPECT_FALSE(isSegmentation(source.files.front()));
}

TEST(Segmentation, refusesWhatIsEmptyOrElsewhere) {
  const TemporaryFolder folder;
  image::Mask mask = test::letterF();
  const Series source = writtenSource(folder, mask.grid);
  EXPECT_THROW(writeSegmentation(folder / "s.dcm", {{1, "x", {}, image::Mask(mask.grid)}}, source, 1), BadInput);
  mask.grid.origin_lps_mm.x() += 1.0;
  EXPECT_THROW(writeSegmentation(folder / "s.dcm", {{1, "x", {}, mask}}, source, 1), BadArgument);
}

TEST(Segmentation, ofOthersEqualsTheirOwnMask) {
  GLISSON_NEEDS_DATA("dicom_seg_rtstruct");
  const image::Mask nrrd = image::readMask(shared("dcmqi/liver_seg.nrrd"));
  for (const char* name :
       {"dcmqi/liver.dcm", "pydicom_data/liver.dcm", "pydicom_data/liver_rle.dcm", "pydicom_data/liver_deflate.dcm"}) {
    const SegmentationSet set = readSegmentation(shared(name));
    ASSERT_EQ(set.segments.size(), 1U) << name;
    EXPECT_EQ(differences(nrrd, set.segments[0].mask), 0U) << name;
    EXPECT_EQ(set.segments[0].label, "Liver");
  }
}

TEST(Segmentation, whatIsNotPlainIsReadByTheReaderProcessOrNotAtAll) {
  GLISSON_NEEDS_DATA("dicom_seg_rtstruct");
  const std::filesystem::path usual = readerProgram();
  setReaderProgram("/no/such/glisson-reader");
  EXPECT_TRUE(isSegmentation(shared("pydicom_data/liver.dcm")));
  EXPECT_EQ(readSegmentation(shared("pydicom_data/liver.dcm")).segments.size(), 1U);
  for (const char* name : {"pydicom_data/liver_rle.dcm", "pydicom_data/liver_deflate.dcm"}) {
    try {
      readSegmentation(shared(name));
      ADD_FAILURE() << name << " was parsed here";
    } catch (const BadInput& e) {
      EXPECT_THAT(e.what(), testing::HasSubstr("reader process, which cannot be started"));
    }
  }
  setReaderProgram(usual);
}

TEST(Segmentation, framesThatAreNoWholeBytesAreReadFromRunLengths) {
  GLISSON_NEEDS_DATA("dicom_seg_rtstruct");
  // The same liver, cropped from 512 to 510 pixels by whoever made the file.
  const SegmentationSet odd = readSegmentation(shared("pydicom_data/liver_nonbyte_aligned_rle.dcm"));
  const SegmentationSet full = readSegmentation(shared("pydicom_data/liver.dcm"));
  ASSERT_EQ(odd.segments[0].mask.grid.size.x(), 510);
  const auto inside = [](const image::Mask& m) { return std::count(m.values.begin(), m.values.end(), 1); };
  EXPECT_EQ(inside(odd.segments[0].mask), inside(full.segments[0].mask));
}

TEST(Segmentation, segmentsMayOverlap) {
  GLISSON_NEEDS_DATA("dicom_seg_rtstruct");
  const SegmentationSet set = readSegmentation(shared("dcmqi/partial_overlaps.dcm"));
  ASSERT_EQ(set.segments.size(), 5U);
  EXPECT_EQ(set.segments[2].label, "PURPLE");
  std::size_t overlapping = 0, all = 0;
  for (std::size_t n = 0; n < set.segments[0].mask.values.size(); ++n) {
    int many = 0;
    for (const Segment& s : set.segments) many += s.mask.values[n];
    overlapping += many > 1 ? 1 : 0;
    all += many > 0 ? 1 : 0;
  }
  EXPECT_GT(overlapping, 0U);
  const image::Mask united = maskOf(set, 0);
  EXPECT_EQ(static_cast<std::size_t>(std::count(united.values.begin(), united.values.end(), 1)), all);
  try {
    maskOf(set, 9);
    FAIL();
  } catch (const BadInput& e) {
    EXPECT_THAT(e.what(), HasSubstr("3 'PURPLE'"));
  }
}

TEST(Segmentation, anUnsupportedCodecIsNamed) {
  GLISSON_NEEDS_DATA("dicom_seg_rtstruct");
  try {
    readSegmentation(shared("pydicom_data/liver_j2k.dcm"));
    FAIL();
  } catch (const BadInput& e) {
    EXPECT_THAT(e.what(), HasSubstr("JPEG 2000"));
  }
}

TEST(Keyhole, masksWithHolesSurviveTheStructureSet) {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const TemporaryFolder folder;
    const image::Mask mask = holedF(seed);
    const Series source = writtenSource(folder, mask.grid);
    const roi::ContourStack outlines = roi::contoursOf(mask);
    StructureSet set;
    set.structures = {elastography::toStructure(outlines, 1)};
    set.structures[0].name = "liver";
    const auto joined = withKeyholes(set.structures[0].contours);
    EXPECT_LT(joined.size(), set.structures[0].contours.size());
    writeRtStruct(folder / "rt.dcm", set, source, 1);
    const roi::ContourStack back = elastography::roiFromStructures(readRtStruct(folder / "rt.dcm"));
    EXPECT_EQ(roi::rasterise(back, mask.grid).values, mask.values);
    EXPECT_EQ(roi::rasterise(roi::contoursOf(mask), mask.grid).values, mask.values);
  }
}

TEST(ParametricMap, comesBackToTheSameBits) {
  const TemporaryFolder folder;
  const image::Grid grid = test::letterF().grid;
  const Series source = writtenSource(folder, grid);
  image::ScalarVolume map(grid);
  Random random(5);
  for (float& v : map.values) v = static_cast<float>(random.uniform(0.0, 12.0));
  writeParametricMap(folder / "pm.dcm", map, StiffnessQuantity::Shear, source, 1);
  const ScanResult found = scan(folder / "pm.dcm");
  ASSERT_EQ(found.series.size(), 1U);
  const image::ScalarVolume back = readSeries(found.series[0]);
  EXPECT_TRUE(back.grid.sameGeometry(grid, 1e-4));
  EXPECT_EQ(back.values, map.values);
  map.values[3] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(writeParametricMap(folder / "pm2.dcm", map, StiffnessQuantity::Shear, source, 1), BadInput);
}

TEST(ProjectKey, digestIsTheStandardsHmac) {
  // RFC 4231, test case 2 has a short key; case with 32 bytes: key 0x0b × 20 is padded with zeros, as HMAC pads it.
  const ProjectKey key{"0b0b0b0b0b0b0b0b0b0b0b0b0b0b0b0b0b0b0b0b000000000000000000000000"};
  EXPECT_EQ(keyedDigest(key, "Hi There"), "b0344c61d8db38535ca8afceaf0bf12b881dc200c9833da726e9376c2e32cff7");
}

}  // namespace
}  // namespace glisson::dicom
