// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>

namespace glisson::panels {

/// The first page of the manual as HTML, for a program that lies in this folder: of an installed program that below
/// share/doc, of one that was built that of the build tree. Empty where the manual was not built.
QString manualPage(const QString& programFolder);

}  // namespace glisson::panels
