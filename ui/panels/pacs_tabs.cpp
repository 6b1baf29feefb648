// SPDX-License-Identifier: GPL-3.0-or-later

// The two sheets of the PACS dialog: find and fetch, send.
#include <QCheckBox>
#include <QCoreApplication>
#include <QFileDialog>
#include <QGridLayout>
#include <QHeaderView>
#include <QLineEdit>
#include <QListWidget>
#include <QPushButton>
#include <QTabWidget>
#include <QTreeWidget>

#include "panels/form.h"
#include "panels/pacs_dialog.h"

namespace glisson::panels {

namespace {

constexpr int studyUid = Qt::UserRole, seriesUid = Qt::UserRole + 1;

QString counted(int number) {
  return number < 0 ? QStringLiteral("–") : QString::number(number);
}

/// 20260131 → 2026-01-31; anything else as it is.
QString dateInWords(const std::string& date) {
  const QString text = QString::fromStdString(date);
  return text.size() == 8 ? text.left(4) + QLatin1Char('-') + text.mid(4, 2) + QLatin1Char('-') + text.mid(6) : text;
}

}  // namespace

QWidget* PacsDialog::makeKeys() {
  auto* held = new QWidget;
  auto* grid = new QGridLayout(held);
  grid->setContentsMargins(0, 0, 0, 0);
  const auto line = [&](QLineEdit*& into, const char* name, const QString& words, const QString& tip, int row,
                        int column) {
    into = new QLineEdit;
    into->setObjectName(QString::fromLatin1(name));
    into->setToolTip(tip);
    auto* label = new QLabel(words);
    label->setBuddy(into);
    grid->addWidget(label, row, 2 * column);
    grid->addWidget(into, row, 2 * column + 1);
    connect(into, &QLineEdit::returnPressed, this, &PacsDialog::find);
  };
  const QString wild = tr("* stands for any text, ? for any letter");
  line(patientId_, "pacsPatientId", tr("Patient ID"), wild, 0, 0);
  line(patientName_, "pacsPatientName", tr("Patient name"), wild, 0, 1);
  line(date_, "pacsDate", tr("Study date"), tr("2026-01-31, or a range: 2026-01-01..2026-01-31, 2026-01-01.."), 1, 0);
  line(modality_, "pacsModality", tr("Modality"), tr("MR, for instance"), 1, 1);
  line(description_, "pacsDescription", tr("Description"), wild, 2, 0);
  line(accession_, "pacsAccession", tr("Accession number"), wild, 2, 1);
  return held;
}

QWidget* PacsDialog::makeFind() {
  auto* held = new QWidget;
  auto* column = new QVBoxLayout(held);
  column->addWidget(makeKeys());
  auto* row = new QHBoxLayout;
  showNames_ = new QCheckBox(tr("Show who the patients are"));
  showNames_->setObjectName(QStringLiteral("pacsShowNames"));
  showNames_->setToolTip(tr("Otherwise patients are numbered, and their names are not even asked for"));
  find_ = button("pacsFind", tr("Find"), {}, tr("Lists studies and their series (C-FIND)"));
  find_->setAutoDefault(false);
  row->addWidget(showNames_, 1);
  row->addWidget(find_);
  column->addLayout(row);
  found_ = new QTreeWidget;
  found_->setObjectName(QStringLiteral("pacsFound"));
  found_->setAccessibleName(tr("Studies found"));
  found_->setHeaderLabels({tr("Patient"), tr("Date"), tr("Description"), tr("Modality"), tr("Series"), tr("Images")});
  found_->setSelectionMode(QAbstractItemView::ExtendedSelection);
  found_->setAlternatingRowColors(true);
  found_->setUniformRowHeights(true);
  found_->header()->setStretchLastSection(false);
  found_->header()->setSectionResizeMode(2, QHeaderView::Stretch);
  column->addWidget(found_, 1);
  folder_ = pathLine(
      "pacsFolder", tr("Folder for what is fetched; each study gets one of its own in it"),
      [this] { return QFileDialog::getExistingDirectory(this, tr("Folder for what is fetched"), folder_->text()); },
      column);
  auto* last = new QHBoxLayout;
  fetch_ = button("pacsFetch", tr("Fetch"), {}, tr("Fetches the studies or series chosen in the list"));
  fetch_->setProperty("primary", true);
  open_ = button("pacsOpen", tr("Open what was fetched"), {}, tr("Opens it in the window"));
  last->addStretch();
  last->addWidget(open_);
  last->addWidget(fetch_);
  column->addLayout(last);
  for (QPushButton* b : {fetch_, open_}) b->setAutoDefault(false);
  connect(find_, &QPushButton::clicked, this, &PacsDialog::find);
  connect(fetch_, &QPushButton::clicked, this, &PacsDialog::fetch);
  connect(open_, &QPushButton::clicked, this, [this] { emit openWanted(fetched_); });
  connect(found_, &QTreeWidget::itemSelectionChanged, this, [this] { refresh(); });
  return held;
}

pacs::Query PacsDialog::query() const {
  pacs::Query q;
  const auto text = [](const QLineEdit* line) { return line->text().trimmed().toStdString(); };
  q.patientId = text(patientId_);
  q.patientName = text(patientName_);
  if (!date_->text().trimmed().isEmpty()) q.studyDate = pacs::dateRange(text(date_));
  q.modality = text(modality_);
  q.description = text(description_);
  q.accession = text(accession_);
  q.series = true;
  q.names = showNames_->isChecked();
  return q;
}

void PacsDialog::find() {
  if (!find_->isEnabled()) return;
  pacs::Query wanted;
  try {
    wanted = query();
  } catch (const std::exception&) {
    say(sentence(session::reasonOf(std::current_exception())), true);
    return;
  }
  found_->clear();
  auto answer = std::make_shared<pacs::Found>();
  work(
      tr("Asking"),
      [answer, wanted, node = server().node](const Progress& progress) {
        *answer = pacs::find(node, wanted, progress);
      },
      [this, answer](const QString& reason) {
        if (reason.isEmpty())
          show_(*answer);
        else
          say(sentence(reason), true);
      });
}

void PacsDialog::show_(const pacs::Found& found) {
  for (const pacs::FoundStudy& study : found.studies) {
    QStringList modalities;
    for (const std::string& m : study.modalities) modalities << QString::fromStdString(m);
    const QString named =
        QString::fromStdString(study.patientName) + QStringLiteral("  ") + QString::fromStdString(study.patientId);
    auto* row = new QTreeWidgetItem(
        found_, {named.trimmed().isEmpty() ? tr("Patient %1").arg(study.patient) : named.trimmed(),
                 dateInWords(study.date), QString::fromStdString(study.description),
                 modalities.join(QStringLiteral(", ")), counted(study.seriesCount), counted(study.objects)});
    row->setData(0, studyUid, QString::fromStdString(study.uid));
    for (const pacs::FoundSeries& series : study.series) {
      auto* child = new QTreeWidgetItem(row, {tr("Series %1").arg(series.number),
                                              {},
                                              QString::fromStdString(series.description),
                                              QString::fromStdString(series.modality),
                                              {},
                                              counted(series.objects)});
      child->setData(0, studyUid, QString::fromStdString(study.uid));
      child->setData(0, seriesUid, QString::fromStdString(series.uid));
    }
  }
  // The rows of series are unfolded later: their numbers ask for the width too.
  found_->expandAll();
  for (const int n : {0, 1, 3, 4, 5}) found_->resizeColumnToContents(n);
  found_->collapseAll();
  if (found.studies.empty())
    say(tr("The server has nothing of that kind."));
  else if (found.truncated)
    say(tr("%1 studies; there are more: narrow what you look for.").arg(found.studies.size()), true);
  else
    say(tr("Studies found: %1.").arg(found.studies.size()));
  if (found.studies.size() == 1) found_->setCurrentItem(found_->topLevelItem(0));
}

std::vector<session::FetchWish> PacsDialog::chosen() const {
  std::vector<session::FetchWish> wishes;
  for (const QTreeWidgetItem* item : found_->selectedItems()) {
    if (item->parent() && item->parent()->isSelected()) continue;  // the whole study is fetched
    wishes.push_back(
        {item->data(0, studyUid).toString().toStdString(), item->data(0, seriesUid).toString().toStdString()});
  }
  return wishes;
}

void PacsDialog::fetch() {
  auto got = std::make_shared<session::Fetched>();
  work(
      tr("Fetching"),
      [got, from = server(), wishes = chosen(),
       folder = std::filesystem::path(folder_->text().trimmed().toStdString())](const Progress& progress) {
        *got = session::fetch(from, wishes, folder, progress);
      },
      [this, got](const QString& reason) {
        fetched_ = reason.isEmpty() ? QString::fromStdString(got->folder.string()) : QString();
        if (!reason.isEmpty()) {
          say(tr("%1 What has arrived is kept.").arg(sentence(reason)), true);
          return;
        }
        QString text = tr("Images fetched: %1, there already: %2.")
                           .arg(static_cast<qulonglong>(got->objects))
                           .arg(static_cast<qulonglong>(got->alreadyThere));
        if (!got->complete) text += QLatin1Char(' ') + tr("Not everything has arrived: fetch again.");
        for (const pacs::Refusal& r : got->refused)
          text += QLatin1Char(' ') +
                  tr("Refused: %1 (%2).").arg(static_cast<qulonglong>(r.count)).arg(QString::fromStdString(r.reason));
        say(text, !got->complete || !got->refused.empty());
      });
}

QWidget* PacsDialog::makeSend() {
  auto* held = new QWidget;
  auto* column = new QVBoxLayout(held);
  column->addWidget(section(tr("What is shown, as DICOM")));
  for (const session::FormatOffer& offer : session::formatOffers()) {
    if (offer.group != session::FormatGroup::Dicom) continue;
    auto* tick = new QCheckBox(QCoreApplication::translate("formats", offer.words));
    tick->setObjectName(QStringLiteral("send-") + QLatin1String(offer.name));
    connect(tick, &QCheckBox::toggled, this, [this] { refresh(); });
    column->addWidget(tick);
    ticks_.emplace_back(&offer, tick);
  }
  column->addWidget(section(tr("Files and folders")));
  files_ = new QListWidget;
  files_->setObjectName(QStringLiteral("sendFiles"));
  files_->setAccessibleName(tr("Files and folders to send"));
  column->addWidget(files_, 1);
  auto* row = new QHBoxLayout;
  auto* addFiles = button("sendAddFiles", tr("Add files…"), {}, tr("DICOM files to send"));
  auto* addFolder = button("sendAddFolder", tr("Add folder…"), {}, tr("All DICOM files below a folder"));
  auto* clear = button("sendClear", tr("Clear"), {}, tr("Takes all from the list"));
  send_ = button("pacsSend", tr("Send"), {}, tr("Stores it on the server (C-STORE)"));
  send_->setProperty("primary", true);
  for (QPushButton* b : {addFiles, addFolder, clear}) row->addWidget(b);
  row->addStretch();
  row->addWidget(send_);
  column->addLayout(row);
  for (QPushButton* b : {addFiles, addFolder, clear, send_}) b->setAutoDefault(false);
  connect(addFiles, &QPushButton::clicked, this, [this] {
    files_->addItems(QFileDialog::getOpenFileNames(this, tr("DICOM files to send")));
    refresh();
  });
  connect(addFolder, &QPushButton::clicked, this, [this] {
    const QString folder = QFileDialog::getExistingDirectory(this, tr("Folder to send"));
    if (!folder.isEmpty()) files_->addItem(folder);
    refresh();
  });
  connect(clear, &QPushButton::clicked, this, [this] {
    files_->clear();
    refresh();
  });
  connect(send_, &QPushButton::clicked, this, &PacsDialog::send);
  return held;
}

void PacsDialog::refreshTicks() {
  const auto now = source_();
  for (const auto& [offer, tick] : ticks_) {
    const bool can = now && has(*now, offer->needs);
    tick->setEnabled(can);
    tick->setToolTip(can ? QString() : tr("Needs an outlined liver, with elastogram or run where these are told of."));
  }
  refresh();
}

void PacsDialog::send() {
  session::SendWish wish;
  for (const auto& [offer, tick] : ticks_)
    if (tick->isEnabled() && tick->isChecked()) wish.formats.emplace_back(offer->name);
  for (int n = 0; n < files_->count(); ++n) wish.paths.emplace_back(files_->item(n)->text().toStdString());
  auto away = std::make_shared<session::SentAway>();
  const std::shared_ptr<const session::ExportSource> source = wish.formats.empty() ? nullptr : source_();
  work(
      tr("Sending"),
      [away, wish, source, node = server().node](const Progress& progress) {
        *away = session::sendAway(node, wish, source.get(), progress);
      },
      [this, away](const QString& reason) {
        if (!reason.isEmpty()) {
          say(sentence(reason), true);
          return;
        }
        QString text = tr("Objects sent: %1.").arg(static_cast<qulonglong>(away->sent.objects));
        if (!away->sent.failed.empty())
          text += QLatin1Char(' ') + tr("Not sent: %1 (%2).")
                                         .arg(static_cast<qulonglong>(away->sent.failed.size()))
                                         .arg(QString::fromStdString(away->sent.failed.front().reason));
        for (const pipeline::RefusedFormat& r : away->refused) text += QLatin1Char(' ') + sentence(r.reason);
        say(text, !away->sent.failed.empty() || !away->refused.empty());
      });
}

}  // namespace glisson::panels
