// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "panels/work_dialog.h"
#include "session/cohort_table.h"

class QComboBox;
class QTableView;
class QTimer;

namespace glisson::panels {

class ChartView;
class CohortModel;
class CohortRows;

/// A cohort: a table that is sorted and filtered, histogram and box plot of one figure over what is shown, each of
/// which leads to a patient.
class CohortWindow : public WorkDialog {
  Q_OBJECT
 public:
  explicit CohortWindow(QWidget* parent = nullptr);
  void read(const QString& folder);

 signals:
  void openWanted(const QString& path);  ///< a patient

 protected:
  void refresh() override;

 private:
  QWidget* makeTop();
  QWidget* makeTable();
  QWidget* makeCharts();
  const session::CohortFigure& figure() const;
  std::vector<std::size_t> shown() const;
  std::optional<std::size_t> current() const;
  void filter();
  void drawCharts();
  void choose(const std::vector<std::size_t>& patients, bool open);
  void openCurrent();
  void openCertain(const std::filesystem::path& path);
  QLineEdit *folder_, *text_, *low_, *high_;
  QComboBox* figure_;
  CohortModel* model_;
  CohortRows* rows_;
  QTableView* table_;
  ChartView *histogram_, *boxes_;
  QLabel *counts_, *numbers_, *said_;
  QPushButton* open_ = nullptr;
  QTimer* soon_;      ///< charts follow a moment after what they show
  QString patients_;  ///< folder of the patients of results
};

}  // namespace glisson::panels
