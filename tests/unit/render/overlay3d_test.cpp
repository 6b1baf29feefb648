// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cstdlib>

#include "base/error.h"
#include "render/overlays3d.h"
#include "scene_fixture.h"

namespace glisson::render {
namespace {

/// Every test here draws with no display at all.
class Overlay3D : public ::testing::Test {
 protected:
  void SetUp() override {
    unsetenv("DISPLAY");
    unsetenv("WAYLAND_DISPLAY");
  }
  void TearDown() override { setRenderBackend(RenderBackend::Auto); }
};

struct Found {
  std::size_t count = 0;
  double x = 0.0, y = 0.0;  ///< mean position, pixels
};
template <typename Is>
Found find(const Picture& p, Is&& is) {
  Found f;
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x) {
      const std::uint8_t* at = p.rgb.data() + 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(p.width) +
                                                   static_cast<std::size_t>(x));
      if (!is(int{at[0]}, int{at[1]}, int{at[2]})) continue;
      ++f.count;
      f.x += x;
      f.y += y;
    }
  if (f.count > 0) {
    f.x /= static_cast<double>(f.count);
    f.y /= static_cast<double>(f.count);
  }
  return f;
}
bool isBlue(int r, int g, int b) {
  return b > 110 && b > 1.8 * r && b > 1.6 * g;
}
bool isRed(int r, int g, int b) {
  return r > 110 && r > 2.2 * b && r > 2.2 * g;
}
bool isPurple(int r, int g, int b) {
  return r > 90 && b > 110 && g < 0.6 * r && b < 1.9 * r;
}

/// A straight vertical vessel in a slab of liver; MRE carries it 20 mm to the patient's left, atlas leaves it at rest.
RetractionScene shifted(const Eigen::Vector3d& mre_mm) {
  image::Grid grid;
  grid.size = {40, 20, 40};
  grid.spacing_mm = {4, 4, 4};
  grid.origin_lps_mm = {-78, -38, -78};
  const test::SceneForms forms{[](const auto& p) { return p.cwiseAbs().maxCoeff() < 36.0; },
                               [](const auto&) { return 100.0F; }, [=](const auto&) { return mre_mm; },
                               [](const auto&) { return Eigen::Vector3d(0.0, 0.0, 1e-6); }};
  RetractionScene scene = test::sceneFrom(grid, forms);
  test::appendTube(scene.vesselSurface, {0, 0, -28}, {0, 0, 28}, 4.0, 4.0);
  return scene;
}

const SceneOptions3D anterior{.view = View3D::Anterior, .width = 480, .height = 360, .decorate = false};

TEST_F(Overlay3D, eachColourIsWhereItsModelPutsTheVessel) {
  const Picture p = overlay3D(shifted({20, 0, 0}), anterior);
  ASSERT_EQ(p.width, 480);
  ASSERT_EQ(p.height, 360);
  const Found blue = find(p, isBlue), red = find(p, isRed);
  EXPECT_GT(blue.count, 500U);
  EXPECT_GT(red.count, 500U);
  EXPECT_GT(blue.x, red.x + 10.0) << "seen from anterior, the patient's left is on the right";
  EXPECT_NEAR(blue.y, red.y, 4.0);
  EXPECT_NEAR(static_cast<double>(blue.count), static_cast<double>(red.count), 0.2 * static_cast<double>(red.count));
}

TEST_F(Overlay3D, upIsSuperior) {
  const Picture p = overlay3D(shifted({0, 0, 25}), anterior);
  // The moved vessel sticks out above (blue only there), the one at rest below.
  EXPECT_LT(find(p, isBlue).y, find(p, isRed).y);
}

TEST_F(Overlay3D, equalFieldsArePurple) {
  const Picture p = overlay3D(shifted({0, 0, 1e-6}), anterior);
  EXPECT_EQ(find(p, isBlue).count, 0U);
  EXPECT_EQ(find(p, isRed).count, 0U);
  EXPECT_GT(find(p, isPurple).count, 500U);
}

TEST_F(Overlay3D, atRestNothingHasMoved) {
  SceneOptions3D options = anterior;
  options.t = 0.0;
  const Picture p = overlay3D(shifted({20, 0, 0}), options);
  EXPECT_EQ(find(p, isBlue).count, 0U);
  EXPECT_GT(find(p, isPurple).count, 500U);
}

TEST_F(Overlay3D, wholeSceneTwiceGivesTheSameBytes) {
  const RetractionScene scene = test::retractionScene(1.6, 64);
  for (const View3D view : {View3D::Anterior, View3D::Inferior, View3D::Oblique}) {
    const SceneOptions3D options{.view = view, .width = 400, .height = 300};
    const Picture a = overlay3D(scene, options), b = overlay3D(scene, options);
    EXPECT_EQ(a.rgb, b.rgb);
    EXPECT_GT(find(a, [](int r, int g, int bl) { return g > 100 && g > 1.6 * r && g > 1.3 * bl; }).count, 300U)
        << "green grid";
    EXPECT_GT(find(a, isBlue).count, 100U);
    EXPECT_GT(find(a, isRed).count, 100U);
  }
}

TEST_F(Overlay3D, severalAreThoseDrawnAlone) {
  const RetractionScene scene = test::retractionScene(1.6, 64);
  const std::vector<SceneOptions3D> options = {{.view = View3D::Anterior, .width = 400, .height = 300},
                                               {.view = View3D::Oblique, .width = 300, .height = 340, .arrows = true},
                                               {.view = View3D::Anterior, .width = 400, .height = 300}};
  std::vector<Picture> drawn;
  overlays3D(scene, options, [&](std::size_t n, const Picture& picture) {
    EXPECT_EQ(n, drawn.size());
    drawn.push_back(picture);
  });
  ASSERT_EQ(drawn.size(), options.size());
  for (std::size_t n = 0; n < options.size(); ++n) EXPECT_EQ(drawn[n].rgb, overlay3D(scene, options[n]).rgb) << n;
  EXPECT_NE(drawn[0].rgb, drawn[1].rgb);
  int taken = 0;
  EXPECT_THROW(overlays3D(scene, options,
                          [&](std::size_t, const Picture&) {
                            ++taken;
                            throw BadInput("the disk is full");
                          }),
               BadInput);
  EXPECT_EQ(taken, 1);
}

TEST_F(Overlay3D, invalidIsMarked) {
  RetractionScene scene = shifted({20, 0, 0});
  scene.valid = false;
  const auto amber = [](int r, int g, int b) { return r > 220 && g > 140 && g < 200 && b < 90; };
  EXPECT_GT(find(overlay3D(scene, anterior), amber).count, 1000U);
  scene.valid = true;
  EXPECT_EQ(find(overlay3D(scene, anterior), amber).count, 0U);
}

TEST_F(Overlay3D, saysWhyItCannotDraw) {
  setRenderBackend(RenderBackend::X11);
  try {
    overlay3D(shifted({20, 0, 0}), anterior);
    FAIL() << "there is no display";
  } catch (const RenderUnavailable& e) {
    EXPECT_NE(std::string(e.what()).find("DISPLAY is not set"), std::string::npos) << e.what();
  }
  setRenderBackend(RenderBackend::Auto);
  EXPECT_THROW(overlay3D(RetractionScene{shifted({1, 0, 0})}, {.width = 3}), BadArgument);
  RetractionScene empty = shifted({1, 0, 0});
  empty.vesselSurface = {};
  EXPECT_THROW(overlay3D(empty, anterior), BadInput);
}

TEST_F(Overlay3D, nothingOnStandardError) {
  ::testing::internal::CaptureStderr();
  overlay3D(test::retractionScene(1.6, 64), {.width = 400, .height = 300});
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace glisson::render
