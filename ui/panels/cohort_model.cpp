// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/cohort_model.h"

#include <QCoreApplication>
#include <cmath>

#include "panels/form.h"

namespace glisson::panels {

using cohort::CaseOutcome;
using session::CohortFigure;

QString wordsOf(const CohortFigure& figure) {
  return QCoreApplication::translate("cohort", figure.words);
}

QString titleOf(const CohortFigure& figure) {
  const QString words = wordsOf(figure);
  return figure.unit[0] == '\0' ? words : QStringLiteral("%1 (%2)").arg(words, QString::fromUtf8(figure.unit));
}

QString textOf(const CohortFigure& figure, double value) {
  return std::isfinite(value) ? QString::number(value, 'f', figure.decimals) : QStringLiteral("–");
}

int CohortModel::reasonColumn() {
  return firstFigure + static_cast<int>(session::cohortFigures().size());
}

void CohortModel::setCohort(session::Cohort cohort) {
  beginResetModel();
  cohort_ = std::move(cohort);
  endResetModel();
}

int CohortModel::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : static_cast<int>(cohort_.patients.size());
}

int CohortModel::columnCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : reasonColumn() + 1;
}

QString CohortModel::stateOf(const cohort::CaseRecord& record) const {
  switch (record.outcome.status) {
    case CaseOutcome::Status::Done: return tr("done");
    case CaseOutcome::Status::Rejected: return tr("left out");
    case CaseOutcome::Status::Failed: break;
  }
  return tr("failed");
}

QVariant CohortModel::data(const QModelIndex& index, int role) const {
  const cohort::CaseRecord& r = cohort_.patients[static_cast<std::size_t>(index.row())].record;
  const int column = index.column();
  const bool figure = column >= firstFigure && column < reasonColumn();
  if (role == Qt::TextAlignmentRole && figure) return QVariant(Qt::AlignRight | Qt::AlignVCenter);
  if (role == Qt::ToolTipRole && !r.warnings.empty()) {
    QStringList warnings;
    for (const std::string& w : r.warnings) warnings << sentence(w);
    return warnings.join(QLatin1Char('\n'));
  }
  if (role == Qt::UserRole && figure)
    return r.*session::cohortFigures()[static_cast<std::size_t>(column - firstFigure)].value;
  if (role != Qt::DisplayRole) return {};
  if (column == idColumn) return QString::fromStdString(r.outcome.id);
  if (column == stateColumn) return stateOf(r);
  if (column == reasonColumn()) return r.outcome.reason.empty() ? QString() : sentence(r.outcome.reason);
  const CohortFigure& f = session::cohortFigures()[static_cast<std::size_t>(column - firstFigure)];
  return textOf(f, r.*f.value);
}

QVariant CohortModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation != Qt::Horizontal || role != Qt::DisplayRole) return {};
  if (section == idColumn) return tr("Patient");
  if (section == stateColumn) return tr("State");
  if (section == reasonColumn()) return tr("Why");
  return titleOf(session::cohortFigures()[static_cast<std::size_t>(section - firstFigure)]);
}

CohortRows::CohortRows(CohortModel& model, QObject* parent) : QSortFilterProxyModel(parent), model_(model) {
  setSourceModel(&model);
}

void CohortRows::setFilter(const session::CohortFilter& filter) {
  filter_ = filter;
  invalidateFilter();
}

bool CohortRows::filterAcceptsRow(int row, const QModelIndex&) const {
  return filter_.passes(model_.cohort().patients[static_cast<std::size_t>(row)]);
}

bool CohortRows::lessThan(const QModelIndex& left, const QModelIndex& right) const {
  const QVariant a = left.data(Qt::UserRole), b = right.data(Qt::UserRole);
  if (!a.isValid() || !b.isValid()) return QSortFilterProxyModel::lessThan(left, right);
  const double x = a.toDouble(), y = b.toDouble();
  // Without a figure: last, whichever way it is sorted.
  if (!std::isfinite(x) || !std::isfinite(y)) {
    if (std::isfinite(x) == std::isfinite(y)) return false;
    return std::isfinite(x) == (sortOrder() == Qt::AscendingOrder);
  }
  return x < y;
}

}  // namespace glisson::panels
