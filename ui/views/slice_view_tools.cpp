// SPDX-License-Identifier: GPL-3.0-or-later

// How a slice view draws what the tool in hand is about to make.
#include <QPainter>
#include <QPainterPath>

#include "views/line_work.h"
#include "views/slice_ink.h"
#include "views/slice_view.h"

namespace glisson::views {

void SliceView::paintOutlineInWork(QPainter& painter, const tools::SlicePlane& shown) const {
  if (tool_->box()) {
    painter.setPen(QPen(ink, 1.0, Qt::DashLine));
    painter.setBrush(QColor(255, 255, 255, 24));
    painter.drawRect(QRectF(point(tool_->box()->from_px), point(tool_->box()->to_px)).normalized());
  }
  paintShape(painter, shown);
  if (tool_->drawing().cols() == 0) return;
  QPolygonF line = toScreen(tool_->drawing(), shown);
  const QPolygonF vertices = line;
  if (tool_->curve().cols() > 0)
    line = toScreen(tool_->curve(), shown);
  else if (tool_->closes())
    line << vertices.front();
  else if (tool_->pointer())
    line << point(shown.toPixel(*tool_->pointer()));
  const QColor colour = tool_->crosses() ? crossingColour : draftColour;
  LineWork lines(rect());
  lines.add(line, false, colour, 1.8, tool_->crosses());
  lines.paint(painter);
  if (vertices.size() < 400)
    for (const QPointF& v : vertices) drawHandle(painter, v, colour, false);
  painter.setPen(QPen(tool_->closes() ? QColor(Qt::white) : colour, tool_->closes() ? 2.5 : 1.2));
  painter.setBrush(Qt::NoBrush);
  const double r = tool_->closes() ? tools::reach::close_px : 6.5;
  painter.drawEllipse(vertices.front(), r, r);
}

// An ellipse that is being dragged, or what brush or eraser went over.
void SliceView::paintShape(QPainter& painter, const tools::SlicePlane& shown) const {
  if (tool_->shape().empty()) return;
  const bool erases = tool_->mode() == tools::ToolMode::Eraser;
  QColor wash = erases ? excludedColour : draftColour;
  LineWork lines(rect());
  QPainterPath area;
  for (const Eigen::Matrix3Xd& ring : tool_->shape()) {
    const QPolygonF outline = toScreen(ring, shown);
    lines.add(outline, true, wash, 1.6, erases);
    area.addPolygon(outline);
    area.closeSubpath();
  }
  wash.setAlpha(60);
  painter.setPen(Qt::NoPen);
  painter.setBrush(wash);
  painter.drawPath(area);
  lines.paint(painter);
}

}  // namespace glisson::views
