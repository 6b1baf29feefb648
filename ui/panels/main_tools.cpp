// SPDX-License-Identifier: GPL-3.0-or-later

// What goes beyond the patient that is open: export, cohort, runs side by side, PACS, de-identification, preferences.
#include <QAction>
#include <QMenu>
#include <QMenuBar>

#include "base/error.h"
#include "panels/cohort_window.h"
#include "panels/deidentify_dialog.h"
#include "panels/export_dialog.h"
#include "panels/language.h"
#include "panels/main_window.h"
#include "panels/pacs_dialog.h"
#include "panels/preferences_dialog.h"
#include "panels/run_comparison.h"
#include "session/export_formats.h"
#include "session/run_figures.h"

namespace glisson::panels {

namespace {

/// One dialog of its kind for each window, which stays open beside it.
template <typename Dialog, typename Make>
Dialog* shown(MainWindow& window, const Make& make) {
  auto* dialog = window.findChild<Dialog*>();
  if (!dialog) dialog = make();
  dialog->show();
  dialog->raise();
  dialog->activateWindow();
  return dialog;
}

}  // namespace

void MainWindow::makeToolsMenu() {
  history_ = new session::RunHistory(session_, this);
  auto* tools = new QMenu(tr("&Tools"), menuBar());
  menuBar()->insertMenu(menuBar()->actions().last(), tools);  // Help stays the last
  const auto add = [this, tools](const char* name, const QString& text, const QKeySequence& keys, auto slot) {
    QAction* action = tools->addAction(text);
    action->setObjectName(QString::fromLatin1(name));
    action->setShortcut(keys);
    connect(action, &QAction::triggered, this, slot);
    return action;
  };
  formatsAction_ = add("exportFormatsAction", tr("&Export DICOM, NIfTI, VTK, Slicer, SOFA…"),
                       QKeySequence(Qt::CTRL | Qt::SHIFT | Qt::Key_E), &MainWindow::exportFormats);
  add("compareRunsAction", tr("&Compare two runs…"), {}, &MainWindow::compareRuns);
  add("cohortAction", tr("C&ohort…"), {}, &MainWindow::showCohort);
  tools->addSeparator();
  add("pacsAction", tr("&PACS…"), {}, &MainWindow::showPacs);
  add("deidentifyAction", tr("&De-identify a folder…"), {}, &MainWindow::deidentify);
  tools->addSeparator();
  add("preferencesAction", tr("P&references…"), QKeySequence::Preferences, &MainWindow::showPreferences)
      ->setMenuRole(QAction::PreferencesRole);
}

void MainWindow::exportFormats() {
  if (!session_.images().mri || session_.busy()) return;
  attempt(tr("Export"), [this] {
    auto* dialog = new ExportDialog(session_.exportSource(), this);
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    dialog->open();
  });
}

/// What a dialog wants opened; it gives way, and comes back as it was.
template <typename Dialog>
void MainWindow::openFrom(Dialog* dialog) {
  connect(dialog, &Dialog::openWanted, this, [this, dialog](const QString& path) {
    dialog->hide();
    openPath(path);
  });
}

void MainWindow::compareRuns() {
  shown<RunComparison>(*this, [this] { return new RunComparison(*history_, this); });
}

void MainWindow::showCohort() {
  shown<CohortWindow>(*this, [this] {
    auto* cohort = new CohortWindow(this);
    openFrom(cohort);
    return cohort;
  });
}

void MainWindow::showPacs() {
  const auto source = [this]() -> std::shared_ptr<const session::ExportSource> {
    if (!session_.images().mri || session_.busy()) return nullptr;
    try {
      return std::make_shared<const session::ExportSource>(session_.exportSource());
    } catch (const BadInput&) {
      return nullptr;  // no room for a private folder: then nothing of what is shown is offered
    }
  };
  shown<PacsDialog>(*this, [this, source] {
    auto* pacs = new PacsDialog(source, this);
    openFrom(pacs);
    return pacs;
  });
}

void MainWindow::deidentify() {
  shown<DeidentifyDialog>(*this, [this] {
    auto* dialog = new DeidentifyDialog(this);
    openFrom(dialog);
    return dialog;
  });
}

void MainWindow::showPreferences() {
  shown<PreferencesDialog>(*this, [this] {
    auto* dialog = new PreferencesDialog(this);
    const auto entries = [this](const QStringList& names) {
      QList<QAction*> found;
      for (const QString& name : names) found << findChild<QAction*>(name);
      return found;
    };
    dialog->addChoice("preferredTheme", tr("Theme"),
                      entries({QStringLiteral("darkTheme"), QStringLiteral("lightTheme")}));
    QStringList codes;
    for (const QString& code : languages()) codes << QStringLiteral("language-") + code;
    dialog->addChoice("preferredLanguage", tr("Language, from the next start on"), entries(codes));
    dialog->addChoice("preferredRightDrag", tr("Mouse, over an image"),
                      entries({QStringLiteral("rightDragZoom"), QStringLiteral("rightDragWindow")}));
    dialog->addSheet(tr("Keys"), findChild<QAction*>(QStringLiteral("keysAction")), tr("Look at and change…"));
    dialog->addSheet(tr("PACS"), findChild<QAction*>(QStringLiteral("pacsAction")), tr("Servers…"));
    return dialog;
  });
}

}  // namespace glisson::panels
