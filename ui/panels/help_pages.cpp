// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/help_pages.h"

#include <QFileInfo>

namespace glisson::panels {

QString manualPage(const QString& programFolder) {
  for (const char* place :
       {"../share/doc/glisson/manual/html/index.html", "../share/doc/Glisson/manual/html/index.html",
        "../../manual/html/index.html", "../../../manual/html/index.html"}) {
    const QFileInfo page(programFolder + QLatin1Char('/') + QLatin1String(place));
    if (page.isFile()) return page.canonicalFilePath();
  }
  return {};
}

}  // namespace glisson::panels
