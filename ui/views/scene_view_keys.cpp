// SPDX-License-Identifier: GPL-3.0-or-later

// A 3-D view without a mouse: what the drags do, in steps.
#include <QKeyEvent>
#include <algorithm>

#include "views/scene_view.h"

namespace glisson::views {

namespace {

constexpr double turn_px = 30.0, pan_px = 40.0;  // of a key, as a drag this long
constexpr double zoomStep = 1.2;
constexpr double move_mm = 1.0, moveFar_mm = 10.0;

/// Of an arrow key, to the right and down.
std::optional<Eigen::Vector2d> directionOf(int key) {
  switch (key) {
    case Qt::Key_Left: return Eigen::Vector2d(-1.0, 0.0);
    case Qt::Key_Right: return Eigen::Vector2d(1.0, 0.0);
    case Qt::Key_Up: return Eigen::Vector2d(0.0, -1.0);
    case Qt::Key_Down: return Eigen::Vector2d(0.0, 1.0);
    default: return {};
  }
}

}  // namespace

void SceneView::keyPressEvent(QKeyEvent* event) {
  const bool ctrl = event->modifiers().testFlag(Qt::ControlModifier),
             shift = event->modifiers().testFlag(Qt::ShiftModifier);
  if (hasPicture() && drag_ == Drag::None) {
    if (const auto step = directionOf(event->key())) {
      if (ctrl) {
        moveChosen(*step * (shift ? moveFar_mm : move_mm));
      } else {
        shift ? camera_.pan(pan_px * *step, size_px()) : camera_.turn(turn_px * *step, size_px());
        moved();
      }
      return;
    }
    switch (event->key()) {
      case Qt::Key_Plus:
      case Qt::Key_Equal:
      case Qt::Key_Minus:
        camera_.zoom(event->key() == Qt::Key_Minus ? 1.0 / zoomStep : zoomStep, 0.5 * size_px(), size_px());
        moved();
        return;
      case Qt::Key_Home: showAll(); return;
      case Qt::Key_Space: chooseNext(); return;
      case Qt::Key_Return:
      case Qt::Key_Enter:
        if (!placing_) break;
        if (const auto at = surfaceUnder(QPointF(0.5 * width(), 0.5 * height()))) emit surfaceClicked(*at);
        return;
      default: break;
    }
  }
  QWidget::keyPressEvent(event);
}

/// The mark after the one that is chosen, round and round.
void SceneView::chooseNext() {
  if (marks_.empty()) return;
  auto next = std::find_if(marks_.begin(), marks_.end(), [](const Mark& mark) { return mark.current; });
  if (next == marks_.end() || ++next == marks_.end()) next = marks_.begin();
  emit markChosen(next->id);
}

/// In the plane of the view, by millimetres to the right and down; live, the tool.
void SceneView::moveChosen(const Eigen::Vector2d& by_mm) {
  const Eigen::Vector3d by = by_mm.x() * camera_.right() - by_mm.y() * camera_.up;
  if (isLive()) {
    emit toolDragged(toolMoved_mm_ + by);
    return;
  }
  for (const Mark& mark : marks_) {
    if (!mark.current || !mark.movable) continue;
    const int id = mark.id;
    const Eigen::Vector3d wanted = mark.at_lps + by;
    const Eigen::Vector2d px = camera_.toPixel(wanted, size_px());
    const auto under = mark.onSurface ? surfaceUnder({px.x(), px.y()}, mark.against) : std::nullopt;
    if (mark.onSurface && !under) return;  // off the liver it stays where it was
    emit markMoved(id, under ? *under : wanted, true);
    return;
  }
}

}  // namespace glisson::views
