// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/export_dialog.h"

#include <QCheckBox>
#include <QCoreApplication>
#include <QFileDialog>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLineEdit>
#include <QPushButton>
#include <QTextBrowser>
#include <algorithm>

#include "base/error.h"
#include "panels/form.h"
#include "session/said.h"

namespace glisson::panels {

using session::FormatGroup;
using session::FormatNeeds;
using session::FormatOffer;

namespace {

QString wordsOf(const FormatOffer& offer) {
  return QCoreApplication::translate("formats", offer.words);
}

const FormatOffer& offerNamed(const std::string& name) {
  for (const FormatOffer& offer : session::formatOffers())
    if (name == offer.name) return offer;
  throw BadArgument("no format of the dialog is called " + name);
}

}  // namespace

ExportDialog::ExportDialog(session::ExportSource source, QWidget* parent)
    : WorkDialog("exportDialog", tr("Export"), parent), source_(std::move(source)) {
  form()->addWidget(makeTicks());
  form()->addWidget(section(tr("Folder")));
  folder_ = pathLine(
      "exportFolder", tr("Where the files are written"),
      [this] { return QFileDialog::getExistingDirectory(this, tr("Folder for the export"), folder_->text()); }, form());
  replace_ = new QCheckBox(tr("Replace files of the same name"));
  replace_->setObjectName(QStringLiteral("exportReplace"));
  replace_->setToolTip(tr("Otherwise the folder must be new or empty"));
  form()->addWidget(replace_);
  auto* names = new QHBoxLayout;
  case_ = new QLineEdit;
  case_->setObjectName(QStringLiteral("exportCase"));
  case_->setPlaceholderText(tr("Case in the table, no patient's name"));
  reader_ = new QLineEdit;
  reader_->setObjectName(QStringLiteral("exportReader"));
  reader_->setPlaceholderText(tr("Reader in the table"));
  names->addWidget(case_);
  names->addWidget(reader_);
  form()->addLayout(names);
  told_ = new QTextBrowser;
  told_->setObjectName(QStringLiteral("exportTold"));
  told_->setMinimumHeight(130);
  told_->hide();
  form()->addWidget(told_, 1);
  start_ = addStart("exportStart", tr("Export"));
  connect(start_, &QPushButton::clicked, this, &ExportDialog::start);
  refresh();
}

QWidget* ExportDialog::makeTicks() {
  auto* held = new QWidget;
  auto* row = new QHBoxLayout(held);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(28);
  auto* left = new QVBoxLayout;
  auto* right = new QVBoxLayout;
  row->addLayout(left);
  row->addLayout(right);
  addGroup(FormatGroup::Dicom, left);
  addGroup(FormatGroup::Tables, left);
  addGroup(FormatGroup::Programs, left);
  addGroup(FormatGroup::Images, right);
  addGroup(FormatGroup::Meshes, right);
  left->addStretch();
  right->addStretch();
  return held;
}

void ExportDialog::addGroup(FormatGroup group, QVBoxLayout* into) {
  const auto title = [group] {
    switch (group) {
      case FormatGroup::Dicom: return tr("DICOM");
      case FormatGroup::Images: return tr("Images and outlines");
      case FormatGroup::Meshes: return tr("Meshes and matrices");
      case FormatGroup::Programs: return tr("Other programs");
      case FormatGroup::Tables: break;
    }
    return tr("Tables");
  };
  into->addWidget(section(title()));
  for (const FormatOffer& offer : session::formatOffers()) {
    if (offer.group != group) continue;
    auto* tick = new QCheckBox(wordsOf(offer));
    tick->setObjectName(QStringLiteral("format-") + QLatin1String(offer.name));
    const bool can = has(source_, offer.needs);
    tick->setEnabled(can);
    tick->setToolTip(can ? QString() : whyNot(offer.needs));
    connect(tick, &QCheckBox::toggled, this, [this] { refresh(); });
    into->addWidget(tick);
    ticks_.emplace_back(&offer, tick);
  }
}

QString ExportDialog::whyNot(FormatNeeds needs) const {
  switch (needs) {
    case FormatNeeds::Outlines: return tr("Needs an accepted outline of the liver.");
    case FormatNeeds::Elastogram: return tr("Needs an elastogram and an accepted outline of the liver.");
    case FormatNeeds::Run: break;
  }
  return tr("Needs a run of what is shown: run the retraction first.");
}

session::ExportWish ExportDialog::wish() const {
  session::ExportWish wish;
  for (const auto& [offer, tick] : ticks_)
    if (tick->isChecked()) wish.formats.emplace_back(offer->name);
  wish.folder = folder_->text().trimmed().toStdString();
  wish.replace = replace_->isChecked();
  wish.caseName = case_->text().trimmed().toStdString();
  wish.reader = reader_->text().trimmed().toStdString();
  return wish;
}

void ExportDialog::refresh() {
  const session::ExportWish now = wish();
  const bool table = std::ranges::count(now.formats, "csv") > 0;
  case_->setVisible(table);
  reader_->setVisible(table);
  start_->setEnabled(!busy() && !now.formats.empty() && !now.folder.empty());
}

void ExportDialog::start() {
  auto done = std::make_shared<pipeline::Exported>();
  work(
      tr("Exporting"),
      [done, source = source_, wish = wish()](const Progress& progress) {
        *done = session::exportFormats(source, wish, progress);
      },
      [this, done](const QString& reason) { tell(*done, reason); });
}

// File names only: the folder may be named after the patient, and is seen in the line above.
void ExportDialog::tell(const pipeline::Exported& done, const QString& reason) {
  QString text;
  const auto add = [&text](const QString& heading, const QStringList& lines) {
    if (lines.isEmpty()) return;
    text += QStringLiteral("<p><b>%1</b></p><ul>").arg(heading.toHtmlEscaped());
    for (const QString& line : lines) text += QStringLiteral("<li>%1</li>").arg(line.toHtmlEscaped());
    text += QStringLiteral("</ul>");
  };
  if (!reason.isEmpty()) add(tr("Nothing was written"), {sentence(reason)});
  QStringList files, refused, warnings;
  const std::filesystem::path folder = folder_->text().trimmed().toStdString();
  for (const auto& file : done.files) files << QString::fromStdString(file.lexically_relative(folder).string());
  for (const auto& r : done.refused)
    refused << wordsOf(offerNamed(r.format)) + QStringLiteral(": ") + withStop(QString::fromStdString(r.reason));
  for (const QString& w : session::said(done.warnings, done.diagnostics)) warnings << sentence(w);
  add(tr("Not written"), refused);
  if (!files.isEmpty()) add(tr("Files written: %1").arg(files.size()), files);
  add(tr("To be known"), warnings);
  told_->setHtml(text);
  told_->show();
  if (height() < 700) resize(width(), 700);
}

}  // namespace glisson::panels
