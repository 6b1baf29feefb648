// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QAbstractTableModel>
#include <QSortFilterProxyModel>

#include "session/cohort_table.h"

namespace glisson::panels {

QString wordsOf(const session::CohortFigure& figure);               ///< in the reader's language
QString titleOf(const session::CohortFigure& figure);               ///< with its unit: "Volume (mL)"
QString textOf(const session::CohortFigure& figure, double value);  ///< a dash where it is not known

/// A cohort as a table: number, state, figures, why a patient was left out.
class CohortModel : public QAbstractTableModel {
  Q_OBJECT
 public:
  static constexpr int idColumn = 0, stateColumn = 1, firstFigure = 2;
  static int reasonColumn();

  using QAbstractTableModel::QAbstractTableModel;
  void setCohort(session::Cohort cohort);
  const session::Cohort& cohort() const { return cohort_; }
  void setOpens(std::size_t patient, const std::filesystem::path& path) { cohort_.patients[patient].opens = path; }

  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;

 private:
  QString stateOf(const cohort::CaseRecord& record) const;
  session::Cohort cohort_;
};

/// Sorted by number where there is one, patients without a figure last; filtered by CohortFilter.
class CohortRows : public QSortFilterProxyModel {
  Q_OBJECT
 public:
  explicit CohortRows(CohortModel& model, QObject* parent = nullptr);
  void setFilter(const session::CohortFilter& filter);
  const session::CohortFilter& filter() const { return filter_; }

 protected:
  bool filterAcceptsRow(int row, const QModelIndex& parent) const override;
  bool lessThan(const QModelIndex& left, const QModelIndex& right) const override;

 private:
  CohortModel& model_;
  session::CohortFilter filter_;
};

}  // namespace glisson::panels
