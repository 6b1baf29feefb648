// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/slice_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "render/font.h"

namespace glisson::render {
namespace {

using namespace colours;

std::string number(double v) {
  const double rounded = std::round(v * 10.0) / 10.0;
  std::string text = std::to_string(rounded);
  text = text.substr(0, text.find('.') + 2);
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  if (text == "-0") return "0";
  return text.front() == '-' ? "−" + text.substr(1) : text;
}

void drawScaleBar(RasterPainter& paint, double x, double y, double mmPerPixel, double maximum_px, double font_px) {
  constexpr std::array<double, 9> lengths{1, 2, 5, 10, 20, 50, 100, 200, 500};
  double length_mm = lengths.front();
  for (const double candidate : lengths)
    if (candidate / mmPerPixel <= maximum_px) length_mm = candidate;
  const double length_px = length_mm / mmPerPixel;
  const double thick = std::max(3.0, font_px / 5.0);
  paint.rectangle(x - 2, y - thick - 2, x + length_px + 2, y + 2, {0, 0, 0}, 0.6);
  paint.rectangle(x, y - thick, x + length_px, y, light);
  const std::string text = length_mm >= 10.0 ? number(length_mm / 10.0) + " cm" : number(length_mm) + " mm";
  paint.text({x + 0.5 * length_px, y - thick - 0.4 * font_px}, text,
             {.size_px = font_px, .colour = light, .anchor = Anchor::Centre, .halo_px = 2.0});
}

void drawOrientation(RasterPainter& paint, const SlicePlane& plane, double x0, double y0, double width, double height,
                     double font_px) {
  const TextStyle style{
      .size_px = 1.25 * font_px, .colour = light, .anchor = Anchor::Centre, .bold = true, .halo_px = 2};
  const double inset = 0.9 * font_px;
  paint.text({x0 + inset, y0 + 0.5 * height + 0.45 * font_px}, plane.leftLetter, style);
  paint.text({x0 + width - inset, y0 + 0.5 * height + 0.45 * font_px}, plane.rightLetter, style);
  paint.text({x0 + 0.5 * width, y0 + 1.5 * font_px}, plane.topLetter, style);
  paint.text({x0 + 0.5 * width, y0 + height - 0.6 * font_px}, plane.bottomLetter, style);
}

/// Labels of the grid along the bottom and left edge, cm in the patient frame.
void drawTicks(RasterPainter& paint, const SlicePlane& plane, double spacing_mm, double x0, double y0, double font_px) {
  const double startX = plane.corner_lps.dot(plane.right), startY = plane.corner_lps.dot(plane.down);
  const double extentX = plane.width * plane.mmPerPixel, extentY = plane.height * plane.mmPerPixel;
  double every_mm = spacing_mm;  // thin the labels out, not the lines
  while (every_mm / plane.mmPerPixel < 3.2 * font_px) every_mm += spacing_mm;
  if (every_mm > 2.0 * spacing_mm) every_mm = std::ceil(every_mm / (5.0 * spacing_mm)) * 5.0 * spacing_mm;
  const TextStyle below{.size_px = 0.85 * font_px, .colour = gridGreen, .anchor = Anchor::Centre};
  const TextStyle beside{.size_px = 0.85 * font_px, .colour = gridGreen, .anchor = Anchor::Right};
  for (const double v : gridLines_mm(startX, startX + extentX, every_mm)) {
    const double x = x0 + (v - startX) / plane.mmPerPixel;
    paint.line({x, y0 + plane.height}, {x, y0 + plane.height + 0.35 * font_px}, {.colour = gridGreen, .width = 1.5});
    paint.text({x, y0 + plane.height + 1.2 * font_px}, number(v / 10.0), below);
  }
  for (const double v : gridLines_mm(startY, startY + extentY, every_mm)) {
    const double y = y0 + (v - startY) / plane.mmPerPixel;
    paint.line({x0 - 0.35 * font_px, y}, {x0, y}, {.colour = gridGreen, .width = 1.5});
    paint.text({x0 - 0.55 * font_px, y + 0.3 * font_px}, number(v / 10.0), beside);
  }
  paint.text({x0 - 0.55 * font_px, y0 + plane.height + 1.2 * font_px}, "cm", beside);
}

/// A ring around a place of the plane that lies within width x height pixels from (x0, y0).
void drawRing(RasterPainter& paint, const SlicePlane& plane, const Eigen::Vector3d& p_lps, double x0, double y0,
              double radius) {
  const Point at = plane.toPixel(p_lps);
  if (at.x() < 0.0 || at.y() < 0.0 || at.x() > plane.width || at.y() > plane.height) return;
  constexpr int corners = 40;
  std::vector<Point> ring;
  for (int n = 0; n <= corners; ++n) {
    const double angle = 2.0 * std::numbers::pi * n / corners;
    ring.push_back(at + Point(x0, y0) + radius * Point(std::cos(angle), std::sin(angle)));
  }
  paint.polyline(ring, {.colour = {0, 0, 0}, .width = 0.3 * radius + 2.0, .alpha = 0.7});
  paint.polyline(ring, {.colour = warning, .width = 0.3 * radius});
}

double legendWidth(const std::vector<LegendItem>& legend, double font_px) {
  double width = 0.0;
  for (const LegendItem& item : legend) width += 1.7 * font_px + textWidth(item.text, font_px) + 1.6 * font_px;
  return width;
}

void drawLegend(RasterPainter& paint, const std::vector<LegendItem>& legend, double x, double baseline,
                double font_px) {
  for (const LegendItem& item : legend) {
    if (item.asLine)
      paint.line({x, baseline - 0.36 * font_px}, {x + 1.25 * font_px, baseline - 0.36 * font_px},
                 {.colour = item.colour, .width = std::max(2.0, font_px / 8.0)});
    else
      paint.rectangle(x, baseline - 0.85 * font_px, x + 1.1 * font_px, baseline + 0.15 * font_px, item.colour);
    x += 1.7 * font_px;
    paint.text({x, baseline}, item.text, {.size_px = font_px, .colour = light});
    x += textWidth(item.text, font_px) + 1.6 * font_px;
  }
}

void drawColourBar(RasterPainter& paint, const ColourBar& bar, double x, double y0, double height, double font_px) {
  const double width = 1.3 * font_px;
  y0 = std::floor(y0);  // whole rows: colours must not mix with the page
  x = std::floor(x);
  height = std::floor(height);
  for (int n = 0; n < static_cast<int>(height); ++n)
    paint.rectangle(x, y0 + n, x + width, y0 + n + 1, bar.map.at(1.0 - (n + 0.5) / height));
  paint.frame(x, y0, x + width, y0 + height, {.colour = faint, .width = 1.0});
  const double range = bar.high - bar.low;
  double step = std::pow(10.0, std::floor(std::log10(range / 4.0)));
  for (const double factor : {1.0, 2.0, 5.0, 10.0})
    if (range / (step * factor) <= 8.0) {
      step *= factor;
      break;
    }
  const auto yOf = [&](double v) { return y0 + height * (1.0 - (v - bar.low) / range); };
  for (const double v : gridLines_mm(bar.low, bar.high, step)) {
    paint.line({x + width, yOf(v)}, {x + width + 0.3 * font_px, yOf(v)}, {.colour = light, .width = 1.5});
    paint.text({x + width + 0.5 * font_px, yOf(v) + 0.32 * font_px}, number(v),
               {.size_px = 0.9 * font_px, .colour = light});
  }
  if (bar.mark && *bar.mark > bar.low && *bar.mark < bar.high)
    paint.line({x - 0.3 * font_px, yOf(*bar.mark)}, {x + width + 0.3 * font_px, yOf(*bar.mark)},
               {.colour = bar.markColour, .width = 3.0});
  paint.text({x + 4.6 * font_px, y0 + 0.5 * height}, bar.title,
             {.size_px = font_px, .colour = light, .anchor = Anchor::Centre, .angle_deg = 90.0});
}

/// Where the parts of a framed slice lie, pixels.
struct Layout {
  Layout(const Picture& image, const SliceFrame& frame);

  /// First pixel of the inset, which lies beside the image or below it.
  Point insetCorner(const Picture& image, const SliceFrame& frame) const {
    const int x = frame.insetBelow ? x0 : static_cast<int>(x0 + image.width + bar + gap);
    const int y = frame.insetBelow ? static_cast<int>(y0 + image.height + ticks) : y0;
    return Point(x, y);
  }

  double font;
  double left, top, gap;
  double bar;         ///< width of the colour bar with its labels
  double lineHeight;  ///< of the text below
  double legendRows;  ///< height of the legend
  double ticks;       ///< height of the grid's labels
  double body = 0.0;  ///< height of the image, with the inset where that lies below
  double bottom = 0.0;
  std::vector<std::string> notes, mark, caption;  ///< in lines
  int x0, y0;                                     ///< first pixel of the image
  int width = 0, height = 0;                      ///< of the whole
};

Layout::Layout(const Picture& image, const SliceFrame& frame)
    : font(frameFontSize(image)),
      left(frame.gridTicks_mm ? 3.4 * font : 1.2 * font),
      top(frame.title.empty() ? 1.2 * font : 2.8 * font),
      gap(1.4 * font),
      bar(frame.colourBar ? 6.4 * font : 0.0),
      lineHeight(1.5 * font),
      legendRows(frame.legend.empty() ? 0.0 : 1.9 * font),
      ticks(frame.gridTicks_mm ? 1.6 * font : 0.5 * font),
      x0(static_cast<int>(left)),
      y0(static_cast<int>(top)) {
  double right = gap;
  if (frame.inset && !frame.insetBelow) right += frame.inset->width + gap;
  const double wanted =
      std::max({legendWidth(frame.legend, font), textWidth(phrase(researchUseOnly, frame.language), font),
                textWidth(frame.title, 1.2 * font, true)}) +
      left;
  width = static_cast<int>(std::ceil(std::max(left + image.width + bar + right, wanted)));
  const double text_px = width - left - gap;
  for (const std::string& note : frame.notes)
    for (std::string& line : wrapText(note, font, text_px)) notes.push_back(std::move(line));
  caption = wrapText(frame.caption, font, text_px);
  if (!frame.mark.empty()) mark = wrapText(frame.mark, font, text_px);
  bottom = ticks + legendRows + lineHeight * static_cast<double>(notes.size() + mark.size() + caption.size() + 1) +
           0.9 * font;
  const double insetHeight = frame.inset ? frame.inset->height + (frame.insetTitle.empty() ? 0.0 : 1.6 * font) : 0.0;
  body = frame.insetBelow && frame.inset ? image.height + ticks + insetHeight
                                         : std::max<double>(image.height, insetHeight);
  height = static_cast<int>(std::ceil(top + body + bottom));
}

/// Everything on the image and at its edges.
void drawAround(RasterPainter& paint, const Picture& image, const SliceFrame& frame, const Layout& at) {
  const double font = at.font;
  const int x0 = at.x0, y0 = at.y0;
  paint.frame(x0 - 0.5, y0 - 0.5, x0 + image.width + 0.5, y0 + image.height + 0.5, {.colour = faint, .width = 1.0});
  if (!frame.title.empty())
    paint.text({at.left, 1.9 * font}, frame.title, {.size_px = 1.2 * font, .colour = light, .bold = true});
  if (frame.gridTicks_mm) drawTicks(paint, frame.plane, *frame.gridTicks_mm, x0, y0, font);
  drawOrientation(paint, frame.plane, x0, y0, image.width, image.height, font);
  drawScaleBar(paint, x0 + font, y0 + image.height - 0.9 * font, frame.plane.mmPerPixel, 0.3 * image.width, font);
  if (frame.ring_lps_mm) drawRing(paint, frame.plane, *frame.ring_lps_mm, x0, y0, 0.6 * font);
  if (frame.colourBar)
    drawColourBar(paint, *frame.colourBar, x0 + image.width + font, y0 + 0.5 * font, image.height - font, font);
}

Stroke insetEdge(double font) {
  return {.colour = {255, 255, 255}, .width = std::max(1.5, font / 12.0)};
}

/// The inset's place on the image, tied to its corners.
void drawTies(RasterPainter& paint, const SliceFrame& frame, const Point& corner, const Layout& at) {
  const SlicePlane& zoom = *frame.insetPlane;
  const bool below = frame.insetBelow;
  const Point low = frame.plane.toPixel(zoom.corner_lps) + Point(at.x0, at.y0);
  const double side = zoom.width * zoom.mmPerPixel / frame.plane.mmPerPixel;
  const Stroke tie{.colour = {255, 255, 255}, .width = 1.0, .dashed = true, .alpha = 0.6};
  paint.frame(low.x(), low.y(), low.x() + side, low.y() + side, insetEdge(at.font));
  const Point near = low + (below ? Point(0.0, side) : Point(side, 0.0)), far = low + Point(side, side);
  const Point next = corner + (below ? Point(zoom.width, 0.0) : Point(0.0, zoom.height));
  paint.line(near, corner, tie);
  paint.line(far, next, tie);
}

/// A ruler of 5 mm, its first pixel at (x, y).
void drawRuler(RasterPainter& paint, double mmPerPixel, double x, double y, double font) {
  const double ruler_px = 5.0 / mmPerPixel;
  paint.rectangle(x - 2, y - 0.5 * font - 2, x + ruler_px + 2, y + 2, {0, 0, 0}, 0.6);
  paint.line({x, y - 0.2 * font}, {x + ruler_px, y - 0.2 * font}, {.colour = warning, .width = 3.0});
  for (int mm = 0; mm <= 5; ++mm)
    paint.line({x + mm / mmPerPixel, y - (mm % 5 == 0 ? 0.7 : 0.45) * font}, {x + mm / mmPerPixel, y},
               {.colour = warning, .width = 2.0});
  paint.text({x + 0.5 * ruler_px, y - 1.0 * font}, "5 mm",
             {.size_px = font, .colour = warning, .anchor = Anchor::Centre, .halo_px = 2.0});
}

void drawOnInset(RasterPainter& paint, const SliceFrame& frame, const Point& corner, const Layout& at) {
  const SlicePlane& zoom = *frame.insetPlane;
  const double font = at.font, x = corner.x(), y = corner.y();
  paint.frame(x, y, x + zoom.width, y + zoom.height, insetEdge(font));
  if (frame.ring_lps_mm) drawRing(paint, zoom, *frame.ring_lps_mm, x, y, font);
  drawRuler(paint, zoom.mmPerPixel, x + font, y + zoom.height - font, font);
  if (!frame.insetTitle.empty() && y + zoom.height + 1.6 * font < at.top + at.body + at.bottom)
    paint.text({x, y + zoom.height + 1.4 * font}, frame.insetTitle, {.size_px = font, .colour = light});
}

/// Legend, notes, reservation and caption.
void drawBelow(RasterPainter& paint, const SliceFrame& frame, const Layout& at) {
  const double font = at.font;
  double y = at.top + at.body + (frame.insetBelow && frame.inset ? 0.0 : at.ticks);
  if (!frame.legend.empty()) {
    drawLegend(paint, frame.legend, at.left, y + 1.3 * font, font);
    y += at.legendRows;
  }
  const auto write = [&](const std::vector<std::string>& lines, Rgb colour) {
    for (const std::string& line : lines) {
      y += at.lineHeight;
      paint.text({at.left, y}, line, {.size_px = font, .colour = colour});
    }
  };
  write(at.notes, light);
  write(at.mark, warning);
  write(at.caption, faint);
  write({phrase(researchUseOnly, frame.language)}, warning);
}

}  // namespace

std::vector<double> gridLines_mm(double low_mm, double high_mm, double spacing_mm) {
  std::vector<double> lines;
  const double slack = 1e-9 * spacing_mm;
  for (double n = std::ceil((low_mm - slack) / spacing_mm); n * spacing_mm <= high_mm + slack; n += 1.0)
    lines.push_back(n * spacing_mm);
  return lines;
}

double frameFontSize(const Picture& image) {
  return std::clamp(std::min(image.width, image.height) / 36.0, 11.0, 44.0);
}

Picture frameSlice(const Picture& image, const SliceFrame& frame) {
  const Layout layout(image, frame);
  Picture out = blankPicture(layout.width, layout.height, night);
  paste(out, image, layout.x0, layout.y0);
  RasterPainter paint(out);
  drawAround(paint, image, frame, layout);
  if (frame.inset && frame.insetPlane) {
    const Point corner = layout.insetCorner(image, frame);
    drawTies(paint, frame, corner, layout);
    paste(out, *frame.inset, static_cast<int>(corner.x()), static_cast<int>(corner.y()));
    drawOnInset(paint, frame, corner, layout);
  }
  drawBelow(paint, frame, layout);
  return out;
}

void drawNotValid(Picture& picture) {
  const std::string text = "NOT CONVERGED / OUTSIDE VALIDITY";
  const double diagonal = std::hypot(picture.width, picture.height);
  double size = 40.0;
  size *= 0.72 * diagonal / textWidth(text, size, true);
  size = std::min(size, 0.25 * picture.height);
  const double angle = std::atan2(picture.height, picture.width);
  const Point along(std::cos(angle), -std::sin(angle)), below(std::sin(angle), std::cos(angle));
  const Point baseline = Point(0.5 * picture.width, 0.5 * picture.height) + 0.36 * size * below;
  RasterPainter paint(picture);
  const Point centre(0.5 * picture.width, 0.5 * picture.height);
  const Point a = centre - along * diagonal, b = centre + along * diagonal;
  const Point up = 0.85 * size * below;
  paint.polygon({a - up, b - up, b + up, a + up}, {0, 0, 0}, 0.55);
  paint.text(baseline, text,
             {.size_px = size,
              .colour = warning,
              .anchor = Anchor::Centre,
              .angle_deg = angle * 180.0 / 3.14159265358979323846,
              .bold = true});
}

}  // namespace glisson::render
