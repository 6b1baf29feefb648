// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/volume_files.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "image/io.h"
#include "session/kept_results.h"
#include "session/offered_regions.h"
#include "session/series_groups.h"
#include "support/support.h"

namespace glisson::session {
namespace {

using dicom::SeriesRole;

/// Values that no mask has, on the grid of the letter F.
image::ScalarVolume grey() {
  image::ScalarVolume volume(test::letterF().grid);
  for (std::size_t n = 0; n < volume.values.size(); ++n) volume.values[n] = 0.5F + static_cast<float>(n % 97);
  return volume;
}

image::LabelMap labels(int count) {
  const image::Mask f = test::letterF();
  image::LabelMap map(f.grid);
  for (std::size_t n = 0; n < map.values.size(); ++n) map.values[n] = f.values[n] ? 1 + static_cast<int>(n) % count : 0;
  return map;
}

const dicom::Series& named(const dicom::ScanResult& scan, const std::string& name) {
  for (const dicom::Series& s : scan.series)
    if (s.description == name) return s;
  throw BadArgument("no series " + name);
}

TEST(VolumeFiles, AreToldApartByNameAndValues) {
  EXPECT_EQ(lookOf("liver.nii.gz", grey()), VolumeLook::Image);
  EXPECT_EQ(lookOf("case3_stiffness.nrrd", grey()), VolumeLook::Stiffness);
  image::ScalarVolume mask = grey();
  for (float& v : mask.values) v = v > 50.0F ? 1.0F : 0.0F;
  EXPECT_EQ(lookOf("stiffness_mask.nii", mask), VolumeLook::Mask) << "values outweigh words";
  for (float& v : mask.values) v *= 0.5F;
  EXPECT_EQ(lookOf("probability.nii", mask), VolumeLook::Image) << "half is no label";
}

TEST(VolumeFiles, AloneAreImageMapAndOfferedMask) {
  const test::TemporaryFolder folder;
  image::writeVolume(folder / "t1.nii.gz", grey());
  image::writeVolume(folder / "stiffness.mha", grey());
  image::writeVolume(folder / "liver.nrrd", test::letterF());
  std::ofstream(folder / "broken.nii.gz") << "no volume";
  const dicom::ScanResult scan = scanAll(folder.path(), {});
  ASSERT_EQ(scan.series.size(), 3u);
  EXPECT_EQ(named(scan, "t1.nii.gz").role, SeriesRole::Anatomical);
  EXPECT_EQ(named(scan, "stiffness.mha").role, SeriesRole::Stiffness);
  EXPECT_EQ(named(scan, "liver.nrrd").role, SeriesRole::Other);
  for (const dicom::Series& s : scan.series) {
    EXPECT_TRUE(isVolume(s));
    EXPECT_TRUE(s.grid.sameGeometry(test::letterF().grid)) << s.description;
    EXPECT_FALSE(s.roleReason.empty());
    const dicom::Thumbnail picture = smallPicture(s, 32);
    EXPECT_EQ(std::max(picture.width, picture.height), 32);
    EXPECT_EQ(picture.grey.size(), static_cast<std::size_t>(picture.width * picture.height));
  }
  EXPECT_EQ(readImage(named(scan, "t1.nii.gz")).values, grey().values);
  ASSERT_EQ(scan.skipped.size(), 1u);
  EXPECT_EQ(scan.skipped.front().file.filename(), "broken.nii.gz");
  EXPECT_FALSE(scan.skipped.front().reason.empty());
  const auto regions = offeredRegions(scan);
  ASSERT_EQ(regions.size(), 1u);
  EXPECT_EQ(regions.front().file.filename(), "liver.nrrd");
  EXPECT_EQ(regions.front().number, 0);
  // A scene names volume files by their path.
  EXPECT_EQ(dicomRoles({{named(scan, "t1.nii.gz").uid, SeriesRole::Other}, {"1.2.3", SeriesRole::Wave}}),
            (dicom::RoleOverrides{{"1.2.3", SeriesRole::Wave}}));
}

TEST(VolumeFiles, OnlyTheNamedOnesAreLookedAt) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directories(folder / "a");
  image::writeVolume(folder / "a" / "t1.nii.gz", grey());
  image::writeVolume(folder / "t2.nii.gz", grey());
  image::writeVolume(folder / "liver.nrrd", test::letterF());
  const auto [source, names] = commonFolder({folder / "a" / "t1.nii.gz", folder / "liver.nrrd"});
  EXPECT_EQ(source, folder.path());
  EXPECT_EQ(names, (std::vector<std::string>{"a/t1.nii.gz", "liver.nrrd"}));
  const dicom::ScanResult scan = scanAll(source, names);
  ASSERT_EQ(scan.series.size(), 2u);
  EXPECT_EQ(scan.series.front().description, "t1.nii.gz");
  EXPECT_EQ(commonFolder({folder / "t2.nii.gz"}).second.size(), 0u) << "one path is opened as it is";
}

TEST(VolumeFiles, AMaskByItselfIsItsOwnPicture) {
  const test::TemporaryFolder folder;
  image::writeVolume(folder / "liver.nii.gz", labels(3));
  const dicom::ScanResult scan = scanAll(folder / "liver.nii.gz", {});
  ASSERT_EQ(scan.series.size(), 1u);
  EXPECT_EQ(scan.series.front().role, SeriesRole::Anatomical);
  const auto regions = offeredRegions(scan);
  ASSERT_EQ(regions.size(), 3u) << "each label by itself";
  EXPECT_EQ(regions[2].number, 3);
}

TEST(SeriesGroups, ArePatientsStudiesAndSeriesInOrderOfTheDay) {
  dicom::ScanResult scan;
  const auto add = [&scan](const char* patient, const char* study, const char* date, const char* modality) {
    dicom::Series s;
    s.patientKey = patient;
    s.studyUid = study;
    s.studyDate = date;
    s.modality = modality;
    scan.series.push_back(s);
  };
  add("b", "2", "20240305", "MR");
  add("a", "1", "20230101", "MR");
  add("b", "3", "20230911", "CT");
  add("b", "2", "20240305", "SR");
  add("", "", "", "");
  const auto patients = groupsOf(scan);
  ASSERT_EQ(patients.size(), 3u);
  EXPECT_EQ(patients[0].number, 1);
  ASSERT_EQ(patients[0].studies.size(), 2u);
  EXPECT_EQ(patients[0].studies[0].date, "2023-09-11");
  EXPECT_EQ(patients[0].studies[1].date, "2024-03-05");
  EXPECT_EQ(patients[0].studies[1].modalities, "MR, SR");
  EXPECT_EQ(patients[0].studies[1].series, (std::vector<int>{0, 3}));
  EXPECT_EQ(patients[1].studies[0].series, std::vector<int>{1});
  EXPECT_EQ(patients[2].number, 0) << "files that name no patient come last";
  EXPECT_TRUE(groupsOf({}).empty());
}

TEST(KeptRun, IsNoneWhereNoneWasKept) {
  const test::TemporaryFolder folder, work;
  EXPECT_FALSE(keptRun(folder.path(), work.path()));
  forgetRun(folder.path());
  EXPECT_THROW(keepRun(work.path(), folder.path()), BadInput) << "there is no run to keep";
  EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "nothing half kept stays";
}

}  // namespace
}  // namespace glisson::session
