// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/picture_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>

#include "base/error.h"
#include "pipeline/pictures.h"

namespace glisson::pipeline {
namespace {

using Eigen::Vector3d;

class PictureFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              ("picture-file-" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path file() const { return folder_ / pictureFileName; }
  std::string bytes() const {
    std::ifstream in(file(), std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
  }
  void write(const std::string& content) const { std::ofstream(file(), std::ios::binary) << content; }

 private:
  std::filesystem::path folder_;
};

image::Grid gridOf(int nx, int ny, int nz, double spacing) {
  image::Grid grid;
  grid.size = {nx, ny, nz};
  grid.spacing_mm = {spacing, spacing / 3.0, 1.1 * spacing};
  grid.origin_lps_mm = {-0.1, 1.0 / 3.0, 1e-17};
  const double a = 0.3;
  grid.direction << std::cos(a), -std::sin(a), 0, std::sin(a), std::cos(a), 0, 0, 0, 1;
  return grid;
}

/// Four grids of their own, and numbers that no decimal text of few digits holds.
PictureData sample() {
  PictureData data;
  render::RetractionScene& s = data.scene;
  s.mri = image::ScalarVolume(gridOf(3, 4, 2, 1.7));
  for (std::size_t n = 0; n < s.mri.values.size(); ++n) s.mri.values[n] = 1.0F / static_cast<float>(n + 3);
  s.mri.values[0] = -0.0F;
  s.mri.values[1] = std::numeric_limits<float>::quiet_NaN();
  s.mri.values[2] = std::numeric_limits<float>::denorm_min();
  s.liver = image::Mask(gridOf(2, 2, 2, 3.0));
  s.liver.values[3] = 1;
  s.u_mre_mm = image::DisplacementField(gridOf(2, 3, 2, 2.0), Eigen::Vector3f(0.1F, -0.2F, 0.3F));
  s.u_atlas_mm = image::DisplacementField(gridOf(1, 3, 2, 2.5), Eigen::Vector3f(0.7F, 0.0F, -0.3F));
  s.vesselSurface.vertices_lps_mm = Eigen::Matrix3Xd::Constant(3, 3, 1.0 / 7.0);
  s.vesselSurface.triangles.resize(3, 1);
  s.vesselSurface.triangles << 0, 2, 1;
  s.retractorPoint_lps_mm = Vector3d(0.1, 0.2, 1.0 / 3.0);
  s.retractorAxis = Vector3d(0.6, 0.8, 0.0);
  s.retractorDiameter_mm = 10.1;
  render::RigidBar& bar = s.bar.emplace();
  bar.centreline_lps_mm = {Vector3d(0.1, 0.2, 0.3), Vector3d(1.0 / 3.0, 0.2, 80.0)};
  bar.asked_N = 14.7;
  bar.surface = s.vesselSurface;
  bar.mre.travel_mm = 1.0 / 7.0;
  bar.mre.resultant_N = 14.5;
  bar.mre.path = {{0.0, 0.0}, {1.0 / 7.0, 14.5}};
  bar.mre.u_mm = Eigen::Matrix3Xf::Constant(3, 3, 1.0F / 3.0F);
  bar.mre.pressure_kPa = Eigen::VectorXf::LinSpaced(3, 0.0F, 7.7F);
  bar.atlas = bar.mre;
  bar.atlas->slipped = bar.atlas->capacityExceeded = true;
  bar.atlas->pressure_kPa[1] = 0.1F;
  render::HowSure& sure = s.sure.emplace();
  sure.beyond = image::ScalarVolume(gridOf(2, 2, 1, 4.0), 1.0F / 3.0F);
  sure.beyond.values[1] = std::numeric_limits<float>::quiet_NaN();
  sure.tube = s.vesselSurface;
  sure.vessel95_mm = Eigen::VectorXf::LinSpaced(3, 0.1F, 0.7F);
  SureNumbers& numbers = data.sure.emplace();
  numbers.at_retractor_mm = 1.0 / 3.0;
  numbers.vessels = true;
  numbers.sources = {{uncertainty::SourceKind::Outline, 0.1, 0.2, 0.3, 0.4, 1.0 / 7.0},
                     {uncertainty::SourceKind::Solver, 1e-9, 0.0, 0.0, 0.0, 0.0}};
  numbers.headline.emplace();
  numbers.headline->at_retractor_mm = {0.1, 1.0 / 3.0};
  numbers.headline->withinVoxel = 0.7;
  numbers.headline->vessels = {{0.1, 0.2}, {0.3, 0.4}, {0.0, 1.0 / 3.0}, 17, 5.5, {5.1, 6.1}, 0.875};
  s.caption = "mean 0.7 mm, ν = 0.45";
  s.mark = "outside \"linear\" theory";
  s.compared = false;
  s.stiffness = "uniform";
  data.vessel_lps_mm = Vector3d(1e-30, -2.0 / 3.0, 5.0);
  return data;
}

template <typename T>
void expectSameBits(const image::Volume<T>& a, const image::Volume<T>& b) {
  EXPECT_EQ(a.grid.size, b.grid.size);
  EXPECT_EQ(a.grid.spacing_mm, b.grid.spacing_mm);
  EXPECT_EQ(a.grid.origin_lps_mm, b.grid.origin_lps_mm);
  EXPECT_EQ(a.grid.direction, b.grid.direction);
  ASSERT_EQ(a.values.size(), b.values.size());
  EXPECT_EQ(std::memcmp(static_cast<const void*>(a.values.data()), static_cast<const void*>(b.values.data()),
                        a.values.size() * sizeof(T)),
            0);
}

TEST_F(PictureFile, givesBackEveryBit) {
  const PictureData was = sample();
  writePictureFile(file(), was);
  const PictureData is = readPictureFile(file());
  const render::RetractionScene &a = was.scene, &b = is.scene;
  expectSameBits(a.mri, b.mri);
  expectSameBits(a.liver, b.liver);
  expectSameBits(a.u_mre_mm, b.u_mre_mm);
  expectSameBits(a.u_atlas_mm, b.u_atlas_mm);
  EXPECT_EQ(b.liverSurface.triangles.cols(), 0);
  EXPECT_EQ(a.vesselSurface.vertices_lps_mm, b.vesselSurface.vertices_lps_mm);
  EXPECT_EQ(a.vesselSurface.triangles, b.vesselSurface.triangles);
  EXPECT_EQ(a.retractorPoint_lps_mm, b.retractorPoint_lps_mm);
  EXPECT_EQ(a.retractorAxis, b.retractorAxis);
  EXPECT_EQ(a.retractorDirection, b.retractorDirection);
  EXPECT_EQ(a.retractorDiameter_mm, b.retractorDiameter_mm);
  EXPECT_EQ(a.retractorLength_mm, b.retractorLength_mm);
  ASSERT_TRUE(b.bar && b.bar->atlas);
  EXPECT_EQ(a.bar->centreline_lps_mm, b.bar->centreline_lps_mm);
  EXPECT_EQ(a.bar->surface.triangles, b.bar->surface.triangles);
  EXPECT_EQ(a.bar->mre.path, b.bar->mre.path);
  EXPECT_EQ(a.bar->mre.u_mm, b.bar->mre.u_mm);
  EXPECT_EQ(a.bar->mre.pressure_kPa, b.bar->mre.pressure_kPa);
  EXPECT_EQ(a.bar->atlas->pressure_kPa, b.bar->atlas->pressure_kPa);
  EXPECT_EQ(a.bar->atlas->travel_mm, b.bar->atlas->travel_mm);
  EXPECT_TRUE(b.bar->atlas->slipped && !b.bar->mre.slipped);
  ASSERT_TRUE(b.sure);
  expectSameBits(a.sure->beyond, b.sure->beyond);
  EXPECT_EQ(a.sure->tube.triangles, b.sure->tube.triangles);
  EXPECT_EQ(a.sure->vessel95_mm, b.sure->vessel95_mm);
  ASSERT_TRUE(is.sure && is.sure->headline && is.sure->headline->vessels);
  EXPECT_EQ(is.sure->sources.at(0).furthest_sd_mm, 1.0 / 7.0);
  EXPECT_EQ(is.sure->sources.at(1).kind, uncertainty::SourceKind::Solver);
  EXPECT_EQ(is.sure->headline->at_retractor_mm.high, 1.0 / 3.0);
  EXPECT_EQ(is.sure->headline->vessels->furthest, 17U);
  EXPECT_EQ(is.sure->headline->vessels->furthestBeyond, 0.875);
  EXPECT_EQ(a.caption, b.caption);
  EXPECT_EQ(a.mark, b.mark);
  EXPECT_EQ(a.compared, b.compared);
  EXPECT_EQ(a.stiffness, b.stiffness);
  EXPECT_EQ(a.valid, b.valid);
  EXPECT_EQ(was.vessel_lps_mm, is.vessel_lps_mm);
  // What is written again is the same file.
  const std::string first = bytes();
  writePictureFile(file(), is);
  EXPECT_EQ(bytes(), first);
}

TEST_F(PictureFile, whatIsNotThereStaysAway) {
  PictureData data = sample();
  data.vessel_lps_mm.reset();
  data.scene.retractorPoint_lps_mm.reset();
  data.scene.bar.reset();
  data.scene.sure.reset();
  data.sure.reset();
  data.scene.valid = false;
  writePictureFile(file(), data);
  const PictureData is = readPictureFile(file());
  EXPECT_FALSE(is.vessel_lps_mm);
  EXPECT_FALSE(is.sure || is.scene.sure);
  EXPECT_FALSE(is.scene.retractorPoint_lps_mm);
  EXPECT_FALSE(is.scene.bar);
  EXPECT_FALSE(is.scene.valid);
}

TEST_F(PictureFile, everyTruncationAndEveryFlippedByteOfTheArraysIsRefused) {
  writePictureFile(file(), sample());
  const std::string whole = bytes();
  for (std::size_t length = 0; length < whole.size(); ++length) {
    write(whole.substr(0, length));
    EXPECT_THROW(readPictureFile(file()), BadInput) << "cut after " << length;
  }
  std::uint64_t header = 0;
  std::memcpy(&header, whole.data() + 8, sizeof header);
  for (std::size_t n = 16 + header; n < whole.size(); ++n) {
    std::string hurt = whole;
    hurt[n] = static_cast<char>(hurt[n] ^ 0x10);
    write(hurt);
    EXPECT_THROW(readPictureFile(file()), BadInput) << "byte " << n;
  }
  write(whole + "x");
  EXPECT_THROW(readPictureFile(file()), BadInput);
  std::filesystem::remove(file());
  EXPECT_THROW(readPictureFile(file()), BadInput);
}

TEST_F(PictureFile, aHeaderThatPromisesTooMuchIsRefusedBeforeAnythingIsAllocated) {
  writePictureFile(file(), sample());
  std::string hurt = bytes();
  // The first size in the header is that of the MRI: 3 x 4 x 2; the same length of text, far more voxels.
  const auto at = hurt.find("3,4,2");
  ASSERT_NE(at, std::string::npos);
  hurt.replace(at, 5, "9,9,9");
  write(hurt);
  EXPECT_THROW(readPictureFile(file()), BadInput);
}

TEST(Camera, isANameOrTwoAngles) {
  for (const char* name : {"anterior", "posterior", "left", "right", "superior", "inferior", "oblique"}) {
    EXPECT_EQ(cameraFromText(name).name, name);
    EXPECT_FALSE(cameraFromText(name).camera);
  }
  const NamedCamera c = cameraFromText("-40,35.5");
  ASSERT_TRUE(c.camera);
  EXPECT_EQ(c.camera->azimuth_deg, -40.0);
  EXPECT_EQ(c.camera->elevation_deg, 35.5);
  EXPECT_EQ(c.name, "az-40-el36");
  for (const char* wrong : {"", "sideways", "10", "10,", ",10", "10,91", "400,0", "nan,0", "0,inf", "1,2,3", "1, 2"})
    EXPECT_THROW(cameraFromText(wrong), BadInput) << wrong;
}

}  // namespace
}  // namespace glisson::pipeline
