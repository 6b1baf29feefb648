// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <QColor>
#include <QPointF>
#include <QString>
#include <functional>
#include <optional>
#include <vector>

class QPainter;

namespace glisson::views {

/// A place that is drawn over a view, slice or 3-D, and that the mouse can choose or move.
struct Mark {
  enum class Shape { Dot, Ring, Square, Diamond };
  int id = 0;
  Eigen::Vector3d at_lps = Eigen::Vector3d::Zero();
  Shape shape = Shape::Dot;
  QColor colour = Qt::white;
  QString text{};                             ///< beside it; may be empty
  std::optional<Eigen::Vector3d> from_lps{};  ///< a line from there; with an arrow's head where `arrow`
  bool arrow = false;
  bool movable = false;
  bool onSurface = false;                    ///< moves over the liver's surface, else across the view
  std::optional<Eigen::Vector3d> against{};  ///< onSurface: only where it looks against this direction
  bool current = false;                      ///< chosen: larger, with a border
};

/// Where a point is seen, logical pixels; nothing where this view does not show it.
using Projection = std::function<std::optional<QPointF>(const Eigen::Vector3d& p_lps)>;

void paintMarks(QPainter& painter, const std::vector<Mark>& marks, const Projection& seenAt);
/// The mark under the mouse, the last drawn first.
const Mark* markAt(const std::vector<Mark>& marks, const Projection& seenAt, const QPointF& at);

}  // namespace glisson::views
