// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/theme_choice.h"

#include <QApplication>
#include <QPalette>
#include <QSettings>

namespace glisson::panels {

namespace {

const QString themeKey = QStringLiteral("theme");
const QString darkName = QStringLiteral("dark"), lightName = QStringLiteral("light");

}  // namespace

std::optional<Theme> themeNamed(const QString& name) {
  if (name == darkName) return Theme::Dark;
  if (name == lightName) return Theme::Light;
  return std::nullopt;
}

Theme preferredTheme() {
  if (const auto chosen = themeNamed(QSettings().value(themeKey).toString())) return *chosen;
  const QPalette desktop = QApplication::palette();
  return desktop.color(QPalette::Window).lightness() < desktop.color(QPalette::WindowText).lightness() ? Theme::Dark
                                                                                                       : Theme::Light;
}

void rememberTheme(Theme theme) {
  QSettings().setValue(themeKey, theme == Theme::Light ? lightName : darkName);
}

}  // namespace glisson::panels
