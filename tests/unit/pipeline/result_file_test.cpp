// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/result_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "base/error.h"
#include "pipeline/run.h"
#include "pipeline/write_again.h"
#include "support/support.h"

namespace glisson::pipeline {
namespace {

std::string bytesOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A block on a bed, lifted by a rigid bar under two stiffnesses: with contact, comparison, report and pictures.
class ResultFile : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TemporaryFolder>();
    const Scene scene = parseScene(R"({ "schema": "glisson/scene/1",
      "geometry": { "kind": "box", "size_mm": [100, 60, 60], "cell_mm": 10 },
      "material": { "shear_kPa": 2, "poisson": 0.45 },
      "supports": [ { "region": {"face":"y-"}, "kind": "fixed" } ],
      "loads": [ { "kind": "retractor", "diameter_mm": 12, "length_mm": 40, "at": [50, 60, 30], "axis": [1, 0, 0],
                   "direction": [0, -1, 0], "contact": "rigid", "force": 4 } ],
      "compare": { "against": "atlas", "shear_kPa": 4 }, "outputs": ["report"] })",
                                   folder_->path());
    result_ = std::make_unique<RunResult>(run(scene, {.output = folder_->path() / "run"}));
    result_->picture.reset();
  }
  static void TearDownTestSuite() {
    result_.reset();
    folder_.reset();
  }
  static std::filesystem::path runFolder() { return folder_->path() / "run"; }
  static std::unique_ptr<test::TemporaryFolder> folder_;
  static std::unique_ptr<RunResult> result_;
};
std::unique_ptr<test::TemporaryFolder> ResultFile::folder_;
std::unique_ptr<RunResult> ResultFile::result_;

TEST_F(ResultFile, ComesBackToTheLastBit) {
  ASSERT_TRUE(result_->primary.contact && result_->difference);
  writeResultFile(runFolder(), *result_);
  const std::string first = bytesOf(runFolder() / resultFileName);
  const RunResult back = readResultFile(runFolder());
  writeResultFile(runFolder(), back);
  EXPECT_EQ(first, bytesOf(runFolder() / resultFileName));
  EXPECT_EQ(back.json, result_->json);
  EXPECT_EQ(back.files, result_->files);
  EXPECT_EQ(back.primary.nodal_u_m, result_->primary.nodal_u_m);
  EXPECT_EQ(back.primary.contact->path, result_->primary.contact->path);
  EXPECT_EQ(back.primary.contact->pressure_kPa, result_->primary.contact->pressure_kPa);
  EXPECT_EQ(back.difference->at_retractor_mm, result_->difference->at_retractor_mm);
  EXPECT_EQ(back.diagnostics.texts(), result_->diagnostics.texts());
  EXPECT_EQ(back.warnings, result_->warnings);
  EXPECT_EQ(back.plan.size(), result_->plan.size());
  EXPECT_EQ(back.placed->bar.at_mm, result_->placed->bar.at_mm);
}

TEST_F(ResultFile, WritesTheSameReportAsTheRunItself) {
  writeResultFile(runFolder(), *result_);
  const RunResult back = readResultFile(runFolder());
  test::TemporaryFolder own, kept;
  std::vector<std::filesystem::path> written;
  const WriteAgain fromRun{runFolder(), own.path(), render::Palette::RedBlue, {}};
  const WriteAgain fromFile{runFolder(), kept.path(), render::Palette::RedBlue, {}};
  writeAgain(*result_, fromRun, written);
  writeAgain(back, fromFile, written);
  EXPECT_THAT(bytesOf(own / "report.html"), testing::Not(testing::IsEmpty()));
  for (const char* name : {"report.html", "run.json"}) EXPECT_EQ(bytesOf(own / name), bytesOf(kept / name)) << name;
}

TEST_F(ResultFile, IsReadWhereverItsFolderHasGone) {
  writeResultFile(runFolder(), *result_);
  const std::filesystem::path moved = folder_->path() / "elsewhere" / "run";
  std::filesystem::create_directories(moved);
  std::filesystem::copy(runFolder(), moved, std::filesystem::copy_options::recursive);
  const RunResult back = readResultFile(moved);
  ASSERT_EQ(back.files.size(), result_->files.size());
  for (const std::filesystem::path& file : back.files) {
    EXPECT_TRUE(std::filesystem::exists(file)) << file;
    EXPECT_EQ(file.lexically_relative(moved).string().find(".."), std::string::npos);
  }
}

TEST_F(ResultFile, RefusesWhatIsMissingCutShortOrDamaged) {
  test::TemporaryFolder other;
  EXPECT_THROW(readResultFile(other.path()), BadInput);
  writeResultFile(runFolder(), *result_);
  const std::string whole = bytesOf(runFolder() / resultFileName);
  const auto put = [&](const std::string& bytes) { std::ofstream(other / resultFileName, std::ios::binary) << bytes; };
  for (const std::size_t length :
       {std::size_t{0}, std::size_t{7}, std::size_t{60}, whole.size() / 2, whole.size() - 1}) {
    put(whole.substr(0, length));
    EXPECT_THROW(readResultFile(other.path()), BadInput) << "cut after " << length;
  }
  for (const std::size_t at : {std::size_t{0}, std::size_t{8}, std::size_t{16}, std::size_t{30}, whole.size() / 2}) {
    std::string flipped = whole;
    flipped[at] = static_cast<char>(flipped[at] ^ 1);
    put(flipped);
    EXPECT_THROW(readResultFile(other.path()), BadInput) << "byte " << at;
  }
  put(whole);
  EXPECT_NO_THROW(readResultFile(other.path()));
}

}  // namespace
}  // namespace glisson::pipeline
