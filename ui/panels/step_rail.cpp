// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/step_rail.h"

#include <QButtonGroup>
#include <QPainter>
#include <QPainterPath>
#include <QVBoxLayout>

#include "panels/theme.h"

namespace glisson::panels {

using session::Step;
using session::StepState;

namespace {

QString iconOf(Step step) {
  switch (step) {
    case Step::Load: return QStringLiteral("load");
    case Step::Segment: return QStringLiteral("segment");
    case Step::Model: return QStringLiteral("model");
    case Step::Retract: return QStringLiteral("retract");
    case Step::Compare: return QStringLiteral("compare");
  }
  return {};
}

QColor colourOf(StepState state, const QColor& faint) {
  switch (state) {
    case StepState::Done: return good();
    case StepState::Running: return accent();
    case StepState::Stale: return caution();
    case StepState::Failed: return bad();
    case StepState::Ready: return accent();
    case StepState::Empty: return faint;
  }
  return faint;
}

/// Each state has a shape of its own: colour is never the only sign.
void drawMark(QPainter& p, const QRectF& r, StepState state, const QColor& colour) {
  p.setPen(QPen(colour, 1.8, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
  p.setBrush(Qt::NoBrush);
  const QPointF c = r.center();
  const double h = r.width() / 2.0;
  switch (state) {
    case StepState::Empty: p.drawEllipse(c, h * 0.55, h * 0.55); break;
    case StepState::Ready:
      p.setBrush(colour);
      p.drawEllipse(c, h * 0.55, h * 0.55);
      break;
    case StepState::Running: p.drawArc(r, 90 * 16, -250 * 16); break;
    case StepState::Done:
      p.drawPolyline(QPolygonF({c + QPointF(-h, 0), c + QPointF(-h * 0.25, h * 0.75), c + QPointF(h, -h * 0.8)}));
      break;
    case StepState::Stale: {
      QPainterPath triangle(c + QPointF(0, -h));
      triangle.lineTo(c + QPointF(h, h * 0.8));
      triangle.lineTo(c + QPointF(-h, h * 0.8));
      triangle.closeSubpath();
      p.drawPath(triangle);
      break;
    }
    case StepState::Failed:
      p.drawLine(c + QPointF(-h, -h) * 0.75, c + QPointF(h, h) * 0.75);
      p.drawLine(c + QPointF(-h, h) * 0.75, c + QPointF(h, -h) * 0.75);
      break;
  }
}

}  // namespace

QString nameOf(Step step) {
  switch (step) {
    case Step::Load: return StepRail::tr("Load");
    case Step::Segment: return StepRail::tr("Segment");
    case Step::Model: return StepRail::tr("Model");
    case Step::Retract: return StepRail::tr("Retract");
    case Step::Compare: return StepRail::tr("Compare");
  }
  return {};
}

QString wordOf(StepState state) {
  switch (state) {
    case StepState::Empty: return StepRail::tr("empty");
    case StepState::Ready: return StepRail::tr("ready");
    case StepState::Running: return StepRail::tr("running");
    case StepState::Done: return StepRail::tr("done");
    case StepState::Stale: return StepRail::tr("stale");
    case StepState::Failed: return StepRail::tr("failed");
  }
  return {};
}

StepButton::StepButton(Step step, QWidget* parent) : QAbstractButton(parent), step_(step) {
  setCheckable(true);
  setText(nameOf(step));
  setObjectName(QStringLiteral("step") + QString::fromLatin1(std::array{"Load", "Segment", "Model", "Retract",
                                                                        "Compare"}[static_cast<std::size_t>(step)]));
  setSizePolicy(QSizePolicy::Fixed, QSizePolicy::Fixed);
  setShortcut(QKeySequence(Qt::CTRL | static_cast<Qt::Key>(Qt::Key_1 + static_cast<int>(step))));
}

void StepButton::setStatus(const session::StepStatus& status) {
  if (status_ == status) return;
  status_ = status;
  setToolTip(
      QStringLiteral("%1 (%2), %3: %4")
          .arg(nameOf(step_), shortcut().toString(QKeySequence::NativeText), wordOf(status.state), status.detail));
  setAccessibleDescription(toolTip());
  update();
}

void StepButton::paintEvent(QPaintEvent*) {
  QPainter p(this);
  p.setRenderHint(QPainter::Antialiasing);
  const QColor text = palette().color(QPalette::WindowText), faint = palette().color(QPalette::PlaceholderText);
  if (isChecked() || underMouse() || hasFocus()) {
    QColor wash = isChecked() ? accent() : text;
    wash.setAlphaF(isChecked() ? 0.18F : 0.07F);
    p.setPen(Qt::NoPen);
    p.setBrush(wash);
    p.drawRoundedRect(QRectF(rect()).adjusted(6, 3, -6, -3), 8, 8);
    if (isChecked()) {
      p.setBrush(accent());
      p.drawRoundedRect(QRectF(0, 16, 3, height() - 32), 1.5, 1.5);
    }
  }
  const QColor ink = status_.state == StepState::Empty && !isChecked() ? faint : text;
  panels::icon(iconOf(step_), isChecked() ? accent() : ink).paint(&p, QRect(width() / 2 - 14, 12, 28, 28));
  QFont bold = font();
  bold.setWeight(QFont::DemiBold);
  p.setFont(bold);
  p.setPen(ink);
  p.drawText(QRectF(0, 42, width(), 20), Qt::AlignCenter, nameOf(step_));
  QFont small = font();
  small.setPointSizeF(small.pointSizeF() * 0.85);
  p.setFont(small);
  const QColor colour = colourOf(status_.state, faint);
  const QString word = wordOf(status_.state);
  const double w = p.fontMetrics().horizontalAdvance(word);
  const double left = (width() - w - 16.0) / 2.0;
  drawMark(p, QRectF(left, 67, 9, 9), status_.state, colour);
  p.setPen(colour);
  p.drawText(QRectF(left + 15.0, 61, w + 4.0, 20), Qt::AlignVCenter | Qt::AlignLeft, word);
}

StepRail::StepRail(QWidget* parent) : QFrame(parent) {
  setObjectName(QStringLiteral("rail"));
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 10, 0, 10);
  layout->setSpacing(2);
  auto* group = new QButtonGroup(this);
  for (const Step step : session::steps) {
    auto* button = new StepButton(step, this);
    buttons_[static_cast<std::size_t>(step)] = button;
    group->addButton(button);
    layout->addWidget(button);
    connect(button, &QAbstractButton::clicked, this, [this, step] { emit stepChosen(step); });
  }
  layout->addStretch();
}

void StepRail::setStatus(Step step, const session::StepStatus& status) {
  buttons_[static_cast<std::size_t>(step)]->setStatus(status);
}

session::StepStatus StepRail::status(Step step) const {
  return buttons_[static_cast<std::size_t>(step)]->status();
}

void StepRail::setCurrent(Step step) {
  buttons_[static_cast<std::size_t>(step)]->setChecked(true);
}

}  // namespace glisson::panels
