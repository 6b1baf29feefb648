// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QSettings>

#include "render/overlay.h"

namespace glisson::panels {

/// The colours of MRE and atlas: chosen on Compare, meant wherever both are shown, kept until another choice.
inline render::Palette chosenPalette() {
  return QSettings().value(QStringLiteral("palette")).toString() == QLatin1String("colour-blind")
             ? render::Palette::ColourBlind
             : render::Palette::RedBlue;
}
inline void choosePalette(render::Palette palette) {
  QSettings().setValue(QStringLiteral("palette"), palette == render::Palette::ColourBlind
                                                      ? QStringLiteral("colour-blind")
                                                      : QStringLiteral("red-blue"));
}

}  // namespace glisson::panels
