// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/painter.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "render/font.h"
#include "render/stroke_cover.h"

namespace glisson::render {

void Painter::rectangle(double x0, double y0, double x1, double y1, Rgb fill, double alpha) {
  polygon({{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, fill, alpha);
}

void Painter::frame(double x0, double y0, double x1, double y1, const Stroke& stroke) {
  polyline({{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}, {x0, y0}}, stroke);
}

void Painter::polyline(const std::vector<Point>& points, const Stroke& stroke) {
  if (!stroke.dashed) {
    for (std::size_t n = 1; n < points.size(); ++n) line(points[n - 1], points[n], stroke);
    return;
  }
  // Dashes run on around corners, so that an outline of many short pieces is dashed too.
  Stroke solid = stroke;
  solid.dashed = false;
  const double on = std::max(6.0, 4.0 * stroke.width), period = on + std::max(4.0, 2.5 * stroke.width);
  double phase = 0.0;
  for (std::size_t n = 1; n < points.size(); ++n) {
    const Point d = points[n] - points[n - 1];
    const double length = d.norm();
    for (double s = 0.0; s < length;) {
      const double left = (phase < on ? on : period) - phase, step = std::min(left, length - s);
      if (phase < on) line(points[n - 1] + d * (s / length), points[n - 1] + d * ((s + step) / length), solid);
      s += step;
      phase = step < left ? phase + step : (phase < on ? on : 0.0);
    }
  }
}

void RasterPainter::blend(int x, int y, Rgb colour, double alpha) {
  if (x < 0 || y < 0 || x >= picture_.width || y >= picture_.height || alpha <= 0.0) return;
  std::uint8_t* p = picture_.rgb.data() + 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture_.width) +
                                               static_cast<std::size_t>(x));
  const double a = std::min(alpha, 1.0);
  const auto mix = [a](std::uint8_t under, std::uint8_t over) {
    return static_cast<std::uint8_t>(std::lround((1.0 - a) * under + a * over));
  };
  p[0] = mix(p[0], colour.r);
  p[1] = mix(p[1], colour.g);
  p[2] = mix(p[2], colour.b);
}

void RasterPainter::segment(const Point& a, const Point& b, const Stroke& stroke) {
  coverStroke(a, b, stroke.width, picture_.width, picture_.height,
              [&](int x, int y, double cover) { blend(x, y, stroke.colour, stroke.alpha * cover); });
}

void RasterPainter::line(const Point& a, const Point& b, const Stroke& stroke) {
  if (!a.allFinite() || !b.allFinite()) return;
  if (!stroke.dashed) return segment(a, b, stroke);
  const double length = (b - a).norm();
  const double on = std::max(6.0, 4.0 * stroke.width), off = std::max(4.0, 2.5 * stroke.width);
  for (double s = 0.0; s < length; s += on + off)
    segment(a + (b - a) * (s / length), a + (b - a) * (std::min(s + on, length) / length), stroke);
}

void RasterPainter::polygon(const std::vector<Point>& corners, Rgb fill, double alpha) {
  if (corners.size() < 3) return;
  constexpr int sub = 4;  // scanlines a pixel; along the row coverage is exact
  double top = corners[0].y(), bottom = top;
  for (const Point& c : corners) {
    top = std::min(top, c.y());
    bottom = std::max(bottom, c.y());
  }
  const int y0 = std::max(0, static_cast<int>(std::floor(top)));
  const int y1 = std::min(picture_.height - 1, static_cast<int>(std::floor(bottom)));
  std::vector<double> row(static_cast<std::size_t>(picture_.width));
  std::vector<double> crossings;
  for (int y = y0; y <= y1; ++y) {
    std::fill(row.begin(), row.end(), 0.0);
    for (int k = 0; k < sub; ++k) {
      const double ys = y + (k + 0.5) / sub;
      crossings.clear();
      for (std::size_t n = 0; n < corners.size(); ++n) {
        const Point& a = corners[n];
        const Point& b = corners[(n + 1) % corners.size()];
        if ((a.y() <= ys) != (b.y() <= ys))
          crossings.push_back(a.x() + (b.x() - a.x()) * (ys - a.y()) / (b.y() - a.y()));
      }
      std::sort(crossings.begin(), crossings.end());
      for (std::size_t n = 0; n + 1 < crossings.size(); n += 2) {
        const double from = std::clamp(crossings[n], 0.0, static_cast<double>(picture_.width));
        const double to = std::clamp(crossings[n + 1], 0.0, static_cast<double>(picture_.width));
        for (int x = static_cast<int>(from); x < picture_.width && x < to; ++x)
          row[static_cast<std::size_t>(x)] += (std::min(to, x + 1.0) - std::max(from, static_cast<double>(x))) / sub;
      }
    }
    for (int x = 0; x < picture_.width; ++x)
      if (row[static_cast<std::size_t>(x)] > 0.0) blend(x, y, fill, alpha * row[static_cast<std::size_t>(x)]);
  }
}

void RasterPainter::disc(const Point& centre, double radius, Rgb fill, double alpha) {
  for (int y = static_cast<int>(centre.y() - radius) - 1; y <= static_cast<int>(centre.y() + radius) + 1; ++y)
    for (int x = static_cast<int>(centre.x() - radius) - 1; x <= static_cast<int>(centre.x() + radius) + 1; ++x)
      blend(x, y, fill, alpha * std::clamp(radius + 0.5 - (Point(x + 0.5, y + 0.5) - centre).norm(), 0.0, 1.0));
}

void RasterPainter::text(const Point& baseline, const std::string& utf8, const TextStyle& style) {
  const double width = textWidth(utf8, style.size_px, style.bold);
  const double back = style.anchor == Anchor::Left ? 0.0 : style.anchor == Anchor::Centre ? 0.5 * width : width;
  const double angle = style.angle_deg * std::numbers::pi / 180.0;
  const int px = static_cast<int>(std::lround(baseline.x() - back * std::cos(angle)));
  const int py = static_cast<int>(std::lround(baseline.y() + back * std::sin(angle)));
  const TextMask mask = rasterText(utf8, {.size_px = style.size_px, .angle_deg = style.angle_deg, .bold = style.bold});
  const auto draw = [&](int dx, int dy, Rgb colour, double alpha) {
    for (int y = 0; y < mask.height; ++y)
      for (int x = 0; x < mask.width; ++x) {
        const int coverage = mask.coverage[static_cast<std::size_t>(y) * static_cast<std::size_t>(mask.width) +
                                           static_cast<std::size_t>(x)];
        if (coverage > 0) blend(px + mask.left + x + dx, py + mask.top + y + dy, colour, alpha * coverage / 255.0);
      }
  };
  const int halo = static_cast<int>(std::lround(style.halo_px));
  for (int dy = -halo; dy <= halo; ++dy)
    for (int dx = -halo; dx <= halo; ++dx)
      if ((dx != 0 || dy != 0) && dx * dx + dy * dy <= halo * halo + 1) draw(dx, dy, {0, 0, 0}, 0.45 * style.alpha);
  draw(0, 0, style.colour, style.alpha);
}

Picture blankPicture(int width, int height, Rgb fill) {
  Picture p{width, height, {}};
  p.rgb.resize(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (std::size_t n = 0; n < p.rgb.size(); n += 3) {
    p.rgb[n] = fill.r;
    p.rgb[n + 1] = fill.g;
    p.rgb[n + 2] = fill.b;
  }
  return p;
}

void paste(Picture& target, const Picture& source, int x, int y) {
  for (int row = 0; row < source.height; ++row)
    for (int column = 0; column < source.width; ++column) {
      const int tx = x + column, ty = y + row;
      if (tx < 0 || ty < 0 || tx >= target.width || ty >= target.height) continue;
      const auto from = 3 * (static_cast<std::ptrdiff_t>(row) * source.width + column);
      const auto to = 3 * (static_cast<std::ptrdiff_t>(ty) * target.width + tx);
      std::copy_n(source.rgb.begin() + from, 3, target.rgb.begin() + to);
    }
}

std::vector<std::string> wrapText(const std::string& utf8, double size_px, double width_px) {
  std::vector<std::string> lines;
  std::istringstream words(utf8);
  std::string word, current;
  while (words >> word) {
    const std::string longer = current.empty() ? word : current + " " + word;
    if (!current.empty() && textWidth(longer, size_px) > width_px) {
      lines.push_back(current);
      current = word;
    } else {
      current = longer;
    }
  }
  if (!current.empty()) lines.push_back(current);
  return lines;
}

}  // namespace glisson::render
