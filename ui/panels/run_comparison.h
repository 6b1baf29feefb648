// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "panels/work_dialog.h"
#include "session/run_figures.h"

class QComboBox;
class QTreeWidget;

namespace glisson::panels {

/// Two runs side by side: figures with their difference, and what was set otherwise.
class RunComparison : public WorkDialog {
  Q_OBJECT
 public:
  explicit RunComparison(session::RunHistory& history, QWidget* parent = nullptr);
  void addFrom(const QString& folder);  ///< one more run to choose, put second

 private:
  void fill();
  void show_();
  void showFigures(const session::RunsBeside& both);
  void showSettings(const session::RunsBeside& both);
  const session::RunRecord* chosen(const QComboBox* box) const;
  session::RunHistory& history_;
  std::vector<session::RunRecord> others_;  ///< read from folders
  std::vector<session::RunRecord> all_;     ///< as listed in both boxes
  QComboBox *first_, *second_;
  QTreeWidget *figures_, *settings_;
  QLabel* said_;
  QPushButton* other_;
};

}  // namespace glisson::panels
