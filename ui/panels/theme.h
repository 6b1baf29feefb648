// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QColor>
#include <QIcon>
#include <QString>

class QApplication;

namespace glisson::panels {

enum class Theme { Dark, Light };

/// Calm colours for the whole program: palette and style sheet.
void applyTheme(Theme theme);
Theme currentTheme();

/// An icon of resources/icons in the colour given (the palette's text colour where it is not valid), crisp at any
/// scale. Empty where Qt has no SVG plug-in: text stands beside every icon.
QIcon icon(const QString& name, const QColor& colour = {});

/// Colours that say something, told apart in both themes.
QColor accent();
QColor good();
QColor caution();
QColor bad();

/// Marks in slices and in the 3-D scene: the direction of the hoist, what holds the liver.
inline constexpr QColor hoistColour(120, 240, 150), holdColour(255, 150, 40);

}  // namespace glisson::panels
