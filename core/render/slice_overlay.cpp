// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/error.h"
#include "render/arrows.h"
#include "render/detail/slice_composer.h"
#include "render/overlay.h"
#include "render/painter.h"
#include "render/slice_frame.h"

namespace glisson::render {
namespace {

using detail::SliceComposer;

std::string formatted(const char* pattern, double a, double b = 0.0) {
  char text[160];
  std::snprintf(text, sizeof text, pattern, a, b);
  return text;
}

/// A straight arrow with a dark edge.
void paintArrow(Painter& painter, const Point& from, const Point& to, Rgb colour, double width) {
  const double length = (to - from).norm();
  if (length < 1.0) return;
  const Point along = (to - from) / length, aside(-along.y(), along.x());
  const double back = std::min(5.0 * width, 0.5 * length);
  for (const auto& [paint, thick] : {std::pair{Rgb{0, 0, 0}, width + 1.6}, {colour, width}}) {
    const Stroke stroke{.colour = paint, .width = thick, .alpha = 0.95};
    painter.line(from, to, stroke);
    painter.line(to, to - back * along + 0.55 * back * aside, stroke);
    painter.line(to, to - back * along - 0.55 * back * aside, stroke);
  }
}

/// Displacements in the plane of the slice and an arrow of 10 mm to compare them with.
void paintArrows(Picture& picture, const SlicePlane& plane, const std::vector<DisplacementArrow>& arrows, Rgb mre,
                 Rgb atlas) {
  RasterPainter painter(picture);
  const double width = std::max(1.4, std::min(picture.width, picture.height) / 420.0);
  for (const DisplacementArrow& a : arrows) {
    paintArrow(painter, plane.toPixel(a.rest), plane.toPixel(a.atlas), atlas, width);
    paintArrow(painter, plane.toPixel(a.rest), plane.toPixel(a.mre), mre, width);
  }
  const double size = frameFontSize(picture), length = 10.0 / plane.mmPerPixel;
  // In the upper left corner: the scale bar is in the lower one.
  const Point from(0.9 * size, 2.3 * size);
  painter.rectangle(0.3 * size, 0.3 * size, from.x() + std::max(length, 8.6 * size) + 0.6 * size, 3.0 * size, {0, 0, 0},
                    0.6);
  painter.text(from - Point(0.0, 0.75 * size), "moved by 10 mm", {.size_px = size, .colour = colours::light});
  paintArrow(painter, from, from + Point(length, 0.0), colours::light, width);
}

/// Both answers and where they agree, or the one that there is: both channels together.
std::vector<LegendItem> legendOf(const RetractionScene& scene, bool redBlue) {
  const Rgb both = redBlue ? Rgb{214, 40, 255} : Rgb{255, 255, 255};
  if (!scene.compared) return {{both, scene.stiffness + " stiffness"}};
  return {{redBlue ? Rgb{40, 60, 255} : Rgb{0, 115, 255}, scene.stiffness},
          {redBlue ? Rgb{255, 30, 30} : Rgb{255, 140, 0}, "Atlas"},
          {both, "agree"}};
}

std::string largestInSlice(const SliceComposer& composer, const RetractionScene& scene, int k) {
  const double largest_mm = composer.largestSeen_mm(k);
  if (!scene.compared) return formatted(". Largest displacement of the liver seen here: %.1f mm.", largest_mm);
  return ". Largest " + scene.stiffness +
         formatted("-atlas difference of the liver seen here: %.1f mm (clinically significant: %g mm).", largest_mm,
                   scene.clinicallySignificant_mm);
}

Picture overlayOf(const SliceComposer& composer, const RetractionScene& scene, const SliceOverlayOptions& options) {
  if (!(options.grid_mm > 0.0) || !(options.zoom_mm > 0.0))
    throw BadArgument("grid spacing and zoom width must be positive millimetres");
  const int k = options.slice < 0 ? sliceOfLargestDifference(scene) : options.slice;
  SlicePlane plane = planeOfSlice(scene.mri.grid, k, options.pixelsPerVoxel);
  if (options.margin_mm) {
    const auto [low, high] = composer.liverBox(plane);
    const Eigen::Vector2d margin = Eigen::Vector2d::Constant(*options.margin_mm / plane.mmPerPixel);
    plane = cropOf(plane, low - margin, high + margin);
  }
  Picture picture = composer.draw(plane, options);
  const bool redBlue = options.palette == Palette::RedBlue;
  const Rgb mreColour = redBlue ? Rgb{90, 120, 255} : Rgb{70, 160, 255};
  const Rgb atlasColour = redBlue ? Rgb{255, 80, 80} : Rgb{255, 165, 40};
  if (options.arrows)
    paintArrows(picture, plane, displacementArrows(scene, options.arrows_mm, mostArrows, k), mreColour, atlasColour);
  if (!scene.valid) drawNotValid(picture);
  if (!options.decorate) return picture;

  SliceFrame frame{.plane = plane};
  frame.legend = legendOf(scene, redBlue);
  frame.legend.push_back({colours::gridGreen, formatted("grid %g mm", options.grid_mm), true});
  frame.notes = {formatted("Slice %.0f of %.0f", k + 1, scene.mri.grid.size.z()) + largestInSlice(composer, scene, k),
                 "Surroundings of the liver are not simulated: shown at rest, dimmed."};
  if (composer.showsBar(plane))
    frame.notes.push_back("Even discs or bands with a bright edge: the bar where it ends, cut by the slice.");
  if (options.arrows) frame.notes.push_back("Arrows: displacement from rest in the plane of the slice, true to scale.");
  frame.caption = scene.caption;
  frame.mark = scene.mark;
  frame.gridTicks_mm = options.grid_mm;
  frame.ring_lps_mm = options.ring_lps_mm;
  Picture inset;
  if (options.zoomCentre_lps_mm) {
    const int side = std::max(160, static_cast<int>(0.78 * std::min(picture.width, picture.height)));
    frame.insetPlane = zoomOf(plane, *options.zoomCentre_lps_mm, options.zoom_mm, side);
    inset = composer.draw(*frame.insetPlane, options);
    if (!scene.valid) drawNotValid(inset);
    frame.inset = &inset;
    frame.insetBelow = options.zoomBelow;
    frame.insetTitle =
        formatted("× %.1f, %g mm wide", plane.mmPerPixel / frame.insetPlane->mmPerPixel, options.zoom_mm);
  }
  return frameSlice(picture, frame);
}

}  // namespace

std::vector<Picture> sliceOverlays(const RetractionScene& scene, const std::vector<SliceOverlayOptions>& options) {
  scene.mri.grid.check();
  scene.liver.grid.check();
  scene.u_mre_mm.grid.check();
  scene.u_atlas_mm.grid.check();
  const SliceComposer composer(scene);
  std::vector<Picture> pictures;
  for (const SliceOverlayOptions& one : options) pictures.push_back(overlayOf(composer, scene, one));
  return pictures;
}

Picture sliceOverlay(const RetractionScene& scene, const SliceOverlayOptions& options) {
  return std::move(sliceOverlays(scene, {options}).front());
}

CountedPixels countChannels(const Picture& overlay, int threshold) {
  CountedPixels count;
  for (std::size_t n = 0; n + 2 < overlay.rgb.size(); n += 3) {
    const int r = overlay.rgb[n], b = overlay.rgb[n + 2];
    if (r - b > threshold)
      ++count.redOnly;
    else if (b - r > threshold)
      ++count.blueOnly;
    else if (std::max(r, b) > threshold)
      ++count.both;
  }
  return count;
}

}  // namespace glisson::render
