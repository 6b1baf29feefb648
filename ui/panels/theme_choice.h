// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "panels/theme.h"

namespace glisson::panels {

std::optional<Theme> themeNamed(const QString& name);  ///< "dark" or "light"

/// What was chosen last; where nothing was, as dark or light as the desktop. Ask before applyTheme gives the program a
/// palette of its own.
Theme preferredTheme();
void rememberTheme(Theme theme);

}  // namespace glisson::panels
