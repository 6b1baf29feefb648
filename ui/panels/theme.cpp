// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/theme.h"

#include <QApplication>
#include <QBuffer>
#include <QFile>
#include <QImageReader>
#include <QPalette>
#include <QPixmap>
#include <QStyleFactory>

/// The icons are in a static library, whose resources only come along when asked for. Outside any namespace by Qt's
/// rule.
static void bringIcons() {
  Q_INIT_RESOURCE(icons);
}

namespace glisson::panels {

namespace {

Theme theme_ = Theme::Dark;

struct Colours {
  QColor window, base, raised, text, faint, border, accent, accentText;
};

Colours coloursOf(Theme theme) {
  if (theme == Theme::Dark)
    return {QColor(0x1b, 0x1f, 0x26), QColor(0x14, 0x17, 0x1d), QColor(0x27, 0x2d, 0x37), QColor(0xdf, 0xe5, 0xee),
            QColor(0x8b, 0x97, 0xa8), QColor(0x33, 0x3b, 0x48), QColor(0x4c, 0x8d, 0xff), QColor(Qt::white)};
  return {QColor(0xf3, 0xf5, 0xf8), QColor(0xff, 0xff, 0xff), QColor(0xe6, 0xea, 0xf0), QColor(0x1f, 0x27, 0x33),
          QColor(0x5d, 0x69, 0x7a), QColor(0xcb, 0xd2, 0xdc), QColor(0x1f, 0x66, 0xd6), QColor(Qt::white)};
}

QString styleSheet(const Colours& c) {
  QString css = QStringLiteral(R"(
    QWidget { font-size: 10pt; }
    QToolTip { background: %raised; color: %text; border: 1px solid %border; padding: 4px; }
    QMenuBar { background: %window; padding: 2px; } QMenuBar::item { padding: 4px 9px; border-radius: 4px; }
    QMenuBar::item:selected, QMenu::item:selected { background: %accent; color: %accentText; }
    QMenu { background: %raised; border: 1px solid %border; padding: 4px; } QMenu::item { padding: 5px 26px 5px 12px; }
    QMenu::item:disabled { color: %faint; } QMenu::separator { height: 1px; background: %border; margin: 4px 8px; }
    QPushButton { background: %raised; border: 1px solid %border; border-radius: 6px; padding: 6px 14px; }
    QPushButton:hover { border-color: %accent; } QPushButton:pressed { background: %base; }
    QPushButton:disabled { color: %faint; border-color: %raised; }
    QPushButton[primary="true"] { background: %accent; color: %accentText; border-color: %accent; font-weight: 600; }
    QPushButton[primary="true"]:disabled { background: %raised; color: %faint; border-color: %raised; }
    QPushButton[narrow="true"] { padding: 6px 4px; }
    QPushButton[flat="true"] { background: transparent; border-color: transparent; padding: 5px 8px; }
    QPushButton[flat="true"]:hover { background: %raised; } QPushButton[flat="true"]:disabled { color: %faint; }
    QPushButton:checked, QPushButton[flat="true"]:checked { background: %accent; color: %accentText; border-color: %accent; }
    QPushButton:focus { border: 1px solid %accent; }
    QSpinBox, QDoubleSpinBox, QLineEdit { background: %base; border: 1px solid %border; border-radius: 5px;
      padding: 3px 6px; min-height: 20px; selection-background-color: %accent; }
    QSpinBox:focus, QDoubleSpinBox:focus { border-color: %accent; }
    QCheckBox::indicator { width: 14px; height: 14px; border: 1px solid %faint; border-radius: 3px; background: %base; }
    QCheckBox::indicator:checked { background: %accent; border-color: %accent; image: url(:/icons/tick.svg); }
    QCheckBox::indicator:checked:disabled { background: %faint; border-color: %faint; }
    QCheckBox:focus { color: %accent; }
    QTreeWidget::item { padding: 4px 5px; } QDialogButtonBox { dialogbuttonbox-buttons-have-icons: 0; }
    QComboBox { background: %base; border: 1px solid %border; border-radius: 5px; padding: 3px 0 3px 6px; min-height: 20px; }
    QComboBox:hover, QComboBox:focus { border-color: %accent; } QComboBox:disabled { color: %faint; }
    QComboBox::drop-down { border: none; width: 22px; } QComboBox::down-arrow { image: url(:/icons/chevron.svg); width: 12px; }
    QTableWidget::item { padding: 2px 8px; }
    QComboBox QAbstractItemView { background: %raised; border: 1px solid %border; selection-background-color: %accent;
      selection-color: %accentText; outline: none; }
    QComboBox QAbstractItemView::item:selected { background: %accent; color: %accentText; }
    QTableWidget, QTreeWidget, QListWidget, QPlainTextEdit, QTextBrowser { background: %base; border: 1px solid %border;
      border-radius: 6px; alternate-background-color: %window; }
    QHeaderView::section { background: %window; color: %faint; border: none; border-bottom: 1px solid %border; padding: 5px; }
    QSplitter::handle { background: %window; } QSplitter::handle:hover { background: %accent; }
    QProgressBar { background: %base; border: 1px solid %border; border-radius: 5px; height: 12px; text-align: center; }
    QProgressBar::chunk { background: %accent; border-radius: 4px; }
    QSlider::groove:horizontal { height: 4px; background: %border; border-radius: 2px; }
    QSlider::sub-page:horizontal { background: %accent; border-radius: 2px; }
    QSlider::handle:horizontal { background: %text; width: 14px; height: 14px; margin: -5px 0; border-radius: 7px; }
    QStatusBar { background: %window; border-top: 1px solid %border; } QStatusBar::item { border: none; }
    QScrollArea { border: none; background: transparent; }
    QLabel[role="heading"] { font-size: 15pt; font-weight: 600; }
    QLabel[role="section"] { color: %faint; font-size: 8.5pt; font-weight: 700; }
    QLabel[role="faint"], QLabel:disabled { color: %faint; } QLabel[role="caution"] { color: %caution; font-weight: 600; }
    QLabel[role="number"] { font-size: 19pt; font-weight: 600; } QLabel#viewHint { background: #101216; color: #94a0b0; }
    QLabel#researchUse { color: %faint; font-weight: 600; padding: 0 8px; }
    QFrame[role="card"] { background: %base; border: 1px solid %border; border-radius: 8px; }
    QScrollArea#sidePanel { background: %window; border: none; border-left: 1px solid %border; }
    QWidget#sidePanelHeld { background: %window; }
    QFrame#recoveryBar { background: %raised; border-bottom: 1px solid %accent; }
    QFrame#rail { background: %base; border-right: 1px solid %border; }
  )");
  const auto put = [&css](const char* key, const QColor& colour) { css.replace(QLatin1String(key), colour.name()); };
  put("%accentText", c.accentText);
  put("%accent", c.accent);
  put("%caution", caution());
  put("%window", c.window);
  put("%base", c.base);
  put("%raised", c.raised);
  put("%text", c.text);
  put("%faint", c.faint);
  put("%border", c.border);
  return css;
}

}  // namespace

Theme currentTheme() {
  return theme_;
}

void applyTheme(Theme theme) {
  bringIcons();  // the style sheet names some
  theme_ = theme;
  const Colours c = coloursOf(theme);
  QPalette palette;
  palette.setColor(QPalette::Window, c.window);
  palette.setColor(QPalette::WindowText, c.text);
  palette.setColor(QPalette::Base, c.base);
  palette.setColor(QPalette::AlternateBase, c.window);
  palette.setColor(QPalette::Text, c.text);
  palette.setColor(QPalette::Button, c.raised);
  palette.setColor(QPalette::ButtonText, c.text);
  palette.setColor(QPalette::BrightText, c.accentText);
  palette.setColor(QPalette::Highlight, c.accent);
  palette.setColor(QPalette::HighlightedText, c.accentText);
  palette.setColor(QPalette::ToolTipBase, c.raised);
  palette.setColor(QPalette::ToolTipText, c.text);
  palette.setColor(QPalette::PlaceholderText, c.faint);
  palette.setColor(QPalette::Mid, c.border);
  palette.setColor(QPalette::Link, c.accent);
  for (const auto role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText})
    palette.setColor(QPalette::Disabled, role, c.faint);
  QApplication::setStyle(QStyleFactory::create(QStringLiteral("Fusion")));
  QApplication::setPalette(palette);
  qApp->setStyleSheet(styleSheet(c));
}

QIcon icon(const QString& name, const QColor& colour) {
  bringIcons();
  QFile file(QStringLiteral(":/icons/%1.svg").arg(name));
  if (!file.open(QIODevice::ReadOnly)) return {};
  QByteArray svg = file.readAll();
  const QColor wanted = colour.isValid() ? colour : QApplication::palette().color(QPalette::ButtonText);
  svg.replace("#000000", wanted.name().toLatin1());
  QIcon result;
  for (const int size : {16, 24, 32, 48, 64, 128}) {
    QBuffer buffer(&svg);
    QImageReader reader(&buffer, "svg");
    reader.setScaledSize({size, size});
    const QImage image = reader.read();
    if (image.isNull()) return {};
    result.addPixmap(QPixmap::fromImage(image));
  }
  return result;
}

QColor accent() {
  return coloursOf(theme_).accent;
}
QColor good() {
  return theme_ == Theme::Dark ? QColor(0x55, 0xc7, 0x8a) : QColor(0x1b, 0x86, 0x4d);
}
QColor caution() {
  return theme_ == Theme::Dark ? QColor(0xf0, 0xb4, 0x4a) : QColor(0xa8, 0x68, 0x00);
}
QColor bad() {
  return theme_ == Theme::Dark ? QColor(0xff, 0x76, 0x76) : QColor(0xc0, 0x2c, 0x2c);
}

}  // namespace glisson::panels
