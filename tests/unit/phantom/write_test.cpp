// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/error.h"
#include "base/sha256.h"
#include "dicom/rtstruct.h"
#include "dicom/series.h"
#include "dicom/write_mr.h"
#include "shared_patient.h"
#include "support/support.h"

namespace glisson::phantom {
namespace {

namespace fs = std::filesystem;

std::map<std::string, std::string> hashes(const fs::path& folder) {
  std::map<std::string, std::string> all;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) all[fs::relative(entry.path(), folder).string()] = sha256OfFile(entry.path());
  return all;
}

std::string contents(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

class Written : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new test::TemporaryFolder;
    writePhantom(test::sharedPatient(), *folder_ / "patient");
  }
  static void TearDownTestSuite() { delete folder_; }
  static fs::path patient() { return *folder_ / "patient"; }
  static inline test::TemporaryFolder* folder_ = nullptr;
};

TEST_F(Written, SamePatientSameBytes) {
  writePhantom(test::sharedPatient(), *folder_ / "again");
  const auto first = hashes(patient());
  EXPECT_GT(first.size(), 100U);
  EXPECT_EQ(first, hashes(*folder_ / "again"));
}

TEST_F(Written, NoFileTellsWhereOrByWhomItWasMade) {
  char host[256] = {};
  gethostname(host, sizeof host - 1);
  std::vector<std::string> telling{folder_->path().string(), folder_->path().filename().string(),
                                   fs::current_path().string()};
  if (std::string(host).size() > 3) telling.emplace_back(host);
  for (const char* name : {"HOME", "PWD", "LOGNAME"})
    if (const char* value = std::getenv(name); value && std::string(value).size() > 3) telling.emplace_back(value);
  std::size_t files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(patient())) {
    if (!entry.is_regular_file()) continue;
    ++files;
    const std::string text = contents(entry.path());
    for (const std::string& word : telling)
      EXPECT_EQ(text.find(word), std::string::npos) << entry.path().filename() << " holds a name of this machine";
  }
  EXPECT_GT(files, 100U);
}

TEST_F(Written, SceneNamesFilesThatAreThere) {
  const auto scene = nlohmann::json::parse(contents(patient() / "scene.json"));
  EXPECT_EQ(scene["schema"], "glisson/scene/1");
  EXPECT_EQ(scene["geometry"]["kind"], "patient");
  for (const char* key : {"mri", "mre", "roi"})
    EXPECT_TRUE(fs::exists(patient() / scene["geometry"][key].get<std::string>())) << key;
  EXPECT_EQ(scene["supports"].size(), 2U);
  EXPECT_EQ(scene["loads"][0]["force"], "liver-weight");
}

TEST_F(Written, TruthHoldsWhatThePatientHolds) {
  const auto truth = nlohmann::json::parse(contents(patient() / "truth.json"));
  const PhantomTruth& t = test::sharedPatient().truth;
  EXPECT_DOUBLE_EQ(truth["shear_kPa"], t.shear_kPa);
  EXPECT_DOUBLE_EQ(truth["volume_mL"], t.volume_mL);
  ASSERT_EQ(truth["vessels"].size(), t.vessels.size());
  EXPECT_NEAR(truth["vessels"][5]["points_lps_mm"][0][2], t.vessels[5].points_lps_mm[0].z(), 1e-3);
}

TEST_F(Written, ScanFindsEveryRoleAndReadsTheSameVoxels) {
  const PhantomPatient& p = test::sharedPatient();
  const dicom::ScanResult scan = dicom::scan(patient());
  auto same = [&](dicom::SeriesRole role, const Int16Volume& expected) {
    const dicom::Series& series = dicom::findRole(scan, role);
    const image::ScalarVolume read = dicom::readSeries(series);
    EXPECT_TRUE(read.grid.sameGeometry(expected.grid)) << dicom::name(role);
    ASSERT_EQ(read.values.size(), expected.values.size());
    EXPECT_TRUE(std::equal(read.values.begin(), read.values.end(), expected.values.begin(),
                           [](float a, std::int16_t b) { return a == static_cast<float>(b); }))
        << dicom::name(role);
  };
  same(dicom::SeriesRole::Anatomical, p.mri);
  same(dicom::SeriesRole::Magnitude, p.magnitude);
  same(dicom::SeriesRole::Stiffness, p.stiffness_Pa);
  same(dicom::SeriesRole::Confidence, p.confidence);
  EXPECT_EQ(dicom::findRole(scan, dicom::SeriesRole::Stiffness).unit, "Pa");
  EXPECT_TRUE(dicom::findRole(scan, dicom::SeriesRole::ColourCopy).colour);
}

TEST_F(Written, WaveIsOneSeriesOfFourTimeSteps) {
  const PhantomPatient& p = test::sharedPatient();
  const dicom::ScanResult scan = dicom::scan(patient() / "mre" / "wave");
  ASSERT_EQ(scan.series.size(), p.wave.size());
  for (std::size_t t = 0; t < p.wave.size(); ++t) {
    const dicom::Series& s = scan.series[t];
    EXPECT_EQ(s.role, dicom::SeriesRole::Wave);
    EXPECT_EQ(s.temporalIndex, static_cast<int>(t));
    EXPECT_EQ(s.uid.substr(0, s.uid.find('#')), scan.series.front().uid);
    EXPECT_FALSE(s.error) << *s.error;
    const image::ScalarVolume read = dicom::readSeries(s);
    EXPECT_TRUE(read.grid.sameGeometry(p.wave[t].grid));
    EXPECT_TRUE(std::equal(read.values.begin(), read.values.end(), p.wave[t].values.begin(), p.wave[t].values.end(),
                           [](float a, std::int16_t b) { return a == static_cast<float>(b); }))
        << "step " << t;
  }
}

TEST_F(Written, ContoursComeBackOnTheirSlices) {
  const PhantomPatient& p = test::sharedPatient();
  const dicom::StructureSet set = dicom::readRtStruct(patient() / "rtstruct.dcm");
  ASSERT_EQ(set.structures.size(), 1U);
  // A hole is joined to the contour round it (keyhole); every vertex is still there, on a contour of its slice.
  ASSERT_LE(set.structures[0].contours.size(), p.contours.polygons.size());
  for (const auto& read : set.structures[0].contours) EXPECT_FALSE(read.referencedSopInstanceUid.empty());
  for (const roi::Polygon& polygon : p.contours.polygons) {
    double furthest_mm = 0.0;
    for (Eigen::Index v = 0; v < polygon.points_lps_mm.cols(); ++v) {
      double nearest_mm = 1e9;
      for (const auto& read : set.structures[0].contours)
        nearest_mm = std::min(
            nearest_mm, (read.points_lps_mm.colwise() - polygon.points_lps_mm.col(v)).colwise().norm().minCoeff());
      furthest_mm = std::max(furthest_mm, nearest_mm);
    }
    EXPECT_LT(furthest_mm, 1e-3);
  }
}

TEST_F(Written, PublicToolsReadIt) {
  if (!fs::exists("/usr/bin/python3")) GTEST_SKIP() << "there is no /usr/bin/python3";
  const std::string command = "/usr/bin/python3 '" GLISSON_PUBLIC_READERS "' '" + patient().string() + "'";
  const int status = std::system(command.c_str());
  ASSERT_TRUE(WIFEXITED(status));
  if (WEXITSTATUS(status) == 77) GTEST_SKIP() << "pydicom is not installed";
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(WriteMr, UidsAreValidAndFollowTheText) {
  const std::string a = dicom::uidFrom("one");
  EXPECT_EQ(a, dicom::uidFrom("one"));
  EXPECT_NE(a, dicom::uidFrom("two"));
  EXPECT_LE(a.size(), 44U);  // 2^128 has 39 digits
  EXPECT_EQ(a.substr(0, 5), "2.25.");
  EXPECT_EQ(a.find_first_not_of("0123456789."), std::string::npos);
}

TEST(WriteMr, DecimalStringsFitSixteenCharactersAndKeepTheValue) {
  EXPECT_EQ(dicom::decimalString(0.0), "0");
  EXPECT_EQ(dicom::decimalString(1.64), "1.64");
  EXPECT_EQ(dicom::decimalString(-209.1), "-209.1");
  for (const double v : {-123.45678901234567, 1.0 / 3.0, -1.0 / 3.0, 1e-7 / 3.0, -1.23456789e-300, 6.02214076e23}) {
    const std::string text = dicom::decimalString(v);
    EXPECT_LE(text.size(), 16U) << text;
    EXPECT_NEAR(std::stod(text), v, 1e-8 * std::abs(v));
  }
  EXPECT_THROW(dicom::decimalString(std::nan("")), BadArgument);
}

TEST(WriteMr, RefusesASeriesWithoutIdentity) {
  test::TemporaryFolder folder;
  image::Grid g;
  g.size = {2, 2, 1};
  dicom::MrSeriesHeader header;
  EXPECT_THROW(dicom::writeMrSeries(folder / "s", header, Int16Volume(g)), BadArgument);
}

TEST(WriteMr, RefusesTimeStepsThatAreNoneOrDiffer) {
  test::TemporaryFolder folder;
  image::Grid g;
  g.size = {2, 2, 1};
  image::Grid other = g;
  other.origin_lps_mm.x() = 1.0;
  dicom::MrSeriesHeader header;
  header.studyUid = header.seriesUid = header.frameOfReferenceUid = "1.2.3";
  EXPECT_THROW(dicom::writeMrSeries(folder / "s", header, std::vector<Int16Volume>{}), BadArgument);
  EXPECT_THROW(dicom::writeMrSeries(folder / "s", header, {Int16Volume(g), Int16Volume(other)}), BadArgument);
  EXPECT_EQ(dicom::writeMrSeries(folder / "s", header, {Int16Volume(g), Int16Volume(g)}).files.size(), 2U);
}

TEST(WriteMr, SaysWhereAFolderCannotBeMade) {
  test::TemporaryFolder folder;
  std::ofstream(folder / "file") << "x";
  EXPECT_THROW(writePhantom(test::sharedPatient(), folder / "file"), BadInput);
}

}  // namespace
}  // namespace glisson::phantom
