// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>

#include "session/offered_regions.h"

class QFrame;
class QLabel;
class QPushButton;
class QStackedWidget;
class QTreeWidget;

namespace glisson::session {
class Session;
}

namespace glisson::panels {

class RegionList;
class SeriesTree;

/// Load: what was found in the folder, what each series is for and why; the role can be corrected.
class LoadPage : public QWidget {
  Q_OBJECT
 public:
  explicit LoadPage(session::Session& session, QWidget* parent = nullptr);
  bool correcting() const;  ///< a role was corrected here: the reader goes on when ready

 signals:
  void openWanted();
  void syntheticWanted();
  void filesWanted();                                                ///< volumes, an archive or a case
  void regionWanted(const glisson::session::OfferedRegion& region);  ///< as outlines
  void segmentWanted();                                              ///< the roles are right: on to the outlines
  void pathWanted(const QString& path);                              ///< a recent one
  void answerWanted();  ///< to what the session wants to know about the elastogram

 private:
  QWidget* makeWelcome();
  QWidget* makeTable();
  void fill();
  void showNotice();  ///< why nothing was opened, or why the elastogram is left out
  session::Session& session_;
  QStackedWidget* stack_;
  SeriesTree* tree_;
  RegionList* regions_;
  QTreeWidget* skipped_;
  QLabel *summary_, *noticeText_, *regionsHead_ = nullptr;
  QFrame* notice_;
  QPushButton *answer_, *next_ = nullptr;
};

}  // namespace glisson::panels
