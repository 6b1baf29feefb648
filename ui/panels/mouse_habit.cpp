// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/mouse_habit.h"

#include <QSettings>

#include "views/slice_view.h"

namespace glisson::panels {

namespace {

const QString habitKey = QStringLiteral("mouse/rightDrag");
const QString windowName = QStringLiteral("window"), zoomName = QStringLiteral("zoom");

}  // namespace

RightDrag preferredRightDrag() {
  return QSettings().value(habitKey).toString() == windowName ? RightDrag::Window : RightDrag::Zoom;
}

void rememberRightDrag(RightDrag what) {
  QSettings().setValue(habitKey, what == RightDrag::Window ? windowName : zoomName);
}

void applyRightDrag(RightDrag what, QWidget& below) {
  for (views::SliceView* view : below.findChildren<views::SliceView*>())
    view->setRightDragWindows(what == RightDrag::Window);
}

}  // namespace glisson::panels
