#pragma once

class QLocale;

namespace glisson::panels {

/// Texts of the program and of Qt itself (buttons of dialogs, names of keys) in this language, where there is a
/// catalogue for it among the program's resources; else they stay English. Before the first window is made.
void speak(const QLocale& language);

}  // namespace glisson::panels
