// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QLocale>
#include <QStringList>

#include "base/language.h"

namespace glisson::panels {

/// Texts of the program and of Qt itself (buttons of dialogs, names of keys) in this language, where there is a
/// catalogue for it among the program's resources; else they stay English. Before the first window is made.
void speak(const QLocale& language);

/// Codes of the languages that there are texts for: "en", "de".
QStringList languages();
/// What was chosen last; where nothing was, `otherwise`.
QLocale preferredLanguage(const QLocale& otherwise);
/// The language of what core writes for surgeons: that of the texts.
Language spoken();
/// From the next start on.
void rememberLanguage(const QString& code);

}  // namespace glisson::panels
