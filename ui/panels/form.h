#pragma once

#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QFrame>
#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>

#include "panels/theme.h"

namespace glisson::panels {

/// Small pieces that every page is made of.
inline QLabel* labelled(const QString& text, const char* role) {
  auto* label = new QLabel(text);
  label->setProperty("role", QString::fromLatin1(role));
  label->setWordWrap(true);
  return label;
}
inline QLabel* section(const QString& text) {
  return labelled(text.toUpper(), "section");
}

/// A number with its unit.
inline QDoubleSpinBox* quantity(const char* objectName, double low, double high, double step, int decimals,
                                const QString& unit, const QString& tip) {
  auto* box = new QDoubleSpinBox;
  box->setObjectName(QString::fromLatin1(objectName));
  box->setRange(low, high);
  box->setSingleStep(step);
  box->setDecimals(decimals);
  if (!unit.isEmpty()) box->setSuffix(QLatin1Char(' ') + unit);
  box->setToolTip(tip);
  box->setButtonSymbols(QAbstractSpinBox::NoButtons);  // wheel and arrow keys step it
  box->setKeyboardTracking(false);
  return box;
}

inline QPushButton* button(const char* objectName, const QString& text, const QString& iconName, const QString& tip) {
  auto* made = new QPushButton(text);
  made->setObjectName(QString::fromLatin1(objectName));
  made->setProperty("iconName", iconName);
  made->setToolTip(tip);
  return made;
}

/// The panel at the right of a page.
inline QFrame* sidePanel(QVBoxLayout*& layout, int width = 300) {
  auto* frame = new QFrame;
  frame->setObjectName(QStringLiteral("sidePanel"));
  frame->setFixedWidth(width);
  layout = new QVBoxLayout(frame);
  layout->setContentsMargins(16, 14, 16, 14);
  layout->setSpacing(8);
  return frame;
}

}  // namespace glisson::panels
