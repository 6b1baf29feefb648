// SPDX-License-Identifier: GPL-3.0-or-later
#include <QApplication>
#include <QCommandLineParser>
#include <QLocale>
#include <QTimer>
#include <algorithm>
#include <array>
#include <iostream>
#include <string_view>
#include <thread>
#include <vector>

#include "base/version.h"
#include "panels/language.h"
#include "panels/main_window.h"
#include "panels/theme_choice.h"
#include "screenshot.h"

namespace {

using glisson::session::Step;

/// One step, or all of them; none where the name is none.
std::vector<Step> stepsNamed(const QString& name) {
  constexpr std::array names = {"load", "segment", "model", "retract", "compare"};
  if (name == QLatin1String("all")) return {glisson::session::steps.begin(), glisson::session::steps.end()};
  for (std::size_t i = 0; i < names.size(); ++i)
    if (name == QLatin1String(names[i])) return {glisson::session::steps[i]};
  return {};
}

/// Help and version need no display.
bool asksAboutTheProgram(int argc, char** argv) {
  constexpr std::array<std::string_view, 6> words = {"-h", "--help", "--help-all", "-?", "-v", "--version"};
  return std::any_of(argv + 1, argv + argc,
                     [&](const char* given) { return std::find(words.begin(), words.end(), given) != words.end(); });
}

}  // namespace

int main(int argc, char** argv) {
  QApplication::setApplicationName(QStringLiteral("glisson"));
  QApplication::setOrganizationName(QStringLiteral("glisson"));  // where settings lie
  QApplication::setApplicationDisplayName(QStringLiteral("Glisson"));
  QApplication::setApplicationVersion(QString::fromStdString(glisson::version()));
  QApplication::setDesktopFileName(QStringLiteral("glisson"));

  QCommandLineParser parser;
  parser.setApplicationDescription(QStringLiteral("Patient-specific biomechanics of the liver.\n") +
                                   QLatin1String(glisson::researchUseOnly) + QLatin1Char('.'));
  parser.addHelpOption();
  parser.addVersionOption();
  parser.addPositionalArgument(QStringLiteral("folder"),
                               QStringLiteral("DICOM folder, DICOMDIR, ZIP archive, volumes or case.json to open."),
                               QStringLiteral("[folder or files...]"));
  const QCommandLineOption synthetic(QStringLiteral("synthetic"), QStringLiteral("Open the synthetic patient."));
  const QCommandLineOption theme(QStringLiteral("theme"),
                                 QStringLiteral("dark or light; otherwise as chosen last, or as the desktop is."),
                                 QStringLiteral("name"));
  const QCommandLineOption outlines(QStringLiteral("outlines"),
                                    QStringLiteral("With --screenshot: outlines to import."), QStringLiteral("file"));
  const QCommandLineOption run(QStringLiteral("run"), QStringLiteral("With --screenshot: run before the picture."));
  const QCommandLineOption step(QStringLiteral("step"),
                                QStringLiteral("With --screenshot: load, segment, model, retract, compare or all."),
                                QStringLiteral("name"), QStringLiteral("segment"));
  const QCommandLineOption slice(QStringLiteral("slice"), QStringLiteral("With --screenshot: MRI slice, from 1."),
                                 QStringLiteral("n"), QStringLiteral("0"));
  const QCommandLineOption planes(
      QStringLiteral("planes"),
      QStringLiteral("With --screenshot: Segment with three planes, stiffness over the MRI."));
  const QCommandLineOption screenshot(
      QStringLiteral("screenshot"),
      QStringLiteral("Save a picture of the window as PNG (step all: into this folder) and quit."),
      QStringLiteral("file"));
  const QCommandLineOption language(QStringLiteral("language"),
                                    QStringLiteral("en or de; otherwise the one chosen last, or that of the desktop."),
                                    QStringLiteral("code"));
  parser.addOptions({synthetic, theme, language, screenshot, step, slice, planes, outlines, run});
  if (asksAboutTheProgram(argc, argv)) {
    const QCoreApplication withoutDisplay(argc, argv);
    parser.process(withoutDisplay);  // answers and ends
  }
  const QApplication app(argc, argv);
  const QLocale system = QLocale::system();
  // Numbers are shown and typed with a point everywhere, as in the scene files.
  QLocale::setDefault(QLocale::c());
  parser.process(app);
  const std::vector<Step> wantedSteps = stepsNamed(parser.value(step));
  const auto wantedTheme = glisson::panels::themeNamed(parser.value(theme));
  if (wantedSteps.empty() || (parser.isSet(theme) && !wantedTheme)) {
    std::cerr << "glisson: unknown step or theme; see glisson --help\n";
    return 2;
  }

  if (parser.isSet(run) && (!parser.isSet(screenshot) || !parser.isSet(outlines))) {
    std::cerr << "glisson: --run needs --screenshot and --outlines: without an outline there is nothing to retract\n";
    return 2;
  }

  glisson::panels::speak(parser.isSet(language) ? QLocale(parser.value(language))
                                                : glisson::panels::preferredLanguage(system));
  glisson::panels::applyTheme(wantedTheme ? *wantedTheme : glisson::panels::preferredTheme());
  // What windows that were killed left in the cache.
  const std::jthread cleaner([folder = glisson::session::Session::cacheFolder().toStdString()] {
    glisson::session::WorkFolder::removeAbandoned(folder);
  });
  glisson::panels::MainWindow window;
  if (!parser.isSet(screenshot)) window.rememberPlace();
  window.show();
  const bool opening = parser.isSet(synthetic) || !parser.positionalArguments().isEmpty();
  if (parser.isSet(screenshot)) {
    auto* picture =
        new glisson::Screenshot(window, {parser.value(screenshot), wantedSteps, parser.value(outlines),
                                         parser.isSet(run), parser.value(slice).toInt() - 1, parser.isSet(planes)});
    picture->start(opening);
  }
  if (parser.isSet(synthetic))
    window.session().openSynthetic();
  else if (opening)
    window.session().openPaths(parser.positionalArguments());
  return QApplication::exec();
}
