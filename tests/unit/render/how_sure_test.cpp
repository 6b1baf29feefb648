// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/how_sure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "render/charts.h"
#include "render/colour_map.h"
#include "render/maps.h"
#include "scene_fixture.h"

namespace glisson::render {
namespace {

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
constexpr Rgb cause{86, 150, 205}, together{90, 98, 110};

std::size_t countOf(const Picture& p, Rgb c) {
  std::size_t count = 0;
  for (std::size_t n = 0; n < p.rgb.size(); n += 3) count += Rgb{p.rgb[n], p.rgb[n + 1], p.rgb[n + 2]} == c ? 1 : 0;
  return count;
}

Rgb pixel(const Picture& p, int x, int y) {
  const auto n = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(p.width) + static_cast<std::size_t>(x));
  return {p.rgb[n], p.rgb[n + 1], p.rgb[n + 2]};
}

Tornado withBar(double low, double high, bool sum) {
  Tornado chart;
  chart.title = "What it depends on";
  chart.x = {.title = "mm", .low = 0.0, .high = 10.0};
  chart.here = 5.0;
  chart.bars = {{"first", low, high, "± 1 mm", sum}};
  return chart;
}

TEST(Tornado, aBarIsAsLongAsItsRangeAndTheSumHasAColourOfItsOwn) {
  const auto blue = static_cast<double>(countOf(draw(withBar(4.0, 6.0, false)), cause));
  ASSERT_GT(blue, 1000.0);
  // The black line through the number covers the same of each.
  const double twice = static_cast<double>(countOf(draw(withBar(3.0, 7.0, false)), cause)),
               thrice = static_cast<double>(countOf(draw(withBar(2.0, 8.0, false)), cause));
  EXPECT_NEAR((thrice - twice) / (twice - blue), 1.0, 0.02);
  const Picture sum = draw(withBar(4.0, 6.0, true));
  EXPECT_EQ(countOf(sum, cause), 0U);
  EXPECT_GT(countOf(sum, together), 1000U);
}

TEST(Tornado, germanNumbersHaveACommaAndBadBarsAreRefused) {
  Tornado chart = withBar(4.0, 6.0, false);
  chart.x.high = 2.0;
  chart.here = 1.0;
  chart.bars = {{"first", 0.5, 1.5, "", false}};
  EXPECT_NE(svg(chart).find(">0.5<"), std::string::npos);
  chart.x.language = Language::German;
  EXPECT_NE(svg(chart).find(">0,5<"), std::string::npos);
  EXPECT_NE(svg(chart).find(phrase(researchUseOnly, Language::German)), std::string::npos);
  EXPECT_THROW(draw(withBar(6.0, 4.0, false)), BadArgument);
  chart.bars.clear();
  EXPECT_THROW(draw(chart), BadArgument);
}

TEST(HowSure, aFieldIsReadWhereItIsKnownOnly) {
  image::Grid grid;
  grid.size = {3, 1, 1};
  image::ScalarVolume field(grid, unknown);
  field.at(0, 0, 0) = 1.0F;
  field.at(1, 0, 0) = 3.0F;
  EXPECT_FLOAT_EQ(sampleKnown(field, {0.25, 0, 0}), 1.5F);
  EXPECT_FLOAT_EQ(sampleKnown(field, {1.6, 0, 0}), 3.0F);  // its neighbour says nothing
  EXPECT_FLOAT_EQ(sampleKnown(field, {-0.4, 0, 0}), 1.0F);
  EXPECT_TRUE(std::isnan(sampleKnown(field, {2.0, 0, 0})));
  EXPECT_TRUE(std::isnan(sampleKnown(field, {5.0, 0, 0})));
}

/// A probability that grows linearly across the liver has its half on a straight line where it should.
TEST(HowSure, theMapShowsEveryProbabilityInItsColourAndTheLineOfOneHalf) {
  image::Grid grid;
  grid.size = {60, 40, 3};
  grid.spacing_mm = {1, 1, 5};
  const test::SceneForms forms{[](const auto& p) { return p.y() > 15; },
                               [](const auto& p) { return static_cast<float>(p.y()); },
                               [](const auto&) { return Eigen::Vector3d(0.0, 0.1, 0.0); },
                               [](const auto&) { return Eigen::Vector3d(0.0, 0.2, 0.0); }};
  RetractionScene scene = test::sceneFrom(grid, forms);
  const MapOptions options{.slice = 1, .pixelsPerVoxel = 4, .decorate = false};
  EXPECT_THROW(probabilityPicture(scene, options), BadArgument);
  scene.sure.emplace();
  EXPECT_THROW(probabilityPicture(scene, options), BadArgument);
  scene.sure->beyond = image::ScalarVolume(grid);
  for (int i = 0; i < 60; ++i)
    for (int j = 0; j < 40; ++j)
      for (int k = 0; k < 3; ++k) scene.sure->beyond.at(i, j, k) = static_cast<float>(i) / 60.0F;
  const Picture p = probabilityPicture(scene, options);
  for (int x = 8; x < p.width - 8; ++x) {
    const double probability = ((x + 0.5) / 4.0 - 0.5) / 60.0;
    for (int y = 8; y < 48; ++y) ASSERT_EQ(pixel(p, x, y).r, pixel(p, x, y).b);  // outside the liver: grey
    for (int y = 80; y < p.height - 8; ++y)
      if (std::abs(probability - 0.5) < 0.001) {
        ASSERT_EQ(pixel(p, x, y), (Rgb{90, 235, 255}));
      } else if (std::abs(probability - 0.5) > 0.01) {
        ASSERT_LT(std::abs(pixel(p, x, y).g - ColourMap::magma().at(probability).g), 3);
      }
  }
}

TEST(HowSure, theScaleOfTheVesselsHoldsNearlyAllOfThem) {
  HowSure sure;
  EXPECT_EQ(placeScale_mm(sure), 1.0);
  sure.vessel95_mm = Eigen::VectorXf::LinSpaced(1000, 0.0F, 3.5F);
  EXPECT_EQ(placeScale_mm(sure), 4.0);
}

/// One vessel with a tube round it, twice as thick: more of the picture is covered, and nothing is drawn without one.
TEST(HowSure3D, theTubeIsSeenRoundTheVesselWhereTheAnswerPutsIt) {
  RetractionScene scene = test::retractionScene(1.6, 64);
  const SceneOptions3D options{
      .shown = Shown3D::HowSure, .view = View3D::Anterior, .width = 480, .height = 360, .decorate = false};
  try {
    EXPECT_THROW(overlay3D(scene, options), BadArgument);
    scene.sure.emplace();
    scene.sure->vessel95_mm = Eigen::VectorXf::LinSpaced(scene.vesselSurface.vertices_lps_mm.cols(), 0.0F, 6.0F);
    const Picture bare = overlay3D(scene, options);
    test::appendTube(scene.sure->tube, {-60, 0, -30}, {-60, 0, 30}, 12.0, 12.0);
    const Picture tube = overlay3D(scene, options);
    EXPECT_NE(bare.rgb, tube.rgb);
    EXPECT_EQ(tube.rgb, overlay3D(scene, options).rgb);
  } catch (const RenderUnavailable& e) {
    GTEST_SKIP() << e.what();
  }
}

}  // namespace
}  // namespace glisson::render
