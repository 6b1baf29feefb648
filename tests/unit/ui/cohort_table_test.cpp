// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/cohort_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "support/support.h"

namespace glisson::session {
namespace {

using cohort::CaseOutcome;
using testing::ElementsAre;

cohort::CaseRecord record(int number, double at_retractor_mm, CaseOutcome::Status status = CaseOutcome::Status::Done) {
  cohort::CaseRecord r = cohort::recordOf("case-00" + std::to_string(number), "key", "", "");
  r.outcome.status = status;
  if (status == CaseOutcome::Status::Rejected) r.outcome.reason = "no bar holds this liver";
  r.at_retractor_mm = at_retractor_mm;
  return r;
}

const CohortFigure& atRetractor() {
  return cohortFigures().front();
}

TEST(CohortTable, ResultsOfACohortAreReadAndWhatIsBrokenIsCounted) {
  const test::TemporaryFolder folder;
  for (const int n : {3, 1, 2})
    cohort::writeWhole(folder / ("cases/case-00" + std::to_string(n) + "/result.json"),
                       cohort::toJson(record(n, 1.5 * n)));
  cohort::writeWhole(folder / "cases/case-004/result.json", "{\"schema\": \"glisson/coh");
  for (const auto& path : {folder.path(), folder / "cases"}) {
    const Cohort read = readCohort(path);
    EXPECT_EQ(read.kind, Cohort::Kind::Results);
    EXPECT_EQ(read.unread, 1U);
    ASSERT_EQ(read.patients.size(), 3U);
    EXPECT_EQ(read.patients[2].record.outcome.id, "case-003");
    EXPECT_DOUBLE_EQ(read.patients[2].record.at_retractor_mm, 4.5);
    EXPECT_TRUE(read.patients[2].opens.empty());
  }
}

TEST(CohortTable, FoldersOfRunsAreReadWithoutTheirNames) {
  const test::TemporaryFolder folder;
  const std::string run = R"({"schema": "glisson/run/1", "solver": {"converged": true},
    "difference": {"mean_mm": 2.25, "at_retractor_mm": 6.5}, "model": {"volume_mL": 1400.0, "dofs": 5000},
    "stiffness": {"quantity": "shear", "n": 700, "mean_kPa": 3.5, "sd_kPa": 0.25}})";
  cohort::writeWhole(folder / "DOE^JANE/results/run.json", run);
  cohort::writeWhole(folder / "MILLER/run.json", R"({"schema": "something else"})");
  std::filesystem::create_directories(folder / "mri");
  cohort::writeWhole(folder / "mri/image.nrrd", "image");
  cohort::writeWhole(folder / "ROE^JIM/run.json", run);
  cohort::writeWhole(folder / "ROE^JIM/scene.json",
                     R"({"schema": "glisson/scene/1", "geometry": {"kind": "patient", "mri": "../mri/image.nrrd",
                        "roi": "roi.json"}, "material": {"E_kPa": 6.0}})");
  const Cohort read = readCohort(folder.path());
  EXPECT_EQ(read.kind, Cohort::Kind::Runs);
  ASSERT_EQ(read.patients.size(), 2U);
  EXPECT_EQ(read.unread, 2U);
  const cohort::CaseRecord& r = read.patients[0].record;
  EXPECT_EQ(r.outcome.id, "case-001");
  EXPECT_DOUBLE_EQ(r.at_retractor_mm, 6.5);
  EXPECT_DOUBLE_EQ(r.shear_kPa, 3.5);
  EXPECT_DOUBLE_EQ(r.youngs_kPa, 10.5);
  EXPECT_DOUBLE_EQ(r.volume_mL, 1400.0);
  EXPECT_TRUE(std::isnan(r.travel_mm));
}

TEST(CohortTable, AnythingElseIsRefused) {
  const test::TemporaryFolder folder;
  cohort::writeWhole(folder / "letters/to-mother.txt", "dear");
  EXPECT_THROW(readCohort(folder.path()), BadInput);
  EXPECT_THROW(readCohort(folder / "nowhere"), BadInput);
}

TEST(CohortTable, AThousandPatientsCanBeCancelled) {
  const test::TemporaryFolder folder;
  for (int n = 0; n < 50; ++n)
    cohort::writeWhole(folder / ("cases/p" + std::to_string(n) + "/result.json"), cohort::toJson(record(1, 1.0)));
  std::stop_source stop;
  int reports = 0;
  const Progress progress(
      [&](double, const std::string&) {
        if (++reports == 10) stop.request_stop();
      },
      stop.get_token());
  EXPECT_THROW(readCohort(folder.path(), progress), Cancelled);
  EXPECT_LT(reports, 15);
}

TEST(CohortTable, FilterAndChoice) {
  Cohort cohort;
  const double none = std::numeric_limits<double>::quiet_NaN();
  cohort.patients = {{record(1, 2.0), {}},
                     {record(2, 5.0), {}},
                     {record(3, none, CaseOutcome::Status::Rejected), {}},
                     {record(4, 9.0), {}}};
  cohort.patients[3].record.warnings = {"the Bar slips"};
  CohortFilter filter;
  EXPECT_THAT(passing(cohort, filter), ElementsAre(0, 1, 2, 3));
  filter.figure = &atRetractor();
  filter.low = 5.0;
  EXPECT_THAT(passing(cohort, filter), ElementsAre(1, 3));
  filter.high = 5.0;
  EXPECT_THAT(passing(cohort, filter), ElementsAre(1));
  filter = {};
  filter.text = "bar";
  EXPECT_THAT(passing(cohort, filter), ElementsAre(2, 3));
  filter.text = "CASE-001";
  EXPECT_THAT(passing(cohort, filter), ElementsAre(0));
  const std::vector<std::size_t> all = {0, 1, 2, 3};
  EXPECT_THAT(valuesOf(cohort, all, atRetractor()), ElementsAre(2.0, 5.0, 9.0));
  EXPECT_THAT(within(cohort, all, atRetractor(), 2.0, 5.0), ElementsAre(0));
  EXPECT_EQ(nearest(cohort, all, atRetractor(), 7.5), std::size_t{3});
  EXPECT_FALSE(nearest(cohort, {2}, atRetractor(), 7.5));
}

}  // namespace
}  // namespace glisson::session
