#pragma once

#include <QMainWindow>
#include <functional>

#include "session/session.h"

class QAction;
class QLabel;
class QProgressBar;
class QPushButton;
class QStackedWidget;

namespace glisson::panels {

class ComparePage;
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

 public slots:
  void openFolder();
  void openSynthetic();
  void importOutlines();
  void saveCase();
  void run();
  void about();

 protected:
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;
  void closeEvent(QCloseEvent* event) override;

 private:
  void makeMenus();
  void makeStatusLine();
  void connectSession();
  void refreshIcons();
  void updateStatus();
  void showProgress(double fraction, const QString& what, double secondsLeft);
  bool mayDiscard();
  /// Runs something that may fail on the user's files, and shows the reason where it does.
  void attempt(const QString& title, const std::function<void()>& work);

  session::Session session_;
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
  QAction *undoAction_ = nullptr, *redoAction_ = nullptr, *runAction_ = nullptr, *saveAction_ = nullptr,
          *importAction_ = nullptr, *interpolateAction_ = nullptr, *acceptAllAction_ = nullptr;
};

}  // namespace glisson::panels
