// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "base/error.h"
#include "render/overlay.h"
#include "render/slice_plane.h"
#include "scene_fixture.h"
#include "support/support.h"

namespace glisson::render {
namespace {

const Eigen::Vector3i pixel(const Picture& p, int x, int y) {
  const std::uint8_t* at = p.rgb.data() + 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(p.width) +
                                               static_cast<std::size_t>(x));
  return {at[0], at[1], at[2]};
}

image::Grid plainGrid() {
  image::Grid grid;
  grid.size = {80, 60, 9};
  grid.spacing_mm = {1.0, 1.0, 3.0};
  grid.origin_lps_mm = {-40.0, -30.0, -12.0};
  return grid;
}

/// A bright box 40 × 30 mm of liver in black.
test::SceneForms box(const Eigen::Vector3d& mre, const Eigen::Vector3d& atlas) {
  const auto inside = [](const Eigen::Vector3d& p) { return std::abs(p.x()) < 20.1 && std::abs(p.y()) < 15.1; };
  return {inside, [=](const Eigen::Vector3d& p) { return inside(p) ? 100.0F : 0.0F; },
          [=](const Eigen::Vector3d&) { return mre; }, [=](const Eigen::Vector3d&) { return atlas; }};
}

TEST(SliceOverlay, equalFieldsArePurelyPurple) {
  RetractionScene scene = test::retractionScene(1.0, 64);
  const Picture p = sliceOverlay(scene, {.decorate = false});
  std::size_t green = 0, lit = 0;
  for (std::size_t n = 0; n < p.rgb.size(); n += 3) {
    ASSERT_EQ(p.rgb[n], p.rgb[n + 2]);
    green += p.rgb[n + 1] > 0 ? 1 : 0;
    lit += p.rgb[n] > 0 ? 1 : 0;
  }
  EXPECT_GT(lit, p.rgb.size() / 3 / 10);
  EXPECT_GT(green, 0U);
  const CountedPixels count = countChannels(p);
  EXPECT_EQ(count.redOnly + count.blueOnly, 0U);
  EXPECT_GT(count.both, 0U);
}

/// Green belongs to the grid alone: only pixels within a line's breadth of a multiple of the spacing have any.
TEST(SliceOverlay, greenIsTheGridAlone) {
  const RetractionScene scene = test::sceneFrom(plainGrid(), box({5, 0, 0}, {0, 0, 0}));
  const SlicePlane plane = planeOfSlice(scene.mri.grid, 4, 4);
  const Picture p = sliceOverlay(scene, {.slice = 4, .decorate = false});
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x) {
      const Eigen::Vector3d at = plane.toLps(x + 0.5, y + 0.5);
      const auto off = [](double v) { return std::abs(v - 10.0 * std::round(v / 10.0)); };
      const double nearest = std::min(off(at.x()), off(at.y()));
      if (nearest > 0.45) {
        ASSERT_EQ(pixel(p, x, y)[1], 0);
      } else if (nearest < 0.13) {
        ASSERT_GT(pixel(p, x, y)[1], 40);
      }
    }
}

/// MRE moved 5 mm to the patient's left: a red strip where atlas alone is, on the right of the patient (left of the
/// picture), and a blue strip of the same area on the other side.
TEST(SliceOverlay, translationGivesStripsOfItsArea) {
  const RetractionScene scene = test::sceneFrom(plainGrid(), box({5, 0, 0}, {0, 0, 0}));
  const Picture p = sliceOverlay(scene, {.slice = 4, .pixelsPerVoxel = 4, .decorate = false, .outlines = false});
  const CountedPixels count = countChannels(p, 100);
  // The mask holds 41 × 31 voxel centres: its level set ½ encloses 41 × 31 mm, 16 pixels a mm²; one row of pixels may
  // round either way along the edges.
  EXPECT_NEAR(static_cast<double>(count.redOnly), 5.0 * 31.0 * 16.0, 2.0 * 31.0 * 4.0);
  EXPECT_NEAR(static_cast<double>(count.blueOnly), 5.0 * 31.0 * 16.0, 2.0 * 31.0 * 4.0);
  EXPECT_NEAR(static_cast<double>(count.both), 36.0 * 31.0 * 16.0, 2.0 * (36.0 + 31.0) * 4.0);
  const SlicePlane plane = planeOfSlice(scene.mri.grid, 4, 4);
  const Eigen::Vector2d red = plane.toPixel({-18.0, 3.0, 0.0}), blue = plane.toPixel({23.0, 3.0, 0.0});
  EXPECT_LT(red.x(), blue.x()) << "patient right is on the left of the picture";
  EXPECT_EQ(pixel(p, static_cast<int>(red.x()), static_cast<int>(red.y())), Eigen::Vector3i(255, 0, 0));
  EXPECT_EQ(pixel(p, static_cast<int>(blue.x()), static_cast<int>(blue.y())), Eigen::Vector3i(0, 0, 255));
}

/// The colour-blind palette says the same with orange, blue and white.
TEST(SliceOverlay, colourBlindPalette) {
  const RetractionScene scene = test::sceneFrom(plainGrid(), box({5, 0, 0}, {0, 0, 0}));
  const Picture p = sliceOverlay(scene, {.slice = 4, .palette = Palette::ColourBlind, .decorate = false});
  const SlicePlane plane = planeOfSlice(scene.mri.grid, 4, 4);
  const auto at = [&](double x) {
    const Eigen::Vector2d q = plane.toPixel({x, 3.0, 0.0});
    return pixel(p, static_cast<int>(q.x()), static_cast<int>(q.y()));
  };
  EXPECT_EQ(at(-18.0), Eigen::Vector3i(255, 140, 0));
  EXPECT_EQ(at(23.0), Eigen::Vector3i(0, 115, 255));
  EXPECT_EQ(at(3.0), Eigen::Vector3i(255, 255, 255));
}

/// The letter F travels: on an oblique grid, with axes flipped and swapped, each voxel is lit where the display
/// convention puts its patient position: x grows to the right of the picture, y downwards.
TEST(SliceOverlay, letterFLandsWhereItShould) {
  const image::Mask letter = test::letterF();
  for (const int variant : {0, 1, 2, 3}) {
    // The same voxels in the same places, stored with i and j reversed or exchanged.
    image::Mask stored(letter.grid);
    const Eigen::Vector3i n = letter.grid.size;
    if (variant == 1 || variant == 2) {
      const int axis = variant - 1;
      stored.grid.direction.col(axis) *= -1.0;
      Eigen::Vector3d last = Eigen::Vector3d::Zero();
      last[axis] = n[axis] - 1;
      stored.grid.origin_lps_mm = letter.grid.indexToLps(last);
    } else if (variant == 3) {
      stored.grid.size = {n.y(), n.x(), n.z()};
      stored.grid.spacing_mm = {letter.grid.spacing_mm.y(), letter.grid.spacing_mm.x(), letter.grid.spacing_mm.z()};
      stored.grid.direction.col(0) = letter.grid.direction.col(1);
      stored.grid.direction.col(1) = letter.grid.direction.col(0);
    }
    RetractionScene scene;
    scene.mri = image::ScalarVolume(stored.grid);
    for (int k = 0; k < n.z(); ++k)
      for (int j = 0; j < n.y(); ++j)
        for (int i = 0; i < n.x(); ++i) {
          const Eigen::Vector3i to = variant == 1   ? Eigen::Vector3i(n.x() - 1 - i, j, k)
                                     : variant == 2 ? Eigen::Vector3i(i, n.y() - 1 - j, k)
                                     : variant == 3 ? Eigen::Vector3i(j, i, k)
                                                    : Eigen::Vector3i(i, j, k);
          stored.at(to) = letter.at(i, j, k);
          scene.mri.at(to) = 100.0F * static_cast<float>(letter.at(i, j, k));
        }
    scene.liver = stored;
    scene.u_mre_mm = scene.u_atlas_mm = image::DisplacementField(stored.grid, Eigen::Vector3f::Zero());
    const Picture p = sliceOverlay(scene, {.slice = 4, .pixelsPerVoxel = 6, .decorate = false});
    EXPECT_EQ(p.width, 20 * 6);
    EXPECT_EQ(p.height, std::lround(26 * 2.1 / 1.6 * 6));
    // Independent of planeOfSlice: columns by LPS x, rows by LPS y, from the picture's centre.
    const Eigen::Vector3d centre = letter.grid.indexToLps({9.5, 12.5, 4.0});
    for (int j = 0; j < n.y(); ++j)
      for (int i = 0; i < n.x(); ++i) {
        const Eigen::Vector3d d = letter.grid.indexToLps({1.0 * i, 1.0 * j, 4.0}) - centre;
        const double mmPerPixel = 1.6 / 6.0;
        const int x = static_cast<int>(p.width / 2.0 + d.dot(letter.grid.direction.col(0)) / mmPerPixel);
        const int y = static_cast<int>(p.height / 2.0 + d.dot(letter.grid.direction.col(1)) / mmPerPixel);
        EXPECT_EQ(pixel(p, x, y)[0] > 127, letter.at(i, j, 4) == 1)
            << "variant " << variant << " at " << i << ", " << j;
      }
  }
}

TEST(SlicePlane, radiologicalConvention) {
  image::Grid axial = plainGrid();
  SlicePlane plane = planeOfSlice(axial, 0, 2);
  EXPECT_EQ(plane.leftLetter + plane.rightLetter + plane.topLetter + plane.bottomLetter, "RLAP");
  image::Grid coronal = axial;
  coronal.direction.col(1) = -Eigen::Vector3d::UnitZ();
  coronal.direction.col(2) = Eigen::Vector3d::UnitY();
  plane = planeOfSlice(coronal, 0, 2);
  EXPECT_EQ(plane.leftLetter + plane.rightLetter + plane.topLetter + plane.bottomLetter, "RLSI");
  image::Grid sagittal = axial;
  sagittal.direction.col(0) = -Eigen::Vector3d::UnitY();
  sagittal.direction.col(1) = Eigen::Vector3d::UnitZ();
  sagittal.direction.col(2) = Eigen::Vector3d::UnitX();
  plane = planeOfSlice(sagittal, 0, 2);
  EXPECT_EQ(plane.leftLetter + plane.rightLetter + plane.topLetter + plane.bottomLetter, "APSI");
  EXPECT_THROW(planeOfSlice(axial, 9, 2), BadArgument);
  EXPECT_THROW(planeOfSlice(axial, -1, 2), BadArgument);
}

TEST(SliceOverlay, sliceOfLargestDifference) {
  RetractionScene scene = test::sceneFrom(plainGrid(), box({1, 0, 0}, {0, 0, 0}));
  scene.u_atlas_mm.at(40, 30, 6) = Eigen::Vector3f(0, 9, 0);
  EXPECT_EQ(sliceOfLargestDifference(scene), 6);
  scene.u_mre_mm.at(2, 2, 1) = Eigen::Vector3f(0, 90, 0);  // outside the liver: does not count
  EXPECT_EQ(sliceOfLargestDifference(scene), 6);
  // Of one answer: where it moves most.
  scene.compared = false;
  scene.u_mre_mm.at(40, 30, 4) = Eigen::Vector3f(0, 20, 0);
  scene.u_atlas_mm = scene.u_mre_mm;
  EXPECT_EQ(sliceOfLargestDifference(scene), 4);
}

/// An invalid run must not look like a valid one, decorated or not.
TEST(SliceOverlay, invalidIsMarked) {
  RetractionScene scene = test::sceneFrom(plainGrid(), box({5, 0, 0}, {0, 0, 0}));
  const Picture good = sliceOverlay(scene, {.decorate = false});
  scene.valid = false;
  const Picture marked = sliceOverlay(scene, {.decorate = false});
  std::size_t amber = 0;
  for (std::size_t n = 0; n < marked.rgb.size(); n += 3)
    amber += marked.rgb[n] > 240 && std::abs(marked.rgb[n + 1] - 176) < 12 && marked.rgb[n + 2] < 60 ? 1 : 0;
  EXPECT_GT(amber, marked.rgb.size() / 3 / 200);
  EXPECT_NE(good.rgb, marked.rgb);
}

TEST(SliceOverlay, sameBytesTwiceAndWithMargin) {
  const RetractionScene scene = test::retractionScene(1.5, 64);
  SliceOverlayOptions options{.zoomCentre_lps_mm = scene.retractorPoint_lps_mm, .margin_mm = 10.0};
  const Picture a = sliceOverlay(scene, options), b = sliceOverlay(scene, options);
  EXPECT_EQ(a.rgb, b.rgb);
  EXPECT_GT(a.width, a.height);
}

TEST(SliceOverlay, refusesWhatCannotBeDrawn) {
  RetractionScene scene = test::sceneFrom(plainGrid(), box({5, 0, 0}, {0, 0, 0}));
  EXPECT_THROW(sliceOverlay(scene, {.slice = 99}), BadArgument);
  EXPECT_THROW(sliceOverlay(scene, {.grid_mm = 0.0}), BadArgument);
  scene.liver.grid.origin_lps_mm.x() += 500.0;
  EXPECT_THROW(sliceOverlay(scene), BadInput);
}

}  // namespace
}  // namespace glisson::render
