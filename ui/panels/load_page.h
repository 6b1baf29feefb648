#pragma once

#include <QWidget>

#include "session/worker.h"

class QFrame;
class QLabel;
class QPushButton;
class QStackedWidget;
class QTableWidget;
class QTreeWidget;

namespace glisson::session {
class Session;
}

namespace glisson::panels {

/// Load: what was found in the folder, what each series is for and why; the role can be corrected.
class LoadPage : public QWidget {
  Q_OBJECT
 public:
  explicit LoadPage(session::Session& session, QWidget* parent = nullptr);
  bool correcting() const { return correcting_; }  ///< a role was corrected here: the reader goes on when ready

 signals:
  void openWanted();
  void syntheticWanted();
  void segmentWanted();                  ///< the roles are right: on to the outlines
  void pathWanted(const QString& path);  ///< a recent one
  void answerWanted();                   ///< to what the session wants to know about the elastogram

 private:
  QWidget* makeWelcome();
  QWidget* makeTable();
  void fill();
  void drawThumbnails();
  void showNotice();  ///< why nothing was opened, or why the elastogram is left out
  session::Session& session_;
  QStackedWidget* stack_;
  QTableWidget* table_;
  QTreeWidget* skipped_;
  QLabel *summary_, *noticeText_;
  QFrame* notice_;
  QPushButton *answer_, *next_ = nullptr;
  bool correcting_ = false;
  session::Worker painter_;  ///< of thumbnails
};

}  // namespace glisson::panels
