// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "pipeline/file_names.h"
#include "pipeline/scene.h"
#include "pipeline/sources.h"
#include "support/support.h"

namespace glisson::pipeline {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(Together, sameExaminationSaysNothingAndSilenceIsNoContradiction) {
  AnatomicalImage mri;
  LoadedStiffness mre;
  EXPECT_THAT(checkTogether(mri, mre, false), IsEmpty());
  mri.patientKey = mre.patientKey = "a";
  mri.studyDate = "20200101";  // the map does not say
  mri.frameOfReferenceUid = mre.map.frameOfReferenceUid = "1.2";
  EXPECT_THAT(checkTogether(mri, mre, false), IsEmpty());
}

TEST(Together, otherPatientOrDayIsAnErrorUnlessOverriddenAndThenStored) {
  AnatomicalImage mri;
  LoadedStiffness mre;
  mri.patientKey = "a";
  mre.patientKey = "b";
  EXPECT_THROW(checkTogether(mri, mre, false), BadInput);
  EXPECT_THAT(checkTogether(mri, mre, true), ElementsAre(HasSubstr("different patients: overridden by the user")));
  mre.patientKey = "a";
  mri.studyDate = "20200101";
  mre.studyDate = "20200102";
  try {
    checkTogether(mri, mre, false);
    FAIL() << "other days were taken together";
  } catch (const BadInput& e) {
    EXPECT_THAT(e.what(), HasSubstr("--override"));
    EXPECT_THAT(e.what(), Not(HasSubstr("2020")));  // a date may tell who it is
  }
  EXPECT_THAT(checkTogether(mri, mre, true), ElementsAre(HasSubstr("different days: overridden by the user")));
}

TEST(Together, otherFrameOfReferenceIsAWarningToBeConfirmed) {
  AnatomicalImage mri;
  LoadedStiffness mre;
  mri.frameOfReferenceUid = "1.2";
  mre.map.frameOfReferenceUid = "1.3";
  EXPECT_THAT(checkTogether(mri, mre, false), ElementsAre(HasSubstr("confirm it with --override")));
  EXPECT_THAT(checkTogether(mri, mre, true), ElementsAre(HasSubstr("confirmed by the user")));
}

TEST(Together, aRegionOfAnotherPatientOrDayIsAnErrorUnlessOverridden) {
  AnatomicalImage mri;
  LoadedStiffness mre;
  LoadedRoi roi;
  EXPECT_THAT(checkRoi(roi, &mri, &mre, false), IsEmpty());  // nobody says anything
  EXPECT_THAT(checkRoi(roi, nullptr, nullptr, false), IsEmpty());
  mri.patientKey = mre.patientKey = roi.origin.patientKey = "a";
  mri.studyDate = mre.studyDate = "20200101";
  mri.studyUid = "1.5";
  mri.frameOfReferenceUid = roi.frameOfReferenceUid = "1.2";
  roi.origin.studyDate = "20200301";  // drawn later, in the frame of reference of the images
  EXPECT_THAT(checkRoi(roi, &mri, &mre, false), IsEmpty());
  roi.frameOfReferenceUid = "1.3";
  EXPECT_THROW(checkRoi(roi, &mri, nullptr, false), BadInput);
  EXPECT_THROW(checkRoi(roi, nullptr, &mre, false), BadInput);
  EXPECT_THAT(checkRoi(roi, &mri, nullptr, true),
              ElementsAre(HasSubstr("another day"), HasSubstr("frames of reference")));
  roi.origin.studyUid = "1.5";  // filed under another day, drawn on this examination
  EXPECT_THAT(checkRoi(roi, &mri, nullptr, false), ElementsAre(HasSubstr("confirm it with --override")));
  roi.frameOfReferenceUid = "1.2";
  roi.origin.patientKey = "b";
  try {
    checkRoi(roi, &mri, &mre, false);
    FAIL() << "a region of another patient was taken";
  } catch (const BadInput& e) {
    EXPECT_THAT(e.what(), HasSubstr("the region of interest and the MRI belong to different patients"));
    EXPECT_THAT(e.what(), HasSubstr("--override"));
  }
  mre.studyUid = "1.5";
  EXPECT_THAT(checkRoi(roi, nullptr, &mre, true), ElementsAre(HasSubstr("different patients: overridden by the user")));
}

TEST(Together, readersOutlineOnePatient) {
  std::vector<LoadedRoi> rois(3);
  EXPECT_THAT(checkReaders(rois, false), IsEmpty());
  rois[0].origin.patientKey = rois[1].origin.patientKey = "a";
  rois[2].origin.patientKey = "b";
  EXPECT_THROW(checkReaders(rois, false), BadInput);
  EXPECT_THAT(checkReaders(rois, true), ElementsAre(HasSubstr("reader 1 and reader 3 belong to different patients")));
  rois[2].origin.patientKey = "a";
  rois[0].frameOfReferenceUid = "1.2";
  rois[1].frameOfReferenceUid = "1.3";
  EXPECT_THAT(checkReaders(rois, false), ElementsAre(HasSubstr("different frames of reference")));
}

TEST(Together, differencesAreNamedByKindWithoutRefusing) {
  AnatomicalImage mri;
  LoadedStiffness mre;
  EXPECT_THAT(differences(mri, mre), IsEmpty());
  mri.patientKey = mri.studyDate = mri.frameOfReferenceUid = "1";
  mre.patientKey = mre.studyDate = mre.map.frameOfReferenceUid = "2";
  std::vector<Difference::In> in;
  for (const Difference& d : differences(mri, mre)) in.push_back(d.in);
  EXPECT_THAT(in, ElementsAre(Difference::In::Patient, Difference::In::Day, Difference::In::Frame));
  LoadedRoi roi;
  roi.origin.patientKey = "1";
  roi.frameOfReferenceUid = "2";
  const auto found = differences(roi, &mri, nullptr);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found.front().in, Difference::In::Frame);
}

/// The folders that a patient's scene names.
struct PatientFolder : test::TemporaryFolder {
  PatientFolder() {
    for (const char* name : {"mri", "mre", "roi"}) std::filesystem::create_directory(*this / name);
  }
  /// more: keys of its geometry, each with a comma before it.
  Scene scene(const std::string& more) const {
    return parseScene(
        R"({"schema":"glisson/scene/1","geometry":{"kind":"patient","mri":"mri","mre":"mre","roi":"roi")" + more +
            R"(},"material":"mre","supports":[],"loads":[]})",
        path());
  }
};

TEST(Together, aSceneKeepsWhatABareElastogramIs) {
  const PatientFolder folder;
  const auto scene = [&folder](const std::string& more) { return folder.scene(more); };
  EXPECT_FALSE(scene("").geometry.mreQuantity || scene("").geometry.mreUnit);
  const Scene again = parseScene(toJson(scene(R"(,"mre_quantity":"youngs","mre_unit":"0.01kPa")")), folder.path());
  EXPECT_EQ(again.geometry.mreQuantity, StiffnessQuantity::Youngs);
  EXPECT_EQ(again.geometry.mreUnit, "0.01kPa");
  EXPECT_EQ(parseScene(toJson(scene(R"(,"mre_confidence_scale":255)")), folder.path()).geometry.mreConfidenceScale,
            255.0);
  EXPECT_THROW(scene(R"(,"mre_confidence_scale":0)"), BadInput);
  EXPECT_THROW(scene(R"(,"mre_quantity":"bulk")"), BadInput);
}

TEST(Together, aRoleMustBeOfASeriesThatIsThere) {
  const dicom::RoleOverrides roles = {{"1.2", dicom::SeriesRole::Stiffness}, {"7", dicom::SeriesRole::Anatomical}};
  EXPECT_NO_THROW(checkRolesFound(roles, {{"1.2"}, {"7"}}));
  EXPECT_THROW(checkRolesFound(roles, {{"1.2"}, {"7", "1.2"}}), BadInput);
}

TEST(Together, aSceneKeepsRolesAndOverride) {
  const PatientFolder folder;
  const auto scene = [&folder](const std::string& more) { return folder.scene(more); };
  EXPECT_FALSE(scene("").geometry.overrideChecks);
  const Scene given = scene(R"(,"override":true,"roles":{"1.2.3":"stiffness","401":"phase"})");
  EXPECT_TRUE(given.geometry.overrideChecks);
  EXPECT_EQ(given.geometry.roles.at("1.2.3"), dicom::SeriesRole::Stiffness);
  EXPECT_EQ(given.geometry.roles.at("401"), dicom::SeriesRole::Phase);
  const Scene again = parseScene(toJson(given), folder.path());
  EXPECT_EQ(again.geometry.roles, given.geometry.roles);
  EXPECT_TRUE(again.geometry.overrideChecks);
  EXPECT_THROW(scene(R"(,"roles":{"1.2.3":"stiff"})"), BadInput);
  EXPECT_THROW(scene(R"(,"roles":["1.2.3"])"), BadInput);
}

TEST(FileNames, areNumbersInOrderOfNamesWhereverTheyAreQuoted) {
  dicom::ScanResult scan;
  scan.series.emplace_back();
  scan.series.front().files = {"in/doe-3.dcm", "in/doe-1.dcm"};
  scan.skipped = {{"in/doe-2.txt", "is a copy of 'doe-1.dcm'"}};
  const FileNames names(scan);
  EXPECT_EQ(names.placeOf("in/doe-2.txt"), "file 2 of 3");
  EXPECT_EQ(names.placeOf("doe.txt"), "a file");
  EXPECT_EQ(names.hiddenIn("'doe-3.dcm', 'doe-1.dcm' and 'doe-3.dcm': 'kPa'"),
            "file 3 of 3, file 1 of 3 and file 3 of 3: 'kPa'");
}

}  // namespace
}  // namespace glisson::pipeline
