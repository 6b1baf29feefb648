// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <fstream>

#include "base/error.h"
#include "render/font.h"
#include "render/painter.h"
#include "support/support.h"

namespace glisson::render {
namespace {

std::uint32_t bigEndian(const std::uint8_t* p) {
  return (std::uint32_t{p[0]} << 24) | (std::uint32_t{p[1]} << 16) | (std::uint32_t{p[2]} << 8) | p[3];
}

TEST(Png, holdsSizeAndResolution) {
  const std::vector<std::uint8_t> png = encodePng(blankPicture(37, 21, {10, 20, 30}), 300.0);
  ASSERT_GT(png.size(), 60U);
  EXPECT_EQ(std::memcmp(png.data(), "\x89PNG\r\n\x1a\n", 8), 0);
  EXPECT_EQ(bigEndian(png.data() + 16), 37U);
  EXPECT_EQ(bigEndian(png.data() + 20), 21U);
  EXPECT_EQ(std::memcmp(png.data() + 37, "pHYs", 4), 0);
  EXPECT_EQ(bigEndian(png.data() + 41), 11811U);  // 300 / 0.0254
  EXPECT_EQ(png[49], 1U);
  // CRC of this very chunk as published tools compute it for 300 dpi.
  EXPECT_EQ(bigEndian(png.data() + 50), 0x78a53f76U);
}

TEST(Png, writesOrSaysWhyNot) {
  const test::TemporaryFolder folder;
  const Picture p = blankPicture(4, 3, {1, 2, 3});
  writePng(folder / "a.png", p);
  EXPECT_GT(std::filesystem::file_size(folder / "a.png"), 60U);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.png.part"));
  EXPECT_THROW(writePng(folder.path() / "missing" / "a.png", p), BadInput);
  EXPECT_THROW(encodePng(Picture{}), BadArgument);
  EXPECT_THROW(encodePng(p, 0.0), BadArgument);
}

TEST(Font, widthMatchesInkAndUnknownBytesDoNotStop) {
  const TextMask mask = rasterText("Young's modulus E (kPa) µ ≥ 2·10⁻³", {.size_px = 40.0});
  EXPECT_NEAR(mask.width, textWidth("Young's modulus E (kPa) µ ≥ 2·10⁻³", 40.0), 6.0);
  EXPECT_GT(mask.height, 35);
  EXPECT_NO_THROW(rasterText("\xff\xfe broken \xc3", {.size_px = 20.0}));
  EXPECT_EQ(rasterText("", {}).width, 0);
}

/// Turned a quarter, the ink of a word is as high as it was wide.
TEST(Font, turns) {
  const TextMask flat = rasterText("overlay", {.size_px = 30.0});
  const TextMask upright = rasterText("overlay", {.size_px = 30.0, .angle_deg = 90.0});
  EXPECT_NEAR(upright.height, flat.width, 1);
  EXPECT_NEAR(upright.width, flat.height, 1);
  EXPECT_LT(upright.top, -flat.width / 2);
}

/// Coverage of a polygon adds up to its area, wherever it lies between pixels.
TEST(Painter, polygonAreaIsKept) {
  Picture p = blankPicture(60, 50, {0, 0, 0});
  RasterPainter(p).polygon({{10.25, 8.5}, {40.75, 12.25}, {22.5, 40.0}}, {255, 255, 255});
  double sum = 0.0;
  for (std::size_t n = 0; n < p.rgb.size(); n += 3) sum += p.rgb[n] / 255.0;
  const double area = 0.5 * std::abs((40.75 - 10.25) * (40.0 - 8.5) - (22.5 - 10.25) * (12.25 - 8.5));
  EXPECT_NEAR(sum, area, 0.01 * area);
}

TEST(Painter, lineCoversLengthTimesWidth) {
  Picture p = blankPicture(100, 80, {0, 0, 0});
  RasterPainter(p).line({10, 12}, {88, 63}, {.colour = {255, 255, 255}, .width = 4.0});
  double sum = 0.0;
  for (std::size_t n = 0; n < p.rgb.size(); n += 3) sum += p.rgb[n] / 255.0;
  const double area = 4.0 * std::hypot(78.0, 51.0) + 3.14159 * 4.0;  // round ends
  EXPECT_NEAR(sum, area, 0.02 * area);
}

/// Dashes run on around corners: an outline of many short pieces is inked for the same share as one long line.
TEST(Painter, dashesRunOnAroundCorners) {
  std::vector<Point> pieces;
  for (int n = 0; n <= 300; ++n) pieces.emplace_back(10.0 + n, 20.5);
  const auto ink = [](const std::vector<Point>& points) {
    Picture p = blankPicture(320, 40, {0, 0, 0});
    RasterPainter(p).polyline(points, {.colour = {255, 255, 255}, .width = 2.0, .dashed = true});
    return std::count(p.rgb.begin() + 3L * 320 * 20, p.rgb.begin() + 3L * 320 * 21, std::uint8_t{255}) / 3;
  };
  const auto one = ink({pieces.front(), pieces.back()}), many = ink(pieces);
  EXPECT_NEAR(static_cast<double>(many), static_cast<double>(one), 12.0);
  EXPECT_LT(one, 260);
}

}  // namespace
}  // namespace glisson::render
