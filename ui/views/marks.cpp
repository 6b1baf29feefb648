// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/marks.h"

#include <QLineF>
#include <QPainter>
#include <QPainterPath>
#include <algorithm>
#include <cmath>

namespace glisson::views {

namespace {

constexpr double hit_px = 9.0;

void paintLine(QPainter& painter, const Mark& mark, const QPointF& from, const QPointF& to) {
  const QLineF line(from, to);
  for (const auto& [colour, width] : {std::pair{QColor(0, 0, 0, 170), 4.5}, {mark.colour, 2.2}}) {
    painter.setPen(QPen(colour, width, Qt::SolidLine, Qt::RoundCap));
    painter.drawLine(line);
    if (!mark.arrow || line.length() < 4.0) continue;
    const double back = std::min(11.0, 0.5 * line.length());
    const QPointF along = (to - from) / line.length(), aside(-along.y(), along.x());
    painter.drawLine(to, to - back * along + 0.5 * back * aside);
    painter.drawLine(to, to - back * along - 0.5 * back * aside);
  }
}

/// Beside its mark, where it covers no other mark that the mouse may want and lies in the view.
QRectF labelFor(const QPainter& painter, const Mark& mark, const QPointF& at, double off,
                const std::vector<QPointF>& places) {
  QRectF label = QRectF(painter.fontMetrics().boundingRect(mark.text)).adjusted(-5, -2, 5, 2);
  const QRectF view(painter.window());
  label.moveCenter(at);
  const double aside = 0.5 * label.width() + off, above = 0.5 * label.height() + off;
  const QRectF first = label.translated(aside, 0.0);
  for (const QPointF& by : {QPointF(aside, 0.0), {-aside, 0.0}, {0.0, -above}, {0.0, above}}) {
    const QRectF there = label.translated(by), wide = there.adjusted(-hit_px, -hit_px, hit_px, hit_px);
    if (!view.contains(there)) continue;
    if (std::none_of(places.begin(), places.end(), [&](const QPointF& p) { return p != at && wide.contains(p); }))
      return there;
  }
  return first;
}

}  // namespace

void paintMarks(QPainter& painter, const std::vector<Mark>& marks, const Projection& seenAt) {
  painter.setRenderHint(QPainter::Antialiasing);
  std::vector<QPointF> places;
  for (const Mark& mark : marks)
    if (const auto at = seenAt(mark.at_lps)) places.push_back(*at);
  for (const Mark& mark : marks) {
    const auto at = seenAt(mark.at_lps);
    if (!at) continue;
    const auto from = mark.from_lps ? seenAt(*mark.from_lps) : std::nullopt;
    if (from) paintLine(painter, mark, *from, *at);
    // Rings come in dozens along one vessel: small and thin, or they hide it.
    const bool slight = mark.shape == Mark::Shape::Ring && !mark.current;
    const double r = mark.current ? 7.5 : slight ? 4.0 : 5.5;
    QPainterPath shape;
    switch (mark.shape) {
      case Mark::Shape::Dot:
      case Mark::Shape::Ring: shape.addEllipse(*at, r, r); break;
      case Mark::Shape::Square: shape.addRect(QRectF(at->x() - r, at->y() - r, 2 * r, 2 * r)); break;
      case Mark::Shape::Diamond:
        shape.addPolygon(QPolygonF({*at + QPointF(0, -1.3 * r), *at + QPointF(1.3 * r, 0), *at + QPointF(0, 1.3 * r),
                                    *at + QPointF(-1.3 * r, 0), *at + QPointF(0, -1.3 * r)}));
        break;
    }
    painter.setPen(slight ? QPen(QColor(0, 0, 0, 90), 2.6) : QPen(QColor(0, 0, 0, 200), 4.0));
    painter.setBrush(Qt::NoBrush);
    painter.drawPath(shape);
    painter.setPen(
        QPen(mark.current || mark.shape != Mark::Shape::Ring ? QColor(255, 255, 255) : mark.colour, mark.current ? 2.4
                                                                                                    : slight     ? 1.2
                                                                                                             : 1.6));
    painter.setBrush(mark.shape == Mark::Shape::Ring ? QBrush(Qt::NoBrush) : QBrush(mark.colour));
    painter.drawPath(shape);
    if (mark.text.isEmpty()) continue;
    const QRectF label = labelFor(painter, mark, *at, r + 6.0, places);
    painter.setPen(Qt::NoPen);
    painter.setBrush(QColor(0, 0, 0, 165));
    painter.drawRoundedRect(label, 3, 3);
    painter.setPen(QColor(240, 243, 247));
    painter.drawText(label, Qt::AlignCenter, mark.text);
  }
}

const Mark* markAt(const std::vector<Mark>& marks, const Projection& seenAt, const QPointF& at) {
  const Mark* found = nullptr;
  double nearest = hit_px;
  for (const Mark& mark : marks) {
    const auto seen = seenAt(mark.at_lps);
    if (!seen) continue;
    const double d = QLineF(*seen, at).length();
    if (d <= nearest) {
      nearest = d;
      found = &mark;
    }
  }
  return found;
}

}  // namespace glisson::views
