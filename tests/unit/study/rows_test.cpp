// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/rows.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/random.h"
#include "support/support.h"

namespace glisson::study {
namespace {

Row row(double seconds, double error_mm, const std::string& reference = "r") {
  Row r;
  r.method = "m";
  r.build_s = 0.25 * seconds;
  r.solve_s = 0.75 * seconds;
  r.max_error_mm = error_mm;
  r.reference = reference;
  return r;
}

TEST(Pareto, ByItsDefinitionOnRandomRows) {
  Random random(3);
  for (int round = 0; round < 50; ++round) {
    std::vector<Row> rows;
    for (int i = 0; i < 40; ++i)
      rows.push_back(row(std::floor(random.uniform(1, 9)), std::floor(random.uniform(1, 9)), i % 2 ? "a" : "b"));
    markPareto(rows);
    for (const Row& r : rows) {
      const bool beaten = std::any_of(rows.begin(), rows.end(), [&](const Row& o) {
        return o.reference == r.reference && o.total_s() <= r.total_s() && o.max_error_mm <= r.max_error_mm &&
               (o.total_s() < r.total_s() || o.max_error_mm < r.max_error_mm);
      });
      EXPECT_EQ(r.pareto, !beaten) << r.total_s() << " s, " << r.max_error_mm << " mm";
    }
  }
}

TEST(Pareto, RowsWithoutAnAnswerAreNeverOnTheFront) {
  std::vector<Row> rows = {row(1e-3, std::numeric_limits<double>::quiet_NaN()), row(1, 1),
                           row(1e-3, std::numeric_limits<double>::infinity())};
  markPareto(rows);
  EXPECT_FALSE(rows[0].pareto);
  EXPECT_TRUE(rows[1].pareto);
  EXPECT_FALSE(rows[2].pareto);
}

TEST(Rows, CsvHasOneLineARowAndEveryNumberComesBack) {
  std::vector<Row> rows = {row(0.8, 0.0123456789), row(2, std::numeric_limits<double>::quiet_NaN())};
  rows[1].note = "stopped, \"early\"";
  const std::string text = csv(rows);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3);
  EXPECT_THAT(text, testing::HasSubstr("0.0123456789"));
  EXPECT_THAT(text, testing::HasSubstr("\"stopped, \"\"early\"\"\""));
  EXPECT_THAT(text, testing::Not(testing::HasSubstr("nan")));
}

TEST(Rows, FilesAreWrittenAndAChartWithoutPointsIsLeftOut) {
  const test::TemporaryFolder folder;
  const std::vector<Row> rows = {row(0.8, 0.01), row(0.1, 0.1)};
  EXPECT_EQ(write(folder / "deep" / "down", "x", rows, chart(rows, "r", "title", "caption")).size(), 3u);
  for (const char* ending : {".csv", ".png", ".svg"})
    EXPECT_GT(std::filesystem::file_size(folder / "deep" / "down" / (std::string("x") + ending)), 50u);
  const std::vector<Row> nothing = {row(1, 0.0)};
  EXPECT_EQ(write(folder / "n", "x", nothing, chart(nothing, "r", "title", "caption")).size(), 1u);
}

}  // namespace
}  // namespace glisson::study
