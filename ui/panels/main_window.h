// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QMainWindow>
#include <functional>

#include "session/session.h"

class QAction;
class QFrame;
class QMenu;
class QLabel;
class QProgressBar;
class QPushButton;
class QStackedWidget;

namespace glisson::session {
class RunHistory;
}

namespace glisson::panels {

class ComparePage;
class KeySheet;
class Keys;
class LoadPage;
class ModelPage;
class RetractPage;
class SegmentPage;
class StepRail;

/// The window: the rail of five steps, one page each, and a status line with progress, time left and Cancel.
class MainWindow : public QMainWindow {
  Q_OBJECT
 public:
  explicit MainWindow(QWidget* parent = nullptr);

  session::Session& session() { return session_; }
  void showStep(session::Step step);
  session::Step step() const;
  void rememberPlace();  ///< takes the place on the screen that it had last, and keeps where it is closed

 public slots:
  void openFolder();
  void openSynthetic();
  void importOutlines();
  void importFrom(const QString& file);  ///< asks first where outlines would be replaced
  void saveCase();                       ///< where it was saved before; else asks
  void saveCaseAs();
  void openFiles();                                       ///< asks for a case, an archive or volumes
  void openPath(const QString& path);                     ///< a folder, DICOMDIR, ZIP, volume or case
  void openPaths(const QStringList& paths);               ///< several that belong together
  void takeRegion(const session::OfferedRegion& region);  ///< asks first where outlines would be replaced
  void loadSecondReader();
  void exportResults();
  void askAboutImages();  ///< what the session wants to know about the elastogram
  void run();
  void about();
  void showKeys();
  void showManual();
  void exportFormats();  ///< standard files, by a dialog
  void compareRuns();
  void showCohort();
  void showPacs();
  void deidentify();
  void showPreferences();

 protected:
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;
  void closeEvent(QCloseEvent* event) override;

 private:
  void makeMenus();
  void makeMouseMenu(QMenu& menu);
  void makeToolsMenu();
  template <typename Dialog>
  void openFrom(Dialog* dialog);
  void makeStatusLine();
  void connectSession();
  void refreshIcons();
  void updateStatus();
  bool placing() const;  ///< undo and redo are those of what is laid by hand
  void showProgress(double fraction, const QString& what, double secondsLeft);
  bool mayDiscard();  ///< asks where anything is not saved, and saves it where that is wanted
  bool mayReplaceOutlines();
  bool saveInto(QString folder);  ///< empty: asks for one. Whether all is saved now
  void askForMeaning(const QString& text);
  /// A question whose answer is one button or Cancel.
  bool confirmed(const char* name, const QString& title, const QString& text, const QString& more, const QString& yes);
  void offerRecovery();
  void remember(const QString& path);  ///< among the recent ones
  void fillRecent();
  /// Runs something that may fail on the user's files, and shows the reason where it does.
  void attempt(const QString& title, const std::function<void()>& work);

  session::Session session_;
  Keys* keys_;
  StepRail* rail_;
  QStackedWidget* pages_;
  LoadPage* load_;
  SegmentPage* segment_;
  ModelPage* model_;
  RetractPage* retract_;
  ComparePage* compare_;
  QProgressBar* progress_;
  QLabel* progressText_;
  QPushButton* cancel_;
  QMenu* recent_ = nullptr;
  QFrame* recovery_ = nullptr;
  KeySheet* sheet_ = nullptr;
  QAction *undoAction_ = nullptr, *redoAction_ = nullptr, *runAction_ = nullptr, *saveAction_ = nullptr,
          *importAction_ = nullptr, *interpolateAction_ = nullptr, *acceptAllAction_ = nullptr,
          *saveAsAction_ = nullptr, *exportAction_ = nullptr, *compareReadersAction_ = nullptr,
          *putAwayAction_ = nullptr, *formatsAction_ = nullptr;
  session::RunHistory* history_ = nullptr;
  bool remembers_ = false;  ///< its place on the screen
};

}  // namespace glisson::panels
