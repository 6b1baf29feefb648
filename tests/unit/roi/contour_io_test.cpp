// SPDX-License-Identifier: GPL-3.0-or-later
#include "roi/contour_io.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <clocale>
#include <fstream>
#include <limits>

#include "base/error.h"
#include "base/random.h"
#include "shapes.h"
#include "support/support.h"

namespace glisson::roi {
namespace {

using namespace test;

ContourStack sample() {
  Random random(3);
  ContourStack s = stack({rectangle(grids()[4], 2, 2, 2, 9, 9), rectangle(grids()[2], 1, 2.1, 2, 9, 9)});
  s.name = "Leber ü \"links\"\n";
  s.frameOfReferenceUid = "1.2.3";
  s.seriesUid = "1.2.3.4";
  s.polygons[0].exclude = true;
  s.polygons[0].state = PolygonState::Interpolated;
  s.polygons[1].sopInstanceUid = "1.2.3.4.5";
  Polygon many;
  many.points_lps_mm = Eigen::Matrix3Xd::NullaryExpr(
      3, 500, [&](auto, auto) { return random.normal() * std::pow(10.0, random.uniform(-12, 5)); });
  many.points_lps_mm(0, 0) = 0.1;
  many.points_lps_mm(1, 0) = -0.0;
  many.points_lps_mm(2, 0) = 5e-324;
  s.polygons.push_back(many);
  Polygon draft = rectangle(grids()[2], 1, 2, 2, 9, 9);
  draft.points_lps_mm.conservativeResize(3, 1);
  draft.state = PolygonState::Draft;
  s.polygons.push_back(draft);
  return s;
}

TEST(ContourIo, RoundTripIsExact) {
  const glisson::test::TemporaryFolder folder;
  const ContourStack s = sample();
  writeContours(folder / "roi.json", s);
  const ContourStack back = readContours(folder / "roi.json");
  EXPECT_EQ(back.name, s.name);
  EXPECT_EQ(back.frameOfReferenceUid, s.frameOfReferenceUid);
  EXPECT_EQ(back.seriesUid, s.seriesUid);
  ASSERT_EQ(back.polygons.size(), s.polygons.size());
  for (std::size_t p = 0; p < s.polygons.size(); ++p) {
    EXPECT_EQ(back.polygons[p].points_lps_mm, s.polygons[p].points_lps_mm);
    EXPECT_EQ(back.polygons[p].exclude, s.polygons[p].exclude);
    EXPECT_EQ(back.polygons[p].state, s.polygons[p].state);
    EXPECT_EQ(back.polygons[p].sopInstanceUid, s.polygons[p].sopInstanceUid);
  }
  EXPECT_EQ(toJson(back), toJson(s));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);  // nothing left beside
}

std::string whyRefused(const std::string& text) {
  try {
    contoursFromJson(text, "roi.json");
  } catch (const BadInput& reason) {
    return reason.what();
  }
  return "";
}

TEST(ContourIo, RefusalsNameTheKey) {
  using testing::HasSubstr;
  const std::string head = R"({"schema":"glisson/contours/1","polygons":[)";
  EXPECT_THAT(whyRefused(R"({"schema":"glisson/contours/1","polygons":[],"vertices":1})"), HasSubstr("'vertices'"));
  EXPECT_THAT(whyRefused(head + R"({"points_lps_mm":[[0,0,0],[1,0,0],[0,1,0]],"colour":1}]})"),
              HasSubstr("polygons[0] has the unknown key 'colour'"));
  EXPECT_THAT(whyRefused(R"({"polygons":[]})"), HasSubstr("'schema'"));
  EXPECT_THAT(whyRefused(R"({"schema":"glisson/contours/2","polygons":[]})"), HasSubstr("glisson/contours/2"));
  EXPECT_THAT(whyRefused(R"({"schema":"glisson/contours/1"})"), HasSubstr("'polygons'"));
  EXPECT_THAT(whyRefused(head + R"({"points_lps_mm":[[0,0,0],[1,0,0]]}]})"), HasSubstr("2 vertices"));
  EXPECT_THAT(whyRefused(head + R"({"points_lps_mm":[[0,0],[1,0,0],[1,1,0]]}]})"), HasSubstr("vertex 0"));
  EXPECT_THAT(whyRefused(head + R"({"points_lps_mm":[[0,0,null],[1,0,0],[1,1,0]]}]})"), HasSubstr("vertex 0"));
  EXPECT_THAT(whyRefused(head + R"({"state":"final","points_lps_mm":[[0,0,0],[1,0,0],[1,1,0]]}]})"),
              HasSubstr("'final'"));
  EXPECT_THAT(whyRefused(head + R"({"exclude":1,"points_lps_mm":[[0,0,0],[1,0,0],[1,1,0]]}]})"),
              HasSubstr("'exclude'"));
  EXPECT_THAT(whyRefused("{\"schema\":\"glisson/contours/1\",\n\"polygons\":[}"), HasSubstr("line 2"));
  EXPECT_THAT(whyRefused(R"({"schema":"glisson/contours/1","polygons":[],"polygons":[]})"), HasSubstr("twice"));
  EXPECT_THAT(whyRefused(head + R"({"points_lps_mm":[[1e999,0,0],[1,0,0],[1,1,0]]}]})"), HasSubstr("JSON"));
  EXPECT_THAT(whyRefused(""), HasSubstr("JSON"));
  EXPECT_THAT(whyRefused("[1]"), HasSubstr("object"));
  EXPECT_THAT(whyRefused(std::string(100000, '[')), HasSubstr("JSON"));
}

TEST(ContourIo, FilesThatCannotBeReadOrWritten) {
  const glisson::test::TemporaryFolder folder;
  EXPECT_THROW(readContours(folder / "none.json"), BadInput);
  EXPECT_THROW(readContours(folder.path()), BadInput);
  EXPECT_THROW(writeContours(folder / "no-such-folder/x.json", sample()), BadInput);
  ContourStack nan = sample();
  nan.polygons[0].points_lps_mm(0, 0) = std::numeric_limits<double>::infinity();
  EXPECT_THROW(toJson(nan), BadArgument);
}

}  // namespace
}  // namespace glisson::roi
