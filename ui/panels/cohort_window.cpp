// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/cohort_window.h"

#include <QComboBox>
#include <QCoreApplication>
#include <QDoubleValidator>
#include <QFileDialog>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QItemSelectionModel>
#include <QLineEdit>
#include <QMessageBox>
#include <QPushButton>
#include <QSplitter>
#include <QTableView>
#include <QTimer>
#include <cmath>

#include "cohort/statistics.h"
#include "panels/chart_view.h"
#include "panels/cohort_model.h"
#include "panels/form.h"
#include "render/colour_map.h"

namespace glisson::panels {

using session::CohortFigure;

CohortWindow::CohortWindow(QWidget* parent)
    : WorkDialog("cohortWindow", tr("Cohort"), parent), model_(new CohortModel(this)), soon_(new QTimer(this)) {
  rows_ = new CohortRows(*model_, this);
  form()->addWidget(makeTop());
  auto* split = new QSplitter;
  split->setChildrenCollapsible(false);
  split->addWidget(makeTable());
  split->addWidget(makeCharts());
  split->setSizes({680, 620});
  form()->addWidget(split, 1);
  said_ = labelled({}, "text");
  said_->setObjectName(QStringLiteral("cohortSaid"));
  form()->addWidget(said_);
  open_ = addStart("cohortOpen", tr("Open patient"));
  open_->setToolTip(tr("Shows the patient chosen in the table in the window"));
  connect(open_, &QPushButton::clicked, this, &CohortWindow::openCurrent);
  soon_->setSingleShot(true);
  soon_->setInterval(60);
  connect(soon_, &QTimer::timeout, this, &CohortWindow::drawCharts);
  setWindowFlag(Qt::WindowMaximizeButtonHint);
  resize(1360, 860);
  drawCharts();
  refresh();
}

QWidget* CohortWindow::makeTop() {
  auto* held = new QWidget;
  auto* column = new QVBoxLayout(held);
  column->setContentsMargins(0, 0, 0, 0);
  folder_ = pathLine(
      "cohortFolder", tr("Results of a cohort, or a folder of runs and saved cases"),
      [this] {
        const QString chosen =
            QFileDialog::getExistingDirectory(this, tr("Folder of a cohort or of runs"), folder_->text());
        if (!chosen.isEmpty()) QTimer::singleShot(0, this, [this, chosen] { read(chosen); });
        return chosen;
      },
      column);
  connect(folder_, &QLineEdit::returnPressed, this, [this] { read(folder_->text().trimmed()); });
  auto* row = new QHBoxLayout;
  text_ = new QLineEdit;
  text_->setObjectName(QStringLiteral("cohortText"));
  text_->setPlaceholderText(tr("Patient, state, reason or warning"));
  text_->setClearButtonEnabled(true);
  figure_ = new QComboBox;
  figure_->setObjectName(QStringLiteral("cohortFigure"));
  figure_->setAccessibleName(tr("Figure of the charts and limits"));
  for (const CohortFigure& f : session::cohortFigures()) figure_->addItem(titleOf(f));
  const auto limit = [this](const char* name, const QString& hint) {
    auto* line = new QLineEdit;
    line->setObjectName(QString::fromLatin1(name));
    line->setPlaceholderText(hint);
    line->setFixedWidth(84);
    line->setValidator(new QDoubleValidator(line));
    connect(line, &QLineEdit::textChanged, this, &CohortWindow::filter);
    return line;
  };
  low_ = limit("cohortLow", tr("from"));
  high_ = limit("cohortHigh", tr("to"));
  counts_ = labelled({}, "faint");
  counts_->setObjectName(QStringLiteral("cohortCounts"));
  row->addWidget(new QLabel(tr("Show")));
  row->addWidget(text_, 2);
  row->addWidget(figure_);
  row->addWidget(low_);
  row->addWidget(high_);
  row->addWidget(counts_, 2);
  column->addLayout(row);
  connect(text_, &QLineEdit::textChanged, this, &CohortWindow::filter);
  connect(figure_, &QComboBox::currentIndexChanged, this, &CohortWindow::filter);
  return held;
}

QWidget* CohortWindow::makeTable() {
  table_ = new QTableView;
  table_->setObjectName(QStringLiteral("cohortTable"));
  table_->setAccessibleName(tr("Patients"));
  table_->setModel(rows_);
  table_->setSortingEnabled(true);
  table_->sortByColumn(CohortModel::idColumn, Qt::AscendingOrder);
  table_->setSelectionBehavior(QAbstractItemView::SelectRows);
  table_->setAlternatingRowColors(true);
  table_->setWordWrap(false);
  table_->verticalHeader()->hide();
  table_->verticalHeader()->setDefaultSectionSize(26);
  table_->horizontalHeader()->setHighlightSections(false);
  table_->horizontalHeader()->setStretchLastSection(true);
  connect(table_, &QTableView::doubleClicked, this, &CohortWindow::openCurrent);
  connect(table_->selectionModel(), &QItemSelectionModel::selectionChanged, this, [this] {
    soon_->start();
    refresh();
  });
  return table_;
}

QWidget* CohortWindow::makeCharts() {
  auto* held = new QWidget;
  auto* column = new QVBoxLayout(held);
  column->setContentsMargins(0, 0, 0, 0);
  histogram_ = new ChartView;
  histogram_->setObjectName(QStringLiteral("cohortHistogram"));
  histogram_->setToolTip(tr("Click: chooses the patients of a column; double-click: opens the first of them"));
  boxes_ = new ChartView;
  boxes_->setObjectName(QStringLiteral("cohortBoxes"));
  boxes_->setToolTip(tr("Click: chooses the patient nearest to that height; double-click: opens it"));
  numbers_ = labelled({}, "faint");
  numbers_->setObjectName(QStringLiteral("cohortNumbers"));
  column->addWidget(histogram_, 1);
  column->addWidget(boxes_, 1);
  column->addWidget(numbers_);
  connect(histogram_, &ChartView::columnClicked, this, [this](double low, double high, bool twice) {
    choose(session::within(model_->cohort(), shown(), figure(), low, high), twice);
  });
  connect(boxes_, &ChartView::placeClicked, this, [this](std::size_t, double value, bool twice) {
    if (const auto found = session::nearest(model_->cohort(), shown(), figure(), value)) choose({*found}, twice);
  });
  return held;
}

const CohortFigure& CohortWindow::figure() const {
  return session::cohortFigures()[static_cast<std::size_t>(std::max(figure_->currentIndex(), 0))];
}

std::vector<std::size_t> CohortWindow::shown() const {
  return session::passing(model_->cohort(), rows_->filter());
}

std::optional<std::size_t> CohortWindow::current() const {
  const QModelIndexList chosen = table_->selectionModel()->selectedRows();
  if (chosen.isEmpty()) return {};
  return static_cast<std::size_t>(rows_->mapToSource(chosen.front()).row());
}

void CohortWindow::read(const QString& folder) {
  if (folder.isEmpty() || busy()) return;
  folder_->setText(folder);
  auto cohort = std::make_shared<session::Cohort>();
  work(
      tr("Reading"),
      [cohort, path = std::filesystem::path(folder.toStdString())](const Progress& progress) {
        *cohort = session::readCohort(path, progress);
      },
      [this, cohort](const QString& reason) {
        said_->setText(reason.isEmpty() ? QString() : sentence(reason));
        if (!reason.isEmpty()) return;
        patients_.clear();
        if (cohort->unread > 0)
          said_->setText(tr("Folders that hold nothing to show: %1.").arg(static_cast<qulonglong>(cohort->unread)));
        model_->setCohort(std::move(*cohort));
        table_->resizeColumnsToContents();
        table_->selectRow(0);
        filter();
      });
}

void CohortWindow::filter() {
  session::CohortFilter wanted;
  wanted.text = text_->text().trimmed().toStdString();
  wanted.figure = &figure();
  bool number = false;
  if (const double low = low_->text().toDouble(&number); number) wanted.low = low;
  if (const double high = high_->text().toDouble(&number); number) wanted.high = high;
  rows_->setFilter(wanted);
  const std::size_t all = model_->cohort().patients.size();
  counts_->setText(all == 0 ? QString()
                            : tr("%1 of %2 patients").arg(rows_->rowCount()).arg(static_cast<qulonglong>(all)));
  soon_->start();
  refresh();
}

void CohortWindow::drawCharts() {
  const CohortFigure& f = figure();
  const std::vector<std::size_t> which = shown();
  const std::vector<double> values = session::valuesOf(model_->cohort(), which, f);
  if (values.empty()) {
    const QString hint = model_->cohort().patients.empty()
                             ? tr("Choose the folder of a cohort or of runs: its figures appear here.")
                             : tr("No patient that is shown has this figure.");
    histogram_->setHint(hint);
    boxes_->setHint(hint);
    numbers_->clear();
    return;
  }
  std::vector<render::ReferenceLine> lines;
  if (f.line.words != nullptr)
    lines.push_back({f.line.value,
                     QStringLiteral("%1 %2: %3")
                         .arg(f.line.value)
                         .arg(QString::fromUtf8(f.unit), QCoreApplication::translate("cohort", f.line.words))
                         .toStdString(),
                     render::colours::orange});
  if (const auto chosen = current()) {
    const cohort::CaseRecord& r = model_->cohort().patients[*chosen].record;
    if (std::isfinite(r.*f.value))
      lines.push_back(
          {r.*f.value, r.outcome.id + ": " + textOf(f, r.*f.value).toStdString(), render::colours::magenta});
  }
  render::Histogram histogram;
  histogram.x.title = titleOf(f).toStdString();
  histogram.y.title = tr("Patients").toStdString();
  histogram.values = values;
  histogram.binWidth = f.binWidth;
  histogram.lines = lines;
  render::BoxPlot boxes;
  boxes.y.title = titleOf(f).toStdString();
  boxes.boxes.push_back({tr("shown").toStdString(), values});
  boxes.lines = lines;
  histogram_->setChart(std::move(histogram));
  boxes_->setChart(std::move(boxes));
  const cohort::Spread s = cohort::spreadOf(values);
  numbers_->setText(
      tr("%1: mean %2, SD %3, median %4, %5 to %6, n = %7")
          .arg(titleOf(f), textOf(f, s.mean), textOf(f, s.sd), textOf(f, s.median), textOf(f, s.min), textOf(f, s.max))
          .arg(static_cast<qulonglong>(s.n)));
}

void CohortWindow::choose(const std::vector<std::size_t>& patients, bool open) {
  QItemSelection chosen;
  QModelIndex first;
  for (const std::size_t n : patients) {
    const QModelIndex row = rows_->mapFromSource(model_->index(static_cast<int>(n), 0));
    if (!row.isValid()) continue;
    chosen.select(row, rows_->index(row.row(), model_->columnCount() - 1));
    if (!first.isValid() || row.row() < first.row()) first = row;
  }
  if (!first.isValid()) return;
  table_->selectionModel()->setCurrentIndex(first, QItemSelectionModel::NoUpdate);
  table_->selectionModel()->select(chosen, QItemSelectionModel::ClearAndSelect);
  table_->scrollTo(first);
  if (open) openCurrent();
}

void CohortWindow::refresh() {
  if (open_) open_->setEnabled(!busy() && current().has_value());
}

void CohortWindow::openCurrent() {
  const auto chosen = current();
  if (!chosen || busy()) return;
  const session::CohortPatient& patient = model_->cohort().patients[*chosen];
  if (!patient.opens.empty()) {
    openCertain(patient.opens);
    return;
  }
  if (model_->cohort().kind == session::Cohort::Kind::Runs) {
    said_->setText(tr("The images of this run are not where it says."));
    return;
  }
  // Results name no patient's place: the folder that the cohort was run over is asked for once.
  if (patients_.isEmpty())
    patients_ = QFileDialog::getExistingDirectory(this, tr("Folder of the patients, that the cohort was run over"));
  if (patients_.isEmpty()) return;
  auto found = std::make_shared<session::FoundPatient>();
  work(
      tr("Looking for the patient"),
      [found, record = patient.record, folder = std::filesystem::path(patients_.toStdString())](
          const Progress& progress) { *found = session::patientOf(record, folder, progress); },
      [this, found, n = *chosen](const QString& reason) {
        if (!reason.isEmpty()) {
          said_->setText(sentence(reason));
          patients_.clear();
          return;
        }
        if (!found->certain &&
            QMessageBox::warning(this, tr("Cohort"),
                                 tr("The files of this patient are not known to be those that the result was made of: "
                                    "they have changed, or another version or a scene of its own was used. Open them?"),
                                 QMessageBox::Open | QMessageBox::Cancel, QMessageBox::Cancel) != QMessageBox::Open)
          return;
        model_->setOpens(n, found->folder);
        openCertain(found->folder);
      });
}

void CohortWindow::openCertain(const std::filesystem::path& path) {
  said_->clear();
  emit openWanted(QString::fromStdString(path.string()));
}

}  // namespace glisson::panels
