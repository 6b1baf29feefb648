// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/line_work.h"

#include <QImage>
#include <QPainter>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace glisson::views {

namespace {

constexpr double haloBeyond_px = 1.0;  // on either side of the line
constexpr double haloOpacity = 0.6;
constexpr double on_widths = 4.0, off_widths = 3.5;  // of a dash and the gap after it

/// The part of a segment within a rectangle as fractions of its length (Liang and Barsky 1984).
std::optional<std::pair<double, double>> within(const QRectF& area, const QLineF& line) {
  double from = 0.0, to = 1.0;
  const auto cut = [&](double step, double room) {
    if (step == 0.0) return room >= 0.0;
    const double at = room / step;
    (step < 0.0 ? from : to) = step < 0.0 ? std::max(from, at) : std::min(to, at);
    return from <= to;
  };
  if (!cut(-line.dx(), line.x1() - area.left()) || !cut(line.dx(), area.right() - line.x1()) ||
      !cut(-line.dy(), line.y1() - area.top()) || !cut(line.dy(), area.bottom() - line.y1()))
    return {};
  return std::pair{from, to};
}

QPen pen(const QColor& colour, double width) {
  return {colour, width, Qt::SolidLine, Qt::SquareCap, Qt::BevelJoin};
}

}  // namespace

LineWork::LineWork(const QRectF& view) : view_(view.adjusted(-8.0, -8.0, 8.0, 8.0)) {}

void LineWork::add(const QPolygonF& points, bool closed, const QColor& colour, double width, bool dashed) {
  if (strokes_.isEmpty() || strokes_.last().colour != colour || strokes_.last().width != width)
    strokes_ << Stroke{{}, {}, colour, width};
  Stroke& stroke = strokes_.last();
  const double on = on_widths * width, period = on + off_widths * width;
  double along = 0.0;  // from the first point, so that a dash goes on around a vertex
  const auto ends = points.size() - (closed ? 0 : 1);
  for (qsizetype i = 0; i < ends; ++i) {
    const QLineF segment(points[i], points[(i + 1) % points.size()]);
    const double length = segment.length(), before = along;
    along += length;
    if (!(length > 0.0)) continue;
    const auto seen = within(view_, segment);
    if (!seen) continue;
    const QLineF visible(segment.pointAt(seen->first), segment.pointAt(seen->second));
    stroke.halo << visible;
    if (!dashed) {
      stroke.line << visible;
      continue;
    }
    const double begin = before + seen->first * length, end = before + seen->second * length;
    for (double dash = std::floor(begin / period); dash * period < end; dash += 1.0) {
      const double a = std::max(begin, dash * period), b = std::min(end, dash * period + on);
      if (a < b) stroke.line << QLineF(segment.pointAt((a - before) / length), segment.pointAt((b - before) / length));
    }
  }
}

void LineWork::paint(QPainter& painter) const {
  if (strokes_.isEmpty()) return;
  const double ratio = painter.device()->devicePixelRatioF();
  QImage halo((view_.size() * ratio).toSize(), QImage::Format_ARGB32_Premultiplied);
  halo.setDevicePixelRatio(ratio);
  halo.fill(Qt::transparent);
  QPainter dark(&halo);
  dark.setRenderHint(QPainter::Antialiasing);
  dark.translate(-view_.topLeft());
  for (const Stroke& s : strokes_) {
    dark.setPen(pen(Qt::black, s.width + 2.0 * haloBeyond_px));
    dark.drawLines(s.halo);
  }
  dark.end();
  painter.setOpacity(haloOpacity);
  painter.drawImage(view_.topLeft(), halo);
  painter.setOpacity(1.0);
  for (const Stroke& s : strokes_) {
    painter.setPen(pen(s.colour, s.width));
    painter.drawLines(s.line);
  }
}

}  // namespace glisson::views
