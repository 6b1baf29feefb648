// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/quiet_wheel.h"

#include <QAbstractSpinBox>
#include <QApplication>
#include <QComboBox>
#include <QEvent>
#include <QSlider>

namespace glisson::panels {

namespace {

class QuietWheel : public QObject {
 public:
  using QObject::QObject;
  bool eventFilter(QObject* watched, QEvent* event) override {
    if (event->type() != QEvent::Wheel && event->type() != QEvent::Polish && event->type() != QEvent::Show)
      return false;
    auto* field = qobject_cast<QWidget*>(watched);
    if (!field ||
        !(qobject_cast<QAbstractSpinBox*>(field) || qobject_cast<QComboBox*>(field) || qobject_cast<QSlider*>(field)))
      return false;
    if (event->type() != QEvent::Wheel) {
      // By itself the wheel would take the focus first.
      if (field->focusPolicy() == Qt::WheelFocus) field->setFocusPolicy(Qt::StrongFocus);
      return false;
    }
    if (field->hasFocus()) return false;
    event->ignore();  // so that it goes on to what holds the field
    return true;
  }
};

}  // namespace

void keepWheelForScrolling() {
  static const QString name = QStringLiteral("quietWheel");
  if (qApp->findChild<QObject*>(name, Qt::FindDirectChildrenOnly)) return;
  auto* filter = new QuietWheel(qApp);
  filter->setObjectName(name);
  qApp->installEventFilter(filter);
}

}  // namespace glisson::panels
