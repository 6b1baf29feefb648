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
  const double font = frameFontSize(image);
  const double left = frame.gridTicks_mm ? 3.4 * font : 1.2 * font;
  const double top = frame.title.empty() ? 1.2 * font : 2.8 * font;
  const double gap = 1.4 * font;
  double right = gap;
  const double bar = frame.colourBar ? 6.4 * font : 0.0;
  if (frame.inset && !frame.insetBelow) right += frame.inset->width + gap;
  const double wanted = std::max({legendWidth(frame.legend, font), textWidth(researchUseOnly, font),
                                  textWidth(frame.title, 1.2 * font, true)}) +
                        left;
  const int width = static_cast<int>(std::ceil(std::max(left + image.width + bar + right, wanted)));
  double noteWidth = 0.0;
  std::vector<std::string> notes;
  for (const std::string& note : frame.notes)
    for (std::string& line : wrapText(note, font, width - left - gap)) notes.push_back(std::move(line));
  for (const std::string& line : notes) noteWidth = std::max(noteWidth, textWidth(line, font));
  const std::vector<std::string> caption = wrapText(frame.caption, font, width - left - gap);
  const std::vector<std::string> mark =
      frame.mark.empty() ? std::vector<std::string>{} : wrapText(frame.mark, font, width - left - gap);

  const double lineHeight = 1.5 * font;
  const double legendRows = frame.legend.empty() ? 0.0 : 1.9 * font;
  const double ticks = frame.gridTicks_mm ? 1.6 * font : 0.5 * font;
  const double bottom = ticks + legendRows +
                        lineHeight * static_cast<double>(notes.size() + mark.size() + caption.size() + 1) + 0.9 * font;
  const double insetHeight = frame.inset ? frame.inset->height + (frame.insetTitle.empty() ? 0.0 : 1.6 * font) : 0.0;
  const double body = frame.insetBelow && frame.inset ? image.height + ticks + insetHeight
                                                      : std::max<double>(image.height, insetHeight);
  const int height = static_cast<int>(std::ceil(top + body + bottom));

  Picture out = blankPicture(width, height, night);
  RasterPainter paint(out);
  const int x0 = static_cast<int>(left), y0 = static_cast<int>(top);
  paste(out, image, x0, y0);
  paint.frame(x0 - 0.5, y0 - 0.5, x0 + image.width + 0.5, y0 + image.height + 0.5, {.colour = faint, .width = 1.0});
  if (!frame.title.empty())
    paint.text({left, 1.9 * font}, frame.title, {.size_px = 1.2 * font, .colour = light, .bold = true});
  if (frame.gridTicks_mm) drawTicks(paint, frame.plane, *frame.gridTicks_mm, x0, y0, font);
  drawOrientation(paint, frame.plane, x0, y0, image.width, image.height, font);
  drawScaleBar(paint, x0 + font, y0 + image.height - 0.9 * font, frame.plane.mmPerPixel, 0.3 * image.width, font);
  if (frame.ring_lps_mm) drawRing(paint, frame.plane, *frame.ring_lps_mm, x0, y0, 0.6 * font);
  if (frame.colourBar)
    drawColourBar(paint, *frame.colourBar, x0 + image.width + font, y0 + 0.5 * font, image.height - font, font);

  if (frame.inset && frame.insetPlane) {
    const SlicePlane& zoom = *frame.insetPlane;
    const bool below = frame.insetBelow;
    const int ix = below ? x0 : static_cast<int>(x0 + image.width + bar + gap);
    const int iy = below ? static_cast<int>(y0 + image.height + ticks) : y0;
    const Point low = frame.plane.toPixel(zoom.corner_lps) + Point(x0, y0);
    const double side = zoom.width * zoom.mmPerPixel / frame.plane.mmPerPixel;
    const Stroke white{.colour = {255, 255, 255}, .width = std::max(1.5, font / 12.0)};
    const Stroke tie{.colour = {255, 255, 255}, .width = 1.0, .dashed = true, .alpha = 0.6};
    paint.frame(low.x(), low.y(), low.x() + side, low.y() + side, white);
    const Point near = low + (below ? Point(0.0, side) : Point(side, 0.0)), far = low + Point(side, side);
    const Point corner(ix, iy), next = corner + (below ? Point(zoom.width, 0.0) : Point(0.0, zoom.height));
    paint.line(near, corner, tie);
    paint.line(far, next, tie);
    paste(out, *frame.inset, ix, iy);
    paint.frame(ix, iy, ix + zoom.width, iy + zoom.height, white);
    if (frame.ring_lps_mm) drawRing(paint, zoom, *frame.ring_lps_mm, ix, iy, font);
    const double ruler_px = 5.0 / zoom.mmPerPixel, rx = ix + font, ry = iy + zoom.height - font;
    paint.rectangle(rx - 2, ry - 0.5 * font - 2, rx + ruler_px + 2, ry + 2, {0, 0, 0}, 0.6);
    paint.line({rx, ry - 0.2 * font}, {rx + ruler_px, ry - 0.2 * font}, {.colour = warning, .width = 3.0});
    for (int mm = 0; mm <= 5; ++mm)
      paint.line({rx + mm / zoom.mmPerPixel, ry - (mm % 5 == 0 ? 0.7 : 0.45) * font}, {rx + mm / zoom.mmPerPixel, ry},
                 {.colour = warning, .width = 2.0});
    paint.text({rx + 0.5 * ruler_px, ry - 1.0 * font}, "5 mm",
               {.size_px = font, .colour = warning, .anchor = Anchor::Centre, .halo_px = 2.0});
    if (!frame.insetTitle.empty() && iy + zoom.height + 1.6 * font < top + body + bottom)
      paint.text({static_cast<double>(ix), iy + zoom.height + 1.4 * font}, frame.insetTitle,
                 {.size_px = font, .colour = light});
  }

  double y = top + body + (frame.insetBelow && frame.inset ? 0.0 : ticks);
  if (!frame.legend.empty()) {
    drawLegend(paint, frame.legend, left, y + 1.3 * font, font);
    y += legendRows;
  }
  for (const std::string& note : notes) {
    y += lineHeight;
    paint.text({left, y}, note, {.size_px = font, .colour = light});
  }
  for (const std::string& line : mark) {
    y += lineHeight;
    paint.text({left, y}, line, {.size_px = font, .colour = warning});
  }
  for (const std::string& line : caption) {
    y += lineHeight;
    paint.text({left, y}, line, {.size_px = font, .colour = faint});
  }
  y += lineHeight;
  paint.text({left, y}, researchUseOnly, {.size_px = font, .colour = warning});
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
