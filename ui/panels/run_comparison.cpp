// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/run_comparison.h"

#include <QComboBox>
#include <QCoreApplication>
#include <QFileDialog>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QPushButton>
#include <QTreeWidget>
#include <algorithm>
#include <cmath>

#include "panels/form.h"

namespace glisson::panels {

namespace {

QTreeWidget* tableOf(const char* name, const QString& what) {
  auto* table = new QTreeWidget;
  table->setObjectName(QString::fromLatin1(name));
  table->setAccessibleName(what);
  table->setRootIsDecorated(false);
  table->setAlternatingRowColors(true);
  table->setUniformRowHeights(true);
  table->setSelectionMode(QAbstractItemView::NoSelection);
  return table;
}

QString shown(const std::optional<double>& value, const session::FigureBeside& figure, bool sign = false) {
  if (!value) return QStringLiteral("–");
  QString text = QString::number(std::abs(*value), 'f', figure.decimals);
  const bool zero = text.toDouble() == 0.0;
  if (!zero && *value < 0.0) text.prepend(QStringLiteral("−"));
  if (!zero && sign && *value > 0.0) text.prepend(QLatin1Char('+'));
  const QString unit = QString::fromUtf8(figure.unit);
  return unit.isEmpty() ? text : text + QStringLiteral("\u00a0") + unit;
}

}  // namespace

RunComparison::RunComparison(session::RunHistory& history, QWidget* parent)
    : WorkDialog("runComparison", tr("Compare two runs"), parent), history_(history) {
  auto* row = new QHBoxLayout;
  first_ = new QComboBox;
  first_->setObjectName(QStringLiteral("firstRun"));
  first_->setAccessibleName(tr("First run"));
  second_ = new QComboBox;
  second_->setObjectName(QStringLiteral("secondRun"));
  second_->setAccessibleName(tr("Second run"));
  other_ = button("otherRun", tr("Another run…"), {}, tr("The folder of a run, or of a case that keeps one"));
  other_->setAutoDefault(false);
  row->addWidget(first_, 1);
  row->addWidget(new QLabel(tr("against")));
  row->addWidget(second_, 1);
  row->addWidget(other_);
  form()->addLayout(row);
  said_ = labelled({}, "text");
  said_->setObjectName(QStringLiteral("runsSaid"));
  form()->addWidget(said_);
  figures_ = tableOf("runFigures", tr("Figures"));
  form()->addWidget(figures_, 3);
  form()->addWidget(section(tr("Set otherwise")));
  settings_ = tableOf("runSettings", tr("Settings that differ"));
  form()->addWidget(settings_, 1);
  connect(other_, &QPushButton::clicked, this, [this] {
    const QString folder = QFileDialog::getExistingDirectory(this, tr("Folder of a run, or of a case that keeps one"));
    if (!folder.isEmpty()) addFrom(folder);
  });
  for (QComboBox* box : {first_, second_}) connect(box, &QComboBox::currentIndexChanged, this, &RunComparison::show_);
  connect(&history_, &session::RunHistory::changed, this, &RunComparison::fill);
  resize(860, 760);
  fill();
}

void RunComparison::fill() {
  all_ = history_.runs();
  all_.insert(all_.end(), others_.begin(), others_.end());
  for (QComboBox* box : {first_, second_}) {
    const QSignalBlocker quiet(box);
    box->clear();
    for (const session::RunRecord& run : all_) box->addItem(run.name);
  }
  // The run before against the one shown.
  first_->setCurrentIndex(all_.size() > 1 ? 1 : 0);
  second_->setCurrentIndex(0);
  show_();
}

const session::RunRecord* RunComparison::chosen(const QComboBox* box) const {
  const int n = box->currentIndex();
  return n >= 0 && n < static_cast<int>(all_.size()) ? &all_[static_cast<std::size_t>(n)] : nullptr;
}

void RunComparison::addFrom(const QString& folder) {
  auto run = std::make_shared<session::RunRecord>();
  work(
      tr("Reading"),
      [run, path = std::filesystem::path(folder.toStdString())](const Progress&) {
        run->json = session::readRunRecord(path);
      },
      [this, run](const QString& reason) {
        if (!reason.isEmpty()) {
          said_->setText(QStringLiteral("⚠ ") + sentence(reason));
          return;
        }
        run->name = tr("Run %1 from a folder").arg(others_.size() + 1);
        others_.push_back(*run);
        fill();
        const QSignalBlocker quiet(first_);
        first_->setCurrentIndex(0);
        second_->setCurrentIndex(static_cast<int>(all_.size()) - 1);
        show_();
      });
}

void RunComparison::show_() {
  figures_->clear();
  settings_->clear();
  const session::RunRecord *a = chosen(first_), *b = chosen(second_);
  if (!a || !b) {
    said_->setText(tr("There is no run yet: run the retraction, or choose the folder of a run."));
    return;
  }
  session::RunsBeside both;
  try {
    both = session::beside(*a, *b);
  } catch (const std::exception&) {
    said_->setText(QStringLiteral("⚠ ") + sentence(session::reasonOf(std::current_exception())));
    return;
  }
  if (a == b)
    said_->setText(tr("This is one run twice: choose another, run again, or take the folder of a run."));
  else if (!both.samePatient())
    said_->setText(QStringLiteral("⚠ ") + tr("The two runs are of different images."));
  else if (both.settings.empty() && both.inputs.empty())
    said_->setText(tr("Both runs have the same images, outlines and settings."));
  else if (std::ranges::count(both.inputs, "roi") > 0)
    said_->setText(tr("Same images, other outlines."));
  else
    said_->setText(tr("Same images and outlines, other settings."));
  showFigures(both);
  showSettings(both);
}

void RunComparison::showFigures(const session::RunsBeside& both) {
  figures_->setHeaderLabels({tr("Figure"), first_->currentText(), second_->currentText(), tr("Difference")});
  for (const int column : {1, 2, 3})
    figures_->headerItem()->setTextAlignment(column, Qt::AlignRight | Qt::AlignVCenter);
  for (const session::FigureBeside& f : both.figures) {
    auto* row = new QTreeWidgetItem(figures_, {QCoreApplication::translate("figures", f.words), shown(f.first, f),
                                               shown(f.second, f), shown(f.difference(), f, true)});
    for (const int column : {1, 2, 3}) row->setTextAlignment(column, Qt::AlignRight | Qt::AlignVCenter);
    QFont bold = row->font(3);
    bold.setBold(f.difference() && *f.difference() != 0.0);
    row->setFont(3, bold);
  }
  for (const int column : {0, 1, 2, 3}) figures_->resizeColumnToContents(column);
}

void RunComparison::showSettings(const session::RunsBeside& both) {
  settings_->setHeaderLabels({tr("Setting of the scene"), first_->currentText(), second_->currentText()});
  for (const session::SettingBeside& s : both.settings)
    new QTreeWidgetItem(settings_, {QString::fromStdString(s.key),
                                    s.first.empty() ? QStringLiteral("–") : QString::fromStdString(s.first),
                                    s.second.empty() ? QStringLiteral("–") : QString::fromStdString(s.second)});
  for (const int column : {0, 1}) settings_->resizeColumnToContents(column);
}

}  // namespace glisson::panels
