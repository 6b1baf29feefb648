// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/language.h"

#include <QCoreApplication>
#include <QSettings>
#include <QTranslator>

namespace glisson::panels {

namespace {

const QString languageKey = QStringLiteral("language");
Language now = Language::English;

}  // namespace

QStringList languages() {
  return {QStringLiteral("en"), QStringLiteral("de")};
}

QLocale preferredLanguage(const QLocale& otherwise) {
  const QString code = QSettings().value(languageKey).toString();
  return languages().contains(code) ? QLocale(code) : otherwise;
}

Language spoken() {
  return now;
}

void rememberLanguage(const QString& code) {
  QSettings().setValue(languageKey, code);
}

void speak(const QLocale& language) {
  for (const char* catalogue : {"qtbase", "glisson"}) {
    auto* translator = new QTranslator(QCoreApplication::instance());
    if (translator->load(language, QString::fromLatin1(catalogue), QStringLiteral("_"),
                         QStringLiteral(":/translations")))
      QCoreApplication::installTranslator(translator);
    else
      delete translator;
  }
  now = language.language() == QLocale::German ? Language::German : Language::English;
}

}  // namespace glisson::panels
