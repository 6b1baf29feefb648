// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/run_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "base/atomic_file.h"
#include "base/error.h"
#include "phantom/phantom.h"
#include "session/deidentify_folder.h"
#include "support/support.h"

namespace glisson::session {
namespace {

RunRecord run(double at_retractor_mm, const std::string& poisson, const std::string& mri,
              const std::string& more = "") {
  return {R"({"schema": "glisson/run/1", "difference": {"mean_mm": 1.0, "at_retractor_mm": )" +
              std::to_string(at_retractor_mm) +
              R"j(}, "p95_strain": 0.125, "parameters": {"geometry": {"mri": "(file)"},
              "material": {"poisson": )j" +
              poisson + more +
              R"(}, "loads": [{"kind": "retractor", "at_mm": [1, 2, 3]}]}, "inputs": {"mri": {"sha256": ")" + mri +
              R"("}}})",
          {}};
}

const FigureBeside& named(const RunsBeside& both, const std::string& words) {
  return *std::find_if(both.figures.begin(), both.figures.end(),
                       [&](const FigureBeside& f) { return words == f.words; });
}

TEST(RunFigures, StandSideBySide) {
  const RunsBeside both = beside(run(4.5, "0.45", "a"), run(6.0, "0.49", "a", R"(, "capsule": true)"));
  EXPECT_DOUBLE_EQ(*named(both, "Difference at the retractor").difference(), 1.5);
  EXPECT_DOUBLE_EQ(*named(both, "Mean difference").difference(), 0.0);
  EXPECT_DOUBLE_EQ(*named(both, "Strain, 95 % below").first, 12.5);
  for (const FigureBeside& f : both.figures) EXPECT_STRNE(f.words, "Contact area");  // neither has one
  ASSERT_EQ(both.settings.size(), 2U);
  EXPECT_EQ(both.settings[0].key, "material.capsule");
  EXPECT_EQ(both.settings[0].first, "");
  EXPECT_EQ(both.settings[0].second, "true");
  EXPECT_EQ(both.settings[1].key, "material.poisson");
  EXPECT_EQ(both.settings[1].second, "0.49");
  EXPECT_TRUE(both.samePatient());
  EXPECT_FALSE(beside(run(4.5, "0.45", "a"), run(4.5, "0.45", "b")).samePatient());
}

TEST(RunFigures, AFigureThatOneRunLacksHasNoDifference) {
  const RunRecord without{R"({"schema": "glisson/run/1", "p95_strain": 0.1, "difference": null})", {}};
  const FigureBeside& f = named(beside(run(4.5, "0.45", "a"), without), "Difference at the retractor");
  EXPECT_TRUE(f.first && !f.second);
  EXPECT_FALSE(f.difference());
}

TEST(RunFigures, AreReadFromRunsAndCases) {
  const test::TemporaryFolder folder;
  const std::string text = run(4.5, "0.45", "a").json;
  for (const char* place : {"one", "two/results", "three/last-run/results"}) {
    std::filesystem::create_directories(folder / place);
    writeAtomically(folder / place / "run.json", text);
  }
  for (const char* place : {"one", "two", "three", "one/run.json"}) EXPECT_EQ(readRunRecord(folder / place), text);
  EXPECT_THROW(readRunRecord(folder.path()), BadInput);
  writeAtomically(folder / "one/run.json", "{}");
  EXPECT_THROW(readRunRecord(folder / "one"), BadInput);
  EXPECT_THROW(beside({"[]", {}}, {text, {}}), BadInput);
}

class DeidentifyFolder : public testing::Test {
 protected:
  void SetUp() override { phantom::writePhantom(phantom::makePhantom(5, {}), folder_ / "patient"); }
  DeidentifyWish wish() const { return {folder_ / "patient", folder_ / "copies", folder_ / "project.key", {}}; }
  test::TemporaryFolder folder_;
};

TEST_F(DeidentifyFolder, TellsWhatWasChanged) {
  const DeidentifyReport report = deidentifyFolder(wish());
  EXPECT_GT(report.files, 50U);
  EXPECT_EQ(report.patients, 1U);
  EXPECT_TRUE(report.keyMade);
  // Patient's name and ID, and at least study, series and instance, in every file.
  EXPECT_GE(report.changes.replaced, 2 * report.files);
  EXPECT_GE(report.changes.uids, 3 * report.files);
  EXPECT_GE(report.changes.dates, report.files);
  std::size_t left = 0;
  for (const auto& one : report.leftOut) left += one.files;
  EXPECT_GT(left, 0U);  // truth.json and volumes of the phantom are no DICOM
  EXPECT_LT(report.leftOut.size(), left);
  EXPECT_THROW(deidentifyFolder(wish()), BadInput);  // not empty
  EXPECT_TRUE(std::filesystem::exists(folder_ / "copies"));
}

TEST_F(DeidentifyFolder, LeavesNothingOfWhatWasCancelled) {
  std::stop_source stop;
  const Progress progress(
      [&](double, const std::string& what) {
        if (what == "de-identifying" && std::filesystem::exists(folder_ / "copies") &&
            !std::filesystem::is_empty(folder_ / "copies"))
          stop.request_stop();
      },
      stop.get_token());
  EXPECT_THROW(deidentifyFolder(wish(), progress), Cancelled);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "copies"));
  EXPECT_GT(deidentifyFolder(wish()).files, 50U);
}

}  // namespace
}  // namespace glisson::session
