// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QAbstractButton>
#include <QFrame>
#include <array>

#include "session/step.h"

namespace glisson::panels {

/// One step of the rail: icon, name, and its state in shape, colour and words.
class StepButton : public QAbstractButton {
  Q_OBJECT
 public:
  StepButton(session::Step step, QWidget* parent);
  void setStatus(const session::StepStatus& status);
  const session::StepStatus& status() const { return status_; }
  QSize sizeHint() const override { return {118, 92}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  session::Step step_;
  session::StepStatus status_;
};

/// The rail on the left: the five steps of the work. Every step can be looked at at any time.
class StepRail : public QFrame {
  Q_OBJECT
 public:
  explicit StepRail(QWidget* parent = nullptr);
  void setStatus(session::Step step, const session::StepStatus& status);
  session::StepStatus status(session::Step step) const;
  void setCurrent(session::Step step);

 signals:
  void stepChosen(glisson::session::Step step);

 private:
  std::array<StepButton*, 5> buttons_{};
};

/// The step's name as shown.
QString nameOf(session::Step step);
/// A word for the state.
QString wordOf(session::StepState state);

}  // namespace glisson::panels
