// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <memory>

#include "base/error.h"
#include "pipeline/export.h"
#include "pipeline/run.h"
#include "support/support.h"

namespace glisson::pipeline {
namespace {

using testing::HasSubstr;

constexpr const char* box = R"({ "schema": "glisson/scene/1",
  "geometry": { "kind": "box", "size_mm": [40,20,20], "cell_mm": 5 },
  "material": { "youngs_kPa": 6, "poisson": 0.45 },
  "supports": [ { "region": {"face":"x-"}, "kind": "fixed" } ],
  "loads": [ { "kind": "traction", "region": {"face":"x+"}, "kPa": [0,0,0.1] } ] })";

class Export : public testing::Test {
 protected:
  void SetUp() override { std::ofstream(folder_ / "scene.json") << box; }
  ExportRequest request(std::vector<std::string> formats) {
    ExportRequest r;
    r.source = folder_ / "scene.json";
    r.output = folder_ / "out";
    r.formats = std::move(formats);
    return r;
  }
  test::TemporaryFolder folder_;
};

TEST_F(Export, AFormatThatIsRefusedEndsItOrIsLeftOut) {
  ExportRequest asked = request({"vtu", "nifti", "field"});
  EXPECT_THROW(exportFiles(asked), BadInput);
  asked.leaveOutRefused = true;
  const Exported done = exportFiles(asked);
  ASSERT_EQ(done.refused.size(), 1U);
  EXPECT_EQ(done.refused[0].format, "nifti");
  EXPECT_THAT(done.refused[0].reason, HasSubstr("region of interest"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/body.vtu"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/displacement.nrrd"));
  for (const auto& f : done.files) EXPECT_TRUE(std::filesystem::exists(f)) << f;
}

TEST_F(Export, WhatIsSolvedAlreadyIsTaken) {
  auto solved = std::make_shared<RunResult>(run(readScene(folder_ / "scene.json"), {}));
  // Not what the scene gives: so it is seen where the numbers come from.
  for (auto& u : solved->primary.u_mm.values) u *= 2.0F;
  solved->model.volume_mL = 1234.0;
  ExportRequest asked = request({"csv"});
  asked.solved = solved;
  exportFiles(asked);
  std::ifstream in(folder_ / "out/measurements.csv");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  EXPECT_THAT(text, HasSubstr("1234"));
}

}  // namespace
}  // namespace glisson::pipeline
