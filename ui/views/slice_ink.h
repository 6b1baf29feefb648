// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QColor>
#include <QPainter>
#include <QPolygonF>

#include "tools/slice_plane.h"

namespace glisson::views {

/// Colours of what is drawn over slices, the same in both themes: images are always on dark paper.
inline const QColor paper(16, 18, 22);
inline const QColor ink(226, 232, 240);
inline const QColor faint(148, 160, 176);
inline const QColor acceptedColour(255, 209, 71);
inline const QColor draftColour(110, 205, 255);
inline const QColor crossingColour(255, 82, 160);
inline const QColor excludedColour(255, 140, 66);
inline const QColor secondColour(196, 148, 255);
inline const QColor measureColour(120, 240, 180);

inline QPointF point(const Eigen::Vector2d& p) {
  return {p.x(), p.y()};
}

/// LPS mm as logical pixels.
inline QPolygonF toScreen(const Eigen::Matrix3Xd& points, const tools::SlicePlane& plane) {
  QPolygonF polygon;
  polygon.reserve(points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i) polygon << point(plane.toPixel(points.col(i)));
  return polygon;
}

/// A vertex that can be taken hold of.
inline void drawHandle(QPainter& painter, const QPointF& at, const QColor& colour, bool strong) {
  const double r = strong ? 4.5 : 3.0;
  painter.setPen(QPen(QColor(0, 0, 0, 190), 1.2));
  painter.setBrush(strong ? QColor(Qt::white) : colour);
  painter.drawRect(QRectF(at.x() - r, at.y() - r, 2 * r, 2 * r));
}

}  // namespace glisson::views
