// SPDX-License-Identifier: GPL-3.0-or-later

// The menus of the window.
#include <QAction>
#include <QActionGroup>
#include <QCoreApplication>
#include <QDesktopServices>
#include <QMenuBar>
#include <QMessageBox>
#include <QStatusBar>
#include <QUrl>

#include "panels/help_pages.h"
#include "panels/language.h"
#include "panels/main_window.h"
#include "panels/mouse_habit.h"
#include "panels/segment_page.h"
#include "panels/theme_choice.h"
#include "views/slice_view.h"

namespace glisson::panels {

void MainWindow::makeMenus() {
  const auto add = [this](QMenu* menu, const char* name, const QString& text, const QKeySequence& keys, auto slot) {
    QAction* action = menu->addAction(text);
    action->setObjectName(QString::fromLatin1(name));
    action->setShortcut(keys);
    connect(action, &QAction::triggered, this, slot);
    return action;
  };
  QMenu* file = menuBar()->addMenu(tr("&File"));
  add(file, "openAction", tr("&Open DICOM folder…"), QKeySequence::Open, &MainWindow::openFolder);
  add(file, "openFilesAction", tr("Open &case, volumes or archive…"), QKeySequence(Qt::CTRL | Qt::SHIFT | Qt::Key_O),
      &MainWindow::openFiles);
  recent_ = file->addMenu(tr("&Recent"));
  recent_->setObjectName(QStringLiteral("recentMenu"));
  connect(recent_, &QMenu::aboutToShow, this, &MainWindow::fillRecent);
  add(file, "syntheticAction", tr("Synthetic &patient"), QKeySequence(Qt::CTRL | Qt::SHIFT | Qt::Key_N),
      &MainWindow::openSynthetic);
  file->addSeparator();
  importAction_ = add(file, "importAction", tr("&Import outlines…"), QKeySequence(Qt::CTRL | Qt::Key_I),
                      &MainWindow::importOutlines);
  saveAction_ = add(file, "saveAction", tr("&Save case"), QKeySequence::Save, &MainWindow::saveCase);
  saveAsAction_ = add(file, "saveAsAction", tr("Save case &as…"), QKeySequence(Qt::CTRL | Qt::SHIFT | Qt::Key_S),
                      &MainWindow::saveCaseAs);
  file->addSeparator();
  exportAction_ = add(file, "exportAction", tr("&Export pictures and report…"), QKeySequence(Qt::CTRL | Qt::Key_E),
                      &MainWindow::exportResults);
  file->addSeparator();
  add(file, "quitAction", tr("&Quit"), QKeySequence::Quit, &QWidget::close);
  QMenu* edit = menuBar()->addMenu(tr("&Edit"));
  undoAction_ = add(edit, "undoAction", tr("&Undo"), QKeySequence::Undo,
                    [this] { placing() ? session_.undoPlacement() : session_.undo(); });
  redoAction_ = add(edit, "redoAction", tr("&Redo"), QKeySequence(Qt::CTRL | Qt::SHIFT | Qt::Key_Z),
                    [this] { placing() ? session_.redoPlacement() : session_.redo(); });
  edit->addSeparator();
  interpolateAction_ =
      add(edit, "interpolateAction", tr("&Interpolate between slices"), {}, [this] { session_.interpolateOutlines(); });
  acceptAllAction_ = add(edit, "acceptAllAction", tr("&Accept all interpolated outlines"), {},
                         [this] { session_.acceptInterpolated(); });
  edit->addSeparator();
  add(edit, "secondReaderAction", tr("Load a &second reader's outlines…"), {}, &MainWindow::loadSecondReader);
  compareReadersAction_ =
      add(edit, "compareReadersAction", tr("&Compare both readers"), {}, [this] { session_.compareReaders(); });
  putAwayAction_ = add(edit, "putAwayReaderAction", tr("&Put the second reader's outlines away"), {},
                       [this] { session_.loadSecondReader({}); });
  QMenu* work = menuBar()->addMenu(tr("&Run"));
  runAction_ =
      add(work, "runAction", tr("&Build, retract and compare"), QKeySequence(Qt::CTRL | Qt::Key_R), &MainWindow::run);
  add(work, "cancelAction", tr("&Cancel"), QKeySequence(Qt::CTRL | Qt::Key_Period), [this] { session_.cancel(); });
  QMenu* view = menuBar()->addMenu(tr("&View"));
  auto* themes = new QActionGroup(this);
  for (const Theme theme : {Theme::Dark, Theme::Light}) {
    QAction* action = add(view, theme == Theme::Dark ? "darkTheme" : "lightTheme",
                          theme == Theme::Dark ? tr("&Dark theme") : tr("&Light theme"), {}, [this, theme] {
                            applyTheme(theme);
                            rememberTheme(theme);
                            refreshIcons();
                          });
    action->setCheckable(true);
    action->setChecked(theme == currentTheme());
    themes->addAction(action);
  }
  QMenu* languageMenu = view->addMenu(tr("&Language"));
  auto* chosen = new QActionGroup(this);
  const QString spoken = preferredLanguage(QLocale::system()).name().left(2);
  for (const QString& code : languages()) {
    // Each by its own name, so that it is found whatever is spoken.
    QAction* action =
        languageMenu->addAction(code == QStringLiteral("de") ? QStringLiteral("Deutsch") : QStringLiteral("English"));
    action->setObjectName(QStringLiteral("language-") + code);
    action->setCheckable(true);
    action->setChecked(code == spoken);
    chosen->addAction(action);
    connect(action, &QAction::triggered, this, [this, code] {
      rememberLanguage(code);
      statusBar()->showMessage(tr("The window speaks this language from its next start on."));
    });
  }
  makeMouseMenu(*view->addMenu(tr("&Mouse")));
  view->addSeparator();
  add(view, "planesAction", tr("&Three planes"), {}, [this] { segment_->run(tools::Command::Planes); });
  add(view, "fillAction", tr("One view &alone"), {}, [this] { segment_->run(tools::Command::FillWindow); });
  add(view, "fitAction", tr("&Fit images"), QKeySequence(Qt::CTRL | Qt::Key_0), [this] {
    segment_->mriView()->fit();
    segment_->mreView()->fit();
  });
  QMenu* help = menuBar()->addMenu(tr("&Help"));
  add(help, "keysAction", tr("&Keys and mouse"), QKeySequence(Qt::Key_F1), &MainWindow::showKeys);
  add(help, "manualAction", tr("&Manual"), QKeySequence(Qt::CTRL | Qt::Key_F1), &MainWindow::showManual);
  add(help, "aboutAction", tr("&About Glisson"), {}, &MainWindow::about);
}

void MainWindow::makeMouseMenu(QMenu& menu) {
  auto* habits = new QActionGroup(this);
  for (const RightDrag habit : {RightDrag::Zoom, RightDrag::Window}) {
    QAction* action =
        menu.addAction(habit == RightDrag::Zoom ? tr("Right drag &zooms") : tr("Right drag changes &window and level"));
    action->setObjectName(habit == RightDrag::Zoom ? QStringLiteral("rightDragZoom")
                                                   : QStringLiteral("rightDragWindow"));
    action->setCheckable(true);
    action->setChecked(habit == preferredRightDrag());
    habits->addAction(action);
    connect(action, &QAction::triggered, this, [this, habit] {
      rememberRightDrag(habit);
      applyRightDrag(habit, *this);
    });
  }
  applyRightDrag(preferredRightDrag(), *this);
}

void MainWindow::showManual() {
  const QString page = manualPage(QCoreApplication::applicationDirPath());
  if (page.isEmpty())
    QMessageBox::information(this, tr("Manual"),
                             tr("The manual is not installed beside this program. It is in the folder resources/manual "
                                "of the sources; packaging/manual makes HTML of it."));
  else
    QDesktopServices::openUrl(QUrl::fromLocalFile(page));
}

}  // namespace glisson::panels
