#include "panels/language.h"

#include <QCoreApplication>
#include <QLocale>
#include <QTranslator>

namespace glisson::panels {

void speak(const QLocale& language) {
  for (const char* catalogue : {"qtbase", "glisson"}) {
    auto* translator = new QTranslator(QCoreApplication::instance());
    if (translator->load(language, QString::fromLatin1(catalogue), QStringLiteral("_"),
                         QStringLiteral(":/translations")))
      QCoreApplication::installTranslator(translator);
    else
      delete translator;
  }
}

}  // namespace glisson::panels
