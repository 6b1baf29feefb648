// SPDX-License-Identifier: GPL-3.0-or-later

// What the mouse does in a 3-D view, and what is drawn over its picture.
#include <QMouseEvent>
#include <QPainter>
#include <QWheelEvent>
#include <cmath>

#include "views/colour_map.h"
#include "views/live_layer.h"
#include "views/model_layer.h"
#include "views/picture_view.h"
#include "views/scene_view.h"

namespace glisson::views {

namespace {

constexpr double toolReach_px = 30.0;
constexpr double click_px = 3.0;

Eigen::Vector2d asVector(const QPointF& p) {
  return {p.x(), p.y()};
}

}  // namespace

void SceneView::mousePressEvent(QMouseEvent* event) {
  if (!hasPicture() || drag_ != Drag::None) return;
  pressed_ = last_ = event->position();
  dragged_ = false;
  if (event->button() == Qt::MiddleButton ||
      (event->button() == Qt::LeftButton && event->modifiers().testFlag(Qt::ShiftModifier))) {
    drag_ = Drag::Pan;
  } else if (event->button() == Qt::RightButton) {
    drag_ = Drag::Zoom;
  } else if (event->button() == Qt::LeftButton) {
    const auto seen = [this](const Eigen::Vector3d& p) { return std::optional(pixelOf(p)); };
    const Mark* mark = markAt(marks_, seen, pressed_);
    const auto tool = toolPixel();
    if (!placing_ && mark) {
      heldMark_ = mark->id;
      drag_ = mark->movable ? Drag::Mark : Drag::Turn;
      emit markChosen(heldMark_);
    } else if (tool && QLineF(*tool, pressed_).length() <= toolReach_px) {
      // The tool is taken by the mouse where the bar's contact is; anywhere else the mouse turns the camera.
      drag_ = Drag::Tool;
      gripMoved_mm_ = toolMoved_mm_;
      setCursor(Qt::ClosedHandCursor);
    } else {
      drag_ = Drag::Turn;
    }
  }
}

void SceneView::mouseMoveEvent(QMouseEvent* event) {
  const QPointF at = event->position();
  if (drag_ == Drag::None) return;
  const Eigen::Vector2d by = asVector(at - last_);
  last_ = at;
  if (!dragged_ && QLineF(at, pressed_).length() < click_px && drag_ != Drag::Tool) return;
  const Eigen::Vector2d sinceClick = dragged_ ? by : asVector(at - pressed_);
  dragged_ = true;
  switch (drag_) {
    case Drag::Turn:
      camera_.turn(sinceClick, size_px());
      moved();
      break;
    case Drag::Pan:
      camera_.pan(sinceClick, size_px());
      moved();
      break;
    case Drag::Zoom:
      camera_.zoom(std::exp(-0.01 * sinceClick.y()), asVector(pressed_), size_px());
      moved();
      break;
    case Drag::Tool: {
      const Eigen::Vector3d rest = *scene_->retractorPoint_lps_mm, held = rest + gripMoved_mm_;
      const Eigen::Vector3d from = camera_.toLps(asVector(pressed_), size_px(), held);
      emit toolDragged(gripMoved_mm_ + camera_.toLps(asVector(at), size_px(), held) - from);
      break;
    }
    case Drag::Mark:
      for (const Mark& mark : marks_) {
        if (mark.id != heldMark_) continue;
        const auto under = mark.onSurface ? surfaceUnder(at, mark.against) : std::nullopt;
        if (mark.onSurface && !under) break;  // off the liver it stays where it was
        emit markMoved(heldMark_, under ? *under : camera_.toLps(asVector(at), size_px(), mark.at_lps), false);
        break;
      }
      break;
    case Drag::None: break;
  }
}

void SceneView::mouseReleaseEvent(QMouseEvent* event) {
  const Drag drag = std::exchange(drag_, Drag::None);
  if (drag == Drag::Tool) unsetCursor();
  if (drag == Drag::Mark && dragged_)
    for (const Mark& mark : marks_)
      if (mark.id == heldMark_) {
        emit markMoved(heldMark_, Eigen::Vector3d(mark.at_lps), true);
        break;
      }
  if (placing_ && drag == Drag::Turn && !dragged_ && event->button() == Qt::LeftButton)
    if (const auto at = surfaceUnder(event->position())) emit surfaceClicked(*at);
}

void SceneView::mouseDoubleClickEvent(QMouseEvent* event) {
  if (event->button() == Qt::LeftButton && hasPicture() && !placing_) showAll();
}

void SceneView::showAll() {
  if (scene_) {
    compose(false);
    return;
  }
  fitModel();
  draw(false);
}

void SceneView::wheelEvent(QWheelEvent* event) {
  if (!hasPicture() || event->angleDelta().y() == 0) return;
  camera_.zoom(std::pow(1.0015, event->angleDelta().y()), asVector(event->position()), size_px());
  moved();
  event->accept();
}

void SceneView::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  if (image_.isNull()) {
    painter.fillRect(rect(), QColor(16, 18, 22));
    painter.setPen(QColor(150, 158, 168));
    painter.drawText(rect().adjusted(24, 24, -24, -24), Qt::AlignCenter | Qt::TextWordWrap, hint_);
    return;
  }
  const bool sharp = image_.width() == qRound(width() * devicePixelRatioF());
  painter.setRenderHint(QPainter::SmoothPixmapTransform, !sharp);
  painter.drawImage(QRectF(rect()), image_);
  if (model_) {
    paintAxes(painter);
    paintModelLegend(painter);
  }
  // Marks lie where the picture on screen shows their places, even while the next one is being made.
  paintMarks(painter, marks_, [this](const Eigen::Vector3d& p) {
    const Eigen::Vector2d px = shownCamera_.toPixel(p, size_px());
    return std::optional(QPointF(px.x(), px.y()));
  });
  if (hasFocus()) {
    painter.setBrush(Qt::NoBrush);
    painter.setPen(QPen(QColor(90, 160, 255, 150), 1.0));
    painter.drawRect(QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5));
    if (placing_) {  // where Enter places
      const QPointF middle(0.5 * width(), 0.5 * height());
      painter.drawLine(middle - QPointF(12, 0), middle + QPointF(12, 0));
      painter.drawLine(middle - QPointF(0, 12), middle + QPointF(0, 12));
    }
  }
  if (scene_ && !outdated_.isEmpty()) greyOut(painter, rect(), outdated_);
  if (caption_.isEmpty()) return;
  const QRectF room = QRectF(rect()).adjusted(14, 10, -14, -10);
  painter.setPen(QColor(198, 205, 214));
  painter.drawText(room, Qt::AlignLeft | Qt::AlignTop | Qt::TextWordWrap, caption_);
}

/// The patient's axes in a corner, and a bar of some centimetres: the projection is parallel, so it holds everywhere.
void SceneView::paintAxes(QPainter& painter) const {
  painter.setRenderHint(QPainter::Antialiasing);
  const QPointF origin(52, height() - 52);
  constexpr const char* letters[3] = {"L", "P", "S"};
  for (int a = 0; a < 3; ++a) {
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(a);
    const QPointF along(34.0 * shownCamera_.right().dot(axis), -34.0 * shownCamera_.up.dot(axis));
    if (std::hypot(along.x(), along.y()) < 8.0) continue;
    painter.setPen(QPen(QColor(170, 178, 188), 1.6));
    painter.drawLine(origin, origin + along);
    painter.setPen(QColor(235, 238, 242));
    painter.drawText(QRectF(origin + 1.32 * along - QPointF(10, 10), QSizeF(20, 20)), Qt::AlignCenter,
                     QString::fromLatin1(letters[a]));
  }
  const double scale = shownCamera_.px_per_mm(size_px());
  double bar_mm = 100.0;
  for (const double mm : {5.0, 10.0, 20.0, 50.0})
    if (scale * mm >= 70.0) {
      bar_mm = mm;
      break;
    }
  const double x = 110.0, y = height() - 26.0;
  painter.setPen(QPen(QColor(235, 238, 242), 2.0));
  painter.drawLine(QPointF(x, y), QPointF(x + scale * bar_mm, y));
  painter.drawLine(QPointF(x, y - 4), QPointF(x, y + 4));
  painter.drawLine(QPointF(x + scale * bar_mm, y - 4), QPointF(x + scale * bar_mm, y + 4));
  painter.drawText(QRectF(x, y - 24, scale * bar_mm, 18), Qt::AlignCenter, tr("%1 mm").arg(bar_mm, 0, 'f', 0));
}

void SceneView::paintModelLegend(QPainter& painter) const {
  if (!parts_.surface || !parts_.stiffness || model_->shear_kPa.size() == 0) return;
  const QRectF bar(width() - 74.0, 54.0, 14.0, std::max(120.0, 0.42 * height()));
  const auto& table = stiffnessColours();
  for (int n = 0; n < 256; ++n) {
    const double y = bar.bottom() - bar.height() * (n + 1) / 256.0;
    painter.fillRect(QRectF(bar.left(), y, bar.width(), bar.height() / 256.0 + 1.0),
                     table[static_cast<std::size_t>(n)]);
  }
  painter.setPen(QColor(235, 238, 242));
  painter.drawRect(bar);
  for (int n = 0; n <= 4; ++n) {
    const double y = bar.bottom() - bar.height() * n / 4.0;
    painter.drawLine(QPointF(bar.right(), y), QPointF(bar.right() + 4, y));
    painter.drawText(QRectF(bar.right() + 8, y - 9, 50, 18), Qt::AlignLeft | Qt::AlignVCenter,
                     QString::number(parts_.most_kPa * n / 4.0));
  }
  painter.drawText(QRectF(width() - 214.0, bar.top() - 34.0, 200.0, 20.0), Qt::AlignRight | Qt::AlignVCenter,
                   tr("shear modulus µ (kPa)"));
}

}  // namespace glisson::views
