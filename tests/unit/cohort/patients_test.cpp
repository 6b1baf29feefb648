// SPDX-License-Identifier: GPL-3.0-or-later
#include "cohort/patients.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "cohort/detail/summary.h"
#include "pipeline/scene.h"
#include "support/support.h"

namespace glisson::cohort {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

void write(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream(file) << text;
}

TEST(Patients, AreNumberedByNameWhateverTheyAreCalled) {
  const test::TemporaryFolder folder;
  for (const char* name : {"zeta", "Alpha", "mid"}) write(folder / name / "a.dcm", "x");
  fs::create_directories(folder / "empty");
  write(folder / ".hidden" / "a.dcm", "x");
  write(folder / "notes.txt", "x");
  const auto patients = findPatients(folder.path());
  ASSERT_EQ(patients.size(), 3u);
  EXPECT_EQ(patients[0].id, "case-001");
  EXPECT_EQ(patients[0].folder.filename(), "Alpha");
  EXPECT_EQ(patients[2].number, 3);
  EXPECT_THROW(findPatients(folder / "empty"), BadInput);
  EXPECT_THROW(findPatients(folder / "nowhere"), BadInput);
}

TEST(Patients, DigestSeesContentAndNames) {
  const test::TemporaryFolder a, b;
  write(a / "x" / "f", "1");
  write(b / "x" / "f", "1");
  EXPECT_EQ(digestOfFolder(a.path()), digestOfFolder(b.path()));
  write(b / "x" / "f", "2");
  EXPECT_NE(digestOfFolder(a.path()), digestOfFolder(b.path()));
  write(b / "x" / "f", "1");
  fs::rename(b / "x", b / "y");
  EXPECT_NE(digestOfFolder(a.path()), digestOfFolder(b.path()));
}

TEST(Patients, AskForARegionOfInterest) {
  const test::TemporaryFolder folder;
  write(folder / "image.txt", "no DICOM");
  try {
    findFiles(folder.path());
    FAIL() << "a patient without a region was taken";
  } catch (const BadInput& e) {
    EXPECT_THAT(e.what(), HasSubstr("region of interest"));
  }
  write(folder / "Liver_Mask.nii.gz", "x");
  EXPECT_EQ(findFiles(folder.path()).roi.filename(), "Liver_Mask.nii.gz");
  write(folder / "roi.json", "{}");
  EXPECT_EQ(findFiles(folder.path()).roi.filename(), "roi.json");
}

TEST(Patients, AreMeasuredAsTheirSceneSays) {
  const test::TemporaryFolder folder;
  for (const char* name : {"mri.nii.gz", "map.nii.gz", "liver.nii.gz"}) write(folder / name, "x");
  write(folder / "scene.json", R"({"schema": "glisson/scene/1",
      "geometry": {"kind": "patient", "mri": "mri.nii.gz", "roi": "liver.nii.gz", "label": 5},
      "material": {"map": "map.nii.gz", "quantity": "shear", "unit": "Pa"},
      "supports": [{"region": {"surface": "posterior"}, "kind": "fixed"}],
      "loads": [{"kind": "body_force", "N_per_m3": [0, 0, -1]}]})");
  const PatientFiles files = findFiles(folder.path());
  EXPECT_EQ(files.mre.filename(), "map.nii.gz");
  EXPECT_THAT(files.meaning, ElementsAre("--quantity", "shear", "--unit", "Pa", "--label", "5"));
  // A map needs no elastogram: none is made up.
  EXPECT_THAT(sceneOf(folder.path(), {}), Not(HasSubstr("\"mre\"")));
}

TEST(Patients, GetThePapersRetractionOrTheTemplate) {
  const test::TemporaryFolder folder;
  write(folder / "roi.json", "{}");
  const std::string own = sceneOf(folder.path(), {});
  EXPECT_THAT(own, HasSubstr("retractor"));
  EXPECT_THAT(own, HasSubstr("\"against\""));
  const std::string other =
      sceneOf(folder.path(), R"({"schema": "glisson/scene/1", "geometry": {"kind": "box", "size_mm": [9, 9, 9]},
      "material": "mre", "supports": [{"region": {"face": "z+"}, "kind": "fixed"}],
      "loads": [{"kind": "body_force", "N_per_m3": [0, 0, -1]}], "outputs": ["overlay"]})");
  EXPECT_THAT(other, HasSubstr("body_force"));
  EXPECT_THAT(other, HasSubstr("\"patient\""));
  EXPECT_THAT(other, Not(HasSubstr("overlay")));
  EXPECT_THROW(sceneOf(folder.path(), R"({"schema": "glisson/scene/1", "geometry": {}, "surprise": 1})"), BadInput);
  // What may stand in a result says nothing about where the files are.
  EXPECT_THAT(withoutPaths(own), Not(HasSubstr(folder.path().string())));
}

TEST(Variations, ChangeOneAssumptionEach) {
  const test::TemporaryFolder folder;
  write(folder / "roi.json", "{}");
  const auto list = detail::variations(sceneOf(folder.path(), {}));
  EXPECT_EQ(list[0].name, "as simulated");
  for (std::size_t i = 1; i < list.size(); ++i) EXPECT_NE(list[i].scene, list[0].scene) << list[i].name;
  EXPECT_THAT(list[1].scene, HasSubstr("0.05"));
  const auto sceneNamed = [](const auto& all, const std::string& name) {
    for (const auto& v : all)
      if (v.name == name) return v.scene;
    return std::string();
  };
  EXPECT_THAT(sceneNamed(list, "no capsule"), HasSubstr("\"capsule\": false"));
  EXPECT_THAT(sceneNamed(list, "linear, patch of pressure"), HasSubstr("\"contact\": \"patch\""));
  EXPECT_THAT(sceneNamed(list, "lifted by 30 mm"), AllOf(HasSubstr("travel_mm"), Not(HasSubstr("liver-weight"))));
  EXPECT_EQ(sceneNamed(list, "bare bar"), "");
  // A patch has assumptions of its own. Each scene can be read.
  const auto patch = detail::variations(sceneNamed(list, "linear, patch of pressure"));
  EXPECT_THAT(sceneNamed(patch, "corotational, 10 mm cells, 20 mm spread"), HasSubstr("corotational"));
  EXPECT_THAT(sceneNamed(patch, "bare bar"), HasSubstr("\"spread_mm\": 0.0"));
  EXPECT_EQ(sceneNamed(patch, "no capsule"), "");
  for (const auto& all : {list, patch})
    for (const auto& v : all) EXPECT_NO_THROW(pipeline::parseScene(v.scene, folder.path())) << v.name;
}

}  // namespace
}  // namespace glisson::cohort
