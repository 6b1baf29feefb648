// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/io.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <numeric>
#include <sstream>

#include "base/error.h"
#include "support/support.h"

namespace glisson::image {
namespace {

using test::letterF;
using test::TemporaryFolder;

std::string bytesOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream all;
  all << in.rdbuf();
  return all.str();
}

void writeBytes(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

/// A letter F whose voxels also carry their own index, so that no permutation of voxels goes unseen.
ScalarVolume numberedF() {
  const Mask f = letterF();
  ScalarVolume volume(f.grid);
  for (std::size_t n = 0; n < f.values.size(); ++n)
    volume.values[n] = static_cast<float>(n) * 0.5F + (f.values[n] != 0 ? 10000.0F : -3.25F);
  return volume;
}

double volume_mL(const Mask& mask) {
  const auto count = std::accumulate(mask.values.begin(), mask.values.end(), std::size_t{0});
  return static_cast<double>(count) * mask.grid.voxelVolume_mm3() / 1000.0;
}

class EachFormat : public testing::TestWithParam<const char*> {};

TEST_P(EachFormat, keepsVoxelsAndPlaceOfTheLetterF) {
  const TemporaryFolder folder;
  const auto file = folder / (std::string("f") + GetParam());
  for (const bool flipped : {false, true}) {
    ScalarVolume f = numberedF();
    if (flipped) f.grid.direction.col(2) *= -1.0;  // a left-handed grid must stay left-handed
    writeVolume(file, f);
    const ScalarVolume back = readVolume(file);
    EXPECT_EQ(back.values, f.values);
    EXPECT_TRUE(back.grid.sameGeometry(f.grid, 1e-3));
    EXPECT_NEAR(back.grid.direction.determinant(), flipped ? -1.0 : 1.0, 1e-5);
  }
  // Nothing is left beside the file.
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST_P(EachFormat, keepsMasksAndLabels) {
  const TemporaryFolder folder;
  const auto file = folder / (std::string("labels") + GetParam());
  const Mask f = letterF();
  writeVolume(file, f);
  EXPECT_EQ(readMask(file).values, f.values);
  LabelMap labels(f.grid);
  for (std::size_t n = 0; n < f.values.size(); ++n) labels.values[n] = f.values[n] != 0 ? 70001 : -4;
  writeVolume(file, labels);
  EXPECT_EQ(readLabelMap(file).values, labels.values);
  EXPECT_EQ(readMask(file, 70001).values, f.values);
  EXPECT_THROW(readMask(file, 5), BadInput);
}

TEST_P(EachFormat, refusesTruncatedFiles) {
  const TemporaryFolder folder;
  const auto file = folder / (std::string("f") + GetParam());
  writeVolume(file, numberedF());
  const std::string whole = bytesOf(file);
  for (const std::size_t keep :
       {std::size_t{0}, std::size_t{1}, std::size_t{100}, whole.size() / 2, whole.size() - 64}) {
    writeBytes(file, whole.substr(0, keep));
    EXPECT_THROW(readVolume(file), BadInput) << keep << " of " << whole.size() << " bytes";
  }
}

TEST_P(EachFormat, refusesTextRenamed) {
  const TemporaryFolder folder;
  const auto file = folder / (std::string("notes") + GetParam());
  std::string text;
  for (int line = 0; line < 100; ++line) text += "these are notes, not an image\n";
  writeBytes(file, text);
  EXPECT_THROW(readVolume(file), BadInput);
}

TEST_P(EachFormat, leavesTheOldFileWhereTheFolderIsMissing) {
  const TemporaryFolder folder;
  EXPECT_THROW(writeVolume(folder / "no" / "such" / (std::string("f") + GetParam()), letterF()), BadInput);
}

INSTANTIATE_TEST_SUITE_P(Volumes, EachFormat, testing::Values(".nii", ".nii.gz", ".nrrd", ".mha"));

TEST(ReadVolume, refusesShearedSform) {
  const TemporaryFolder folder;
  const auto file = folder / "f.nii";
  writeVolume(file, numberedF());
  std::string bytes = bytesOf(file);
  float xOfJ = 0.0F;
  std::memcpy(&xOfJ, bytes.data() + 284, 4);  // sform row x, column j
  xOfJ += 0.2F;
  std::memcpy(bytes.data() + 284, &xOfJ, 4);
  writeBytes(file, bytes);
  try {
    readVolume(file);
    FAIL() << "a sheared sform was taken";
  } catch (const BadInput& e) {
    EXPECT_NE(std::string(e.what()).find("sheared"), std::string::npos) << e.what();
  }
}

TEST(ReadVolume, refusesAHeaderThatPromisesMoreThanTheFileHolds) {
  const TemporaryFolder folder;
  const auto file = folder / "f.nii";
  writeVolume(file, letterF());
  std::string bytes = bytesOf(file);
  const std::int16_t large = 20000;
  for (const std::size_t at : {42U, 44U}) std::memcpy(bytes.data() + at, &large, 2);  // dim[1], dim[2]
  writeBytes(file, bytes);
  EXPECT_THROW(readVolume(file), BadInput);
}

TEST(ReadVolume, damagedHeadersGiveOneReasonAndNothingElseIsWritten) {
  const TemporaryFolder folder;
  const auto file = folder / "f.nii";
  writeVolume(file, numberedF());
  const std::string whole = bytesOf(file);
  const auto with = [&whole](std::size_t at, auto value) {
    std::string changed = whole;
    std::memcpy(changed.data() + at, &value, sizeof(value));
    return changed;
  };
  const auto not_a_number = std::numeric_limits<float>::quiet_NaN();
  std::string qform = with(254, std::int16_t{0});  // no sform, a qform that is not finite
  qform[252] = 1;
  std::memcpy(qform.data() + 256, &not_a_number, sizeof(float));
  int n = 0;
  testing::internal::CaptureStderr();
  for (const std::string& bytes : {with(42, std::int16_t{0}), with(42, std::int16_t{-5}), with(70, std::int16_t{0}),
                                   with(70, std::int16_t{999}), with(108, 0.0F), with(108, 100.0F), with(108, -352.0F),
                                   with(108, 352.5F), with(108, not_a_number), with(344, 'x'), with(345, 'i'), qform}) {
    writeBytes(file, bytes);
    EXPECT_THROW(readVolume(file), BadInput) << "header " << n;
    ++n;
  }
  writeBytes(folder / "f.mha",
             "ObjectType = Image\nNDims = 9\nDimSize = 4 4 4\nElementSpacing = x y z\nElementType = MET_FLOAT\n"
             "ElementDataFile = LOCAL\n" +
                 std::string(256, '\0'));
  EXPECT_THROW(readVolume(folder / "f.mha"), BadInput);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(ReadVolume, niftiKeepsPlacesFarFromTheIsocentreAndValuesThatAreNoNumbers) {
  const TemporaryFolder folder;
  const auto file = folder / "f.nii.gz";
  ScalarVolume f = numberedF();
  f.values[5] = std::numeric_limits<float>::quiet_NaN();
  for (int n = 0; n < 200; ++n) {
    f.grid.origin_lps_mm = Eigen::Vector3d(std::sin(n), std::cos(2 * n), std::sin(3 * n)) * 10.0 * n;
    f.grid.direction = Eigen::AngleAxisd(0.1 * n, Eigen::Vector3d(1, n % 5, 2).normalized()).toRotationMatrix();
    writeVolume(file, f);
    const ScalarVolume back = readVolume(file);
    ASSERT_TRUE(back.grid.sameGeometry(f.grid, 2e-3)) << n;
    ASSERT_TRUE(std::isnan(back.values[5]));
    ASSERT_EQ(back.values[6], f.values[6]);
  }
}

TEST(ReadVolume, niftiTakesTheSformThenTheQformAndRescalesWhatIsStored) {
  const TemporaryFolder folder;
  const auto file = folder / "f.nii";
  const ScalarVolume f = numberedF();
  writeVolume(file, f);
  std::string bytes = bytesOf(file);
  const auto put = [&bytes](std::size_t at, auto value) { std::memcpy(bytes.data() + at, &value, sizeof(value)); };
  const auto read = [&] {
    writeBytes(file, bytes);
    return readVolume(file);
  };
  put(80, 7.0F);  // pixdim says something else than the sform
  EXPECT_TRUE(read().grid.sameGeometry(f.grid, 1e-3));
  put(112, 0.5F);
  put(116, -3.0F);
  EXPECT_FLOAT_EQ(read().values[9], 0.5F * f.values[9] - 3.0F);
  bytes = (writeVolume(file, f), bytesOf(file));
  put(254, std::int16_t{0});  // the qform alone
  put(252, std::int16_t{1});
  EXPECT_TRUE(read().grid.sameGeometry(f.grid, 1e-3));
}

TEST(ReadVolume, nrrdHeadersNameOneRegularFileForTheirVoxels) {
  const TemporaryFolder folder;
  const auto header = [&folder](const std::string& data) {
    writeBytes(folder / "f.nhdr",
               "NRRD0004\ntype: uchar\ndimension: 3\nspace: left-posterior-superior\nsizes: 2 2 2\n"
               "space directions: (1,0,0) (0,1,0) (0,0,1)\nencoding: raw\ndata file: " +
                   data + "\n");
    return folder / "f.nhdr";
  };
  EXPECT_THROW(readVolume(header("/dev/zero")), BadInput);
  EXPECT_THROW(readVolume(header("absent.raw")), BadInput);
  writeBytes(folder / "f.raw", "12345678");
  EXPECT_EQ(readVolume(header("f.raw")).values.at(3), 52.0F);
}

TEST(ReadVolume, refusesSeveralTimePointsAndTakesOne) {
  const TemporaryFolder folder;
  const auto file = folder / "f.nii";
  const ScalarVolume f = numberedF();
  writeVolume(file, f);
  const std::string bytes = bytesOf(file);
  const auto withTimePoints = [&](std::int16_t count, bool doubled) {
    std::string changed = bytes;
    const std::int16_t four = 4;
    std::memcpy(changed.data() + 40, &four, 2);
    std::memcpy(changed.data() + 48, &count, 2);
    if (doubled) changed += bytes.substr(352);
    writeBytes(file, changed);
  };
  withTimePoints(1, false);
  EXPECT_EQ(readVolume(file).values, f.values);
  withTimePoints(2, true);
  EXPECT_THROW(readVolume(file), BadInput);
}

TEST(ReadVolume, refusesOtherExtensionsAndVectors) {
  const TemporaryFolder folder;
  writeBytes(folder / "scan.dcm", "x");
  EXPECT_THROW(readVolume(folder / "scan.dcm"), BadInput);
  EXPECT_THROW(readVolume(folder / "absent.nrrd"), BadInput);
  DisplacementField u(letterF().grid, Eigen::Vector3f(1.0F, 2.0F, 3.0F));
  writeVolume(folder / "u.nrrd", u);
  EXPECT_THROW(readVolume(folder / "u.nrrd"), BadInput);
  EXPECT_THROW(writeVolume(folder / "u.nii.gz", u), BadInput);
  EXPECT_TRUE(isVolumeFile("a/b/Liver.SEG.NRRD"));
  EXPECT_FALSE(isVolumeFile(".nii"));
}

TEST(ReadLabelMap, refusesValuesThatAreNoLabels) {
  const TemporaryFolder folder;
  ScalarVolume v(letterF().grid, 1.5F);
  writeVolume(folder / "v.nrrd", v);
  EXPECT_THROW(readLabelMap(folder / "v.nrrd"), BadInput);
}

TEST(RealData, liverVolumesAreTheKnownOnes) {
  GLISSON_NEEDS_DATA("liver_mr_ct_volumes");
  const auto folder = test::sharedData() / "liver_mr_ct_volumes";
  const Mask mr = readMask(folder / "example_seg_mr.nii.gz", 5);
  EXPECT_EQ(std::accumulate(mr.values.begin(), mr.values.end(), 0), 18480);
  EXPECT_NEAR(volume_mL(mr), 498.96, 1e-3);
  const Mask ct = readMask(folder / "example_seg_fast_force_split.nii.gz", 5);
  EXPECT_EQ(std::accumulate(ct.values.begin(), ct.values.end(), 0), 41692);
  EXPECT_NEAR(volume_mL(ct), 1125.684, 1e-3);
}

}  // namespace
}  // namespace glisson::image
