// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/svg_painter.h"

#include <cmath>
#include <cstdio>
#include <locale>

#include "base/xml_text.h"

namespace glisson::render {
namespace {

std::string hex(Rgb c) {
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", c.r, c.g, c.b);
  return text;
}

}  // namespace

SvgPainter::SvgPainter(int width, int height) {
  out_.imbue(std::locale::classic());
  out_ << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << width << "\" height=\"" << height
       << "\" viewBox=\"0 0 " << width << ' ' << height << "\" font-family=\"DejaVu Sans, Verdana, sans-serif\">\n";
}

void SvgPainter::line(const Point& a, const Point& b, const Stroke& s) {
  if (!a.allFinite() || !b.allFinite()) return;
  out_ << "<line x1=\"" << a.x() << "\" y1=\"" << a.y() << "\" x2=\"" << b.x() << "\" y2=\"" << b.y() << "\" stroke=\""
       << hex(s.colour) << "\" stroke-width=\"" << s.width << "\" stroke-linecap=\"round\"";
  if (s.alpha < 1.0) out_ << " stroke-opacity=\"" << s.alpha << '"';
  if (s.dashed)
    out_ << " stroke-dasharray=\"" << std::max(6.0, 4.0 * s.width) << ' ' << std::max(4.0, 2.5 * s.width) << '"';
  out_ << "/>\n";
}

void SvgPainter::polygon(const std::vector<Point>& corners, Rgb fill, double alpha) {
  out_ << "<polygon points=\"";
  for (const Point& p : corners) out_ << p.x() << ',' << p.y() << ' ';
  out_ << "\" fill=\"" << hex(fill) << "\" fill-opacity=\"" << alpha << "\"/>\n";
}

void SvgPainter::disc(const Point& centre, double radius, Rgb fill, double alpha) {
  out_ << "<circle cx=\"" << centre.x() << "\" cy=\"" << centre.y() << "\" r=\"" << radius << "\" fill=\"" << hex(fill)
       << "\" fill-opacity=\"" << alpha << "\"/>\n";
}

void SvgPainter::text(const Point& at, const std::string& utf8, const TextStyle& style) {
  if (utf8.empty()) return;
  const char* anchor = style.anchor == Anchor::Left ? "start" : style.anchor == Anchor::Centre ? "middle" : "end";
  out_ << "<text x=\"" << at.x() << "\" y=\"" << at.y() << "\" font-size=\"" << style.size_px << "\" fill=\""
       << hex(style.colour) << "\" text-anchor=\"" << anchor << '"';
  if (style.bold) out_ << " font-weight=\"bold\"";
  if (style.alpha < 1.0) out_ << " fill-opacity=\"" << style.alpha << '"';
  if (style.angle_deg != 0.0)
    out_ << " transform=\"rotate(" << -style.angle_deg << ' ' << at.x() << ' ' << at.y() << ")\"";
  out_ << '>' << xmlEscaped(utf8) << "</text>\n";
}

std::string SvgPainter::document() const {
  return out_.str() + "</svg>\n";
}

}  // namespace glisson::render
