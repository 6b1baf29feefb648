// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QTreeWidget>
#include <vector>

#include "session/worker.h"

namespace glisson::session {
class Session;
}

namespace glisson::panels {

/// Patient, study, series: what was found, with pictures, dates and a tick for what is in use; ticking a series takes
/// it, and its role can be corrected.
class SeriesTree : public QTreeWidget {
  Q_OBJECT
 public:
  explicit SeriesTree(session::Session& session, QWidget* parent = nullptr);
  void fill();                                     ///< from the session's scan
  QTreeWidgetItem* itemOf(int series) const;       ///< index of scan().series; null where there is none
  bool correcting() const { return correcting_; }  ///< a role was corrected here: the reader goes on when ready
  /// Columns.
  enum Column { Name, Use, Role, Why, Voxels, Spacing, Warnings };

 private:
  QTreeWidgetItem* addSeries(QTreeWidgetItem* study, int series);
  void drawThumbnails();
  void take(int series);
  session::Session& session_;
  std::vector<QTreeWidgetItem*> items_;  ///< by series
  bool filling_ = false, correcting_ = false;
  session::Worker painter_;  ///< of thumbnails
};

}  // namespace glisson::panels
