// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "render/charts.h"
#include "render/colour_map.h"
#include "render/maps.h"
#include "scene_fixture.h"

namespace glisson::render {
namespace {

std::size_t countOf(const Picture& p, Rgb c) {
  std::size_t count = 0;
  for (std::size_t n = 0; n < p.rgb.size(); n += 3) count += Rgb{p.rgb[n], p.rgb[n + 1], p.rgb[n + 2]} == c ? 1 : 0;
  return count;
}

Rgb pixel(const Picture& p, int x, int y) {
  const auto n = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(p.width) + static_cast<std::size_t>(x));
  return {p.rgb[n], p.rgb[n + 1], p.rgb[n + 2]};
}

TEST(Numbers, quartilesOfKnownValues) {
  const BoxNumbers box = boxNumbers({7, 1, 5, 3, 9, 100});  // sorted 1 3 5 7 9 100
  EXPECT_DOUBLE_EQ(box.lowerQuartile, 3.5);
  EXPECT_DOUBLE_EQ(box.median, 6.0);
  EXPECT_DOUBLE_EQ(box.upperQuartile, 8.5);
  EXPECT_DOUBLE_EQ(box.lowWhisker, 1.0);
  EXPECT_DOUBLE_EQ(box.highWhisker, 9.0);
  EXPECT_EQ(box.outliers, std::vector<double>{100.0});
  EXPECT_THROW(boxNumbers({}), BadArgument);
}

TEST(Numbers, everyValueHasOneBin) {
  const Bins bins = binned({-0.2, 0.0, 0.49, 0.5, 1.99, 2.0}, 0.5);
  EXPECT_DOUBLE_EQ(bins.start, -0.5);
  EXPECT_EQ(bins.counts, (std::vector<std::size_t>{1, 2, 1, 0, 1, 1}));
  EXPECT_THROW(binned({1.0}, 0.0), BadArgument);
  EXPECT_THROW(binned({0.0, 1e9}, 1e-3), BadArgument);
}

/// No point of the front is beaten; every point off it is.
TEST(Numbers, paretoFrontBeatsTheRest) {
  const std::vector<double> x{5, 1, 3, 2, 4, 1, 3}, y{1, 9, 4, 4, 5, 9, 2};
  const std::vector<std::size_t> front = paretoFront(x, y);
  EXPECT_EQ(front, (std::vector<std::size_t>{1, 5, 3, 6, 0}));
}

TEST(Charts, boxPlotShowsItsLinesInTheirColours) {
  const Rgb magenta{200, 0, 160}, orange{230, 126, 0};
  BoxPlot chart;
  chart.title = "difference";
  chart.y.title = "Difference (mm)";
  chart.boxes = {{"whole liver", {0.4, 0.9, 1.2, 1.5}}, {"at the retractor", {2.0, 5.0, 7.0, 8.0}}};
  chart.lines = {{1.64, "one voxel", magenta}, {5.0, "significant", orange}};
  const Picture p = draw(chart);
  EXPECT_GT(countOf(p, magenta), 1000U);
  EXPECT_GT(countOf(p, orange), 1000U);
  EXPECT_EQ(draw(chart).rgb, p.rgb);
}

TEST(Charts, svgHoldsTitlesEscaped) {
  XyChart chart;
  chart.title = "error < 1 % & fast";
  chart.x.title = "Run time (ms)";
  chart.y.title = "Error (mm)";
  chart.x.logarithmic = chart.y.logarithmic = true;
  chart.series.resize(1);
  chart.series[0].x = {1, 10, 100};
  chart.series[0].y = {1, 0.1, 0.01};
  chart.paretoFront = true;
  const std::string text = svg(chart);
  EXPECT_NE(text.find("error &lt; 1 % &amp; fast"), std::string::npos);
  EXPECT_NE(text.find("Run time (ms)"), std::string::npos);
  EXPECT_NE(text.find("Research use only"), std::string::npos);
  EXPECT_TRUE(text.ends_with("</svg>\n"));
}

/// On log-log axes a power law is a straight line: its points lie on one line of the SVG.
TEST(Charts, powerLawIsStraight) {
  XyChart chart;
  chart.x.logarithmic = chart.y.logarithmic = true;
  chart.series.resize(1);
  chart.series[0].x = {1, 7, 100};
  chart.series[0].y = {1, std::pow(7.0, -1.5), 1e-3};
  chart.series[0].joined = false;
  const std::string text = svg(chart);
  std::vector<Point> centres;
  for (std::size_t at = text.find("<circle"); at != std::string::npos; at = text.find("<circle", at + 1))
    centres.emplace_back(std::stod(text.substr(text.find("cx=\"", at) + 4)),
                         std::stod(text.substr(text.find("cy=\"", at) + 4)));
  ASSERT_EQ(centres.size(), 4U);  // three and the legend
  const Point a = centres[1] - centres[0], b = centres[2] - centres[0];
  EXPECT_NEAR(a.x() * b.y() - a.y() * b.x(), 0.0, 1e-2 * a.norm() * b.norm());
  EXPECT_NEAR(a.x() / b.x(), std::log(7.0) / std::log(100.0), 1e-2);
}

TEST(Charts, tellWhichColumnAPixelIsIn) {
  Histogram chart;
  chart.values = {0.2, 0.3, 1.6, 1.7, 1.8};
  const ChartSize size{800, 600};
  const Picture picture = draw(chart, size);
  // Whatever is coloured like a bar is in a column, and in the right one: the first bar is left of the second.
  std::size_t first = 0, second = 0;
  for (int y = 0; y < size.height; y += 3)
    for (int x = 0; x < size.width; x += 3) {
      if (pixel(picture, x, y) != Rgb{86, 150, 205}) continue;
      const auto column = columnAt(chart, {x + 0.5, y + 0.5}, size);
      ASSERT_TRUE(column) << x << ", " << y;
      EXPECT_DOUBLE_EQ(column->high - column->low, 0.5);
      ++(column->low == 0.0 ? first : second);
      EXPECT_TRUE(column->low == 0.0 || column->low == 1.5);
    }
  EXPECT_GT(first, 100U);
  EXPECT_GT(second, first);
  EXPECT_FALSE(columnAt(chart, {2.0, 2.0}, size));
}

TEST(Charts, tellTheValueAtAHeightOfABox) {
  BoxPlot chart;
  chart.boxes = {{"a", {1.0, 2.0, 3.0}}, {"b", {11.0, 12.0, 30.0, 11.5, 12.5}}};
  const ChartSize size{900, 600};
  // The outlier is in the second half.
  bool seen = false;
  for (double y = 0.5; y < size.height; y += 0.5) {
    const auto place = placeAt(chart, {640.0, y}, size);
    if (!place || place->value > 31.0 || place->value < 29.0) continue;
    EXPECT_EQ(place->box, 1U);
    seen = true;
  }
  EXPECT_TRUE(seen);
  const auto low = placeAt(chart, {250.0, 400.0}, size), high = placeAt(chart, {250.0, 200.0}, size);
  ASSERT_TRUE(low && high);
  EXPECT_EQ(low->box, 0U);
  EXPECT_GT(high->value, low->value + 5.0);
  EXPECT_FALSE(placeAt(chart, {5.0, 300.0}, size));
}

TEST(Charts, refuseWhatCannotBeDrawn) {
  const Histogram histogram;
  EXPECT_THROW(draw(histogram), BadArgument);
  const BoxPlot boxes;
  EXPECT_THROW(draw(boxes), BadArgument);
  XyChart chart;
  EXPECT_THROW(draw(chart), BadArgument);
  chart.series.resize(1);
  chart.series[0].x = {1, 2};
  chart.series[0].y = {1};
  EXPECT_THROW(draw(chart), BadArgument) << "unequal lengths";
  chart.x.logarithmic = true;
  chart.series[0].x = {-1};
  EXPECT_THROW(draw(chart), BadArgument) << "nothing above zero";
}

/// Lightness (CIE L*) grows with the value: order survives grey printing.
TEST(ColourMaps, lightnessGrows) {
  const auto lightness = [](Rgb c) {
    const auto linear = [](double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); };
    return std::cbrt(0.2126 * linear(c.r / 255.0) + 0.7152 * linear(c.g / 255.0) + 0.0722 * linear(c.b / 255.0));
  };
  for (const ColourMap& map : {ColourMap::viridis(), ColourMap::magma()})
    for (int n = 0; n < 50; ++n) EXPECT_LT(lightness(map.at(n / 50.0)), lightness(map.at((n + 1) / 50.0)));
}

image::Grid mapGrid() {
  image::Grid grid;
  grid.size = {20, 16, 3};
  grid.spacing_mm = {2, 2, 10};
  grid.origin_lps_mm = {-19, -15, -10};
  return grid;
}

/// A voxel's colour is that of its value; voxels of low confidence, and only those, are hatched.
TEST(Maps, stiffnessIsReadBack) {
  image::ScalarVolume map(mapGrid()), confidence(mapGrid(), 1.0F);
  for (int j = 0; j < 16; ++j)
    for (int i = 0; i < 20; ++i) {
      map.at(i, j, 1) = 0.4F * static_cast<float>(i);
      if (j >= 8) confidence.at(i, j, 1) = 0.9F;
    }
  const Picture p = stiffnessPicture(map, "µ (kPa)", nullptr, &confidence, {.pixelsPerVoxel = 10, .decorate = false});
  ASSERT_EQ(p.width, 200);
  const Rgb hatch{235, 235, 235};
  std::size_t above = 0, below = 0;
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x) {
      const Rgb c = pixel(p, x, y);
      if (c == hatch)
        ++(y < 80 ? above : below);
      else
        ASSERT_EQ(c, ColourMap::viridis().at(static_cast<double>(0.4F * static_cast<float>(x / 10)) / 8.0));
    }
  EXPECT_EQ(above, 0U);
  EXPECT_NEAR(static_cast<double>(below), 2.0 / 12.0 * 200 * 80, 0.02 * 200 * 80);
  EXPECT_THROW(stiffnessPicture(map, "µ", nullptr, nullptr, {.low = 1.0, .high = 1.0}), BadArgument);
}

TEST(Maps, roiOutlineLiesOnItsSliceOnly) {
  roi::ContourStack contours;
  roi::Polygon square;
  square.points_lps_mm.resize(3, 4);
  square.points_lps_mm << -10, 10, 10, -10, -8, -8, 8, 8, 0, 0, 0, 0;
  contours.polygons = {square};
  image::ScalarVolume mri(mapGrid());
  for (std::size_t n = 0; n < mri.values.size(); ++n) mri.values[n] = static_cast<float>(n % 7);
  const Picture on = roiPicture(mri, contours, {.slice = 1, .pixelsPerVoxel = 8, .decorate = false});
  const Picture off = roiPicture(mri, contours, {.slice = 2, .pixelsPerVoxel = 8, .decorate = false});
  // The pictures are grey but for the outline; the edge y = −8 mm is (−8 + 16) / 0.25 pixels down, x = 10 mm 120
  // across.
  const auto colourful = [](const Picture& p, int x, int y) { return pixel(p, x, y).r - pixel(p, x, y).b > 100; };
  EXPECT_TRUE(colourful(on, 80, 32));
  EXPECT_TRUE(colourful(on, 120, 60));
  EXPECT_FALSE(colourful(on, 80, 60));
  for (int y = 0; y < off.height; ++y)
    for (int x = 0; x < off.width; ++x) ASSERT_FALSE(colourful(off, x, y));
}

/// A difference that grows linearly across the liver crosses 5 mm on a straight line where it should.
TEST(Maps, isolineLiesAtFiveMillimetres) {
  image::Grid grid;
  grid.size = {60, 40, 3};
  grid.spacing_mm = {1, 1, 5};
  grid.origin_lps_mm = {0, 0, 0};
  const test::SceneForms forms{[](const auto&) { return true; },
                               [](const auto& p) { return static_cast<float>(p.y()); },
                               [](const auto& p) { return Eigen::Vector3d(0.0, 0.2 * p.x() + 0.001, 0.0); },
                               [](const auto&) { return Eigen::Vector3d(0.0, 0.001, 0.0); }};
  const Picture p = differencePicture(test::sceneFrom(grid, forms),
                                      {.slice = 1, .pixelsPerVoxel = 4, .high = 12.0, .decorate = false});
  for (int y = 8; y < p.height - 8; ++y)
    for (int x = 8; x < p.width - 8; ++x) {
      const double d = 0.2 * ((x + 0.5) / 4.0 - 0.5);
      if (std::abs(d - 5.0) < 0.02) {
        ASSERT_EQ(pixel(p, x, y), (Rgb{90, 235, 255}));
      } else if (std::abs(d - 5.0) > 0.12) {
        ASSERT_LT(std::abs(pixel(p, x, y).g - ColourMap::magma().at(d / 12.0).g), 3);
      }
    }
}

}  // namespace
}  // namespace glisson::render
