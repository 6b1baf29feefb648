// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QFrame>
#include <QLabel>
#include <QPushButton>
#include <QScrollArea>
#include <QVBoxLayout>
#include <string>
#include <utility>

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

inline QString withStop(QString text) {
  if (!text.isEmpty() && !text.endsWith(QLatin1Char('.'))) text += QLatin1Char('.');
  return text;
}
/// What the numerics say, as a sentence of its own.
inline QString sentence(QString text) {
  if (!text.isEmpty()) text[0] = text[0].toUpper();
  return withStop(std::move(text));
}
inline QString sentence(const std::string& text) {
  return sentence(QString::fromStdString(text));
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

/// The panel at the right of a page. It scrolls where the window is lower than what it holds.
class SidePanel : public QScrollArea {
 public:
  explicit SidePanel(QWidget* parent = nullptr) : QScrollArea(parent) {
    setObjectName(QStringLiteral("sidePanel"));
    setFixedWidth(300);
    setWidgetResizable(true);
    setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    auto* held = new QWidget;
    held->setObjectName(QStringLiteral("sidePanelHeld"));
    column_ = new QVBoxLayout(held);
    column_->setContentsMargins(16, 14, 16, 14);
    column_->setSpacing(8);
    setWidget(held);
  }
  QVBoxLayout* column() const { return column_; }

 private:
  QVBoxLayout* column_;
};

}  // namespace glisson::panels
