// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/deidentify_dialog.h"

#include <QCheckBox>
#include <QFileDialog>
#include <QLineEdit>
#include <QPushButton>
#include <QTextBrowser>

#include "panels/form.h"

namespace glisson::panels {

namespace {

QString item(const QString& what, std::size_t count) {
  return QStringLiteral("<tr><td>%1&nbsp;&nbsp;</td><td align=\"right\">%2</td></tr>")
      .arg(what.toHtmlEscaped())
      .arg(static_cast<qulonglong>(count));
}

QString listOf(const QString& heading, const QStringList& lines) {
  if (lines.isEmpty()) return {};
  QString text = QStringLiteral("<p><b>%1</b></p><ul>").arg(heading.toHtmlEscaped());
  for (const QString& line : lines) text += QStringLiteral("<li>%1</li>").arg(line.toHtmlEscaped());
  return text + QStringLiteral("</ul>");
}

}  // namespace

DeidentifyDialog::DeidentifyDialog(QWidget* parent) : WorkDialog("deidentifyDialog", tr("De-identify"), parent) {
  form()->addWidget(labelled(
      tr("Copies DICOM files without what identifies the patient: the basic profile of PS3.15, and stricter on "
         "free text. The files that are read stay as they are."),
      "faint"));
  form()->addWidget(section(tr("From")));
  in_ = pathLine(
      "deidentifyIn", tr("DICOM folder to read"),
      [this] { return QFileDialog::getExistingDirectory(this, tr("DICOM folder to read"), in_->text()); }, form());
  form()->addWidget(section(tr("Into")));
  out_ = pathLine(
      "deidentifyOut", tr("Folder for the copies, new or empty"),
      [this] { return QFileDialog::getExistingDirectory(this, tr("Folder for the copies"), out_->text()); }, form());
  form()->addWidget(section(tr("Key file of the project")));
  key_ = pathLine(
      "deidentifyKey", tr("Pseudonyms follow from it; made where there is none. Keep it apart from the copies."),
      [this] {
        return QFileDialog::getSaveFileName(this, tr("Key file of the project"), key_->text(), {}, nullptr,
                                            QFileDialog::DontConfirmOverwrite);
      },
      form());
  dates_ = new QCheckBox(tr("Keep dates, all of one patient shifted by the same days"));
  dates_->setObjectName(QStringLiteral("deidentifyDates"));
  descriptors_ = new QCheckBox(tr("Keep the technical words of descriptions"));
  descriptors_->setObjectName(QStringLiteral("deidentifyDescriptors"));
  characteristics_ = new QCheckBox(tr("Keep age, sex, size and weight"));
  characteristics_->setObjectName(QStringLiteral("deidentifyCharacteristics"));
  for (QCheckBox* tick : {dates_, descriptors_, characteristics_}) form()->addWidget(tick);
  told_ = new QTextBrowser;
  told_->setObjectName(QStringLiteral("deidentifyTold"));
  told_->setMinimumHeight(220);
  told_->hide();
  form()->addWidget(told_, 1);
  open_ = button("deidentifyOpen", tr("Open the copies"), {}, tr("Opens the folder that was written"));
  open_->setAutoDefault(false);
  open_->hide();
  form()->addWidget(open_, 0, Qt::AlignLeft);
  start_ = addStart("deidentifyStart", tr("De-identify"));
  connect(start_, &QPushButton::clicked, this, &DeidentifyDialog::start);
  connect(open_, &QPushButton::clicked, this, [this] { emit openWanted(written_); });
  resize(620, sizeHint().height());
  refresh();
}

session::DeidentifyWish DeidentifyDialog::wish() const {
  session::DeidentifyWish wish;
  wish.in = in_->text().trimmed().toStdString();
  wish.out = out_->text().trimmed().toStdString();
  wish.key = key_->text().trimmed().toStdString();
  wish.options.shiftDates = dates_->isChecked();
  wish.options.cleanDescriptors = descriptors_->isChecked();
  wish.options.keepCharacteristics = characteristics_->isChecked();
  return wish;
}

void DeidentifyDialog::refresh() {
  const session::DeidentifyWish now = wish();
  start_->setEnabled(!busy() && !now.in.empty() && !now.out.empty() && !now.key.empty());
}

void DeidentifyDialog::start() {
  auto report = std::make_shared<session::DeidentifyReport>();
  const session::DeidentifyWish wanted = wish();
  open_->hide();
  work(
      tr("De-identifying"),
      [report, wanted](const Progress& progress) { *report = session::deidentifyFolder(wanted, progress); },
      [this, report, wanted](const QString& reason) {
        written_ = reason.isEmpty() ? QString::fromStdString(wanted.out.string()) : QString();
        open_->setVisible(!written_.isEmpty() && report->files > 0);
        if (reason.isEmpty())
          tell(*report);
        else
          refuse(reason);
        told_->show();
        resize(width(), std::max(height(), 680));
      });
}

void DeidentifyDialog::refuse(const QString& reason) {
  told_->setHtml(listOf(tr("Nothing was written"), {sentence(reason)}));
}

void DeidentifyDialog::tell(const session::DeidentifyReport& report) {
  const dicom::AttributeChanges& c = report.changes;
  QString text = QStringLiteral("<p><b>%1</b></p>")
                     .arg(tr("Files written: %1, patients: %2")
                              .arg(static_cast<qulonglong>(report.files))
                              .arg(static_cast<qulonglong>(report.patients)));
  text += QStringLiteral("<p>%1</p><table>").arg(tr("Attributes changed in these files:"));
  text += item(tr("removed"), c.removed) + item(tr("private ones removed"), c.privateRemoved) +
          item(tr("emptied"), c.emptied) + item(tr("replaced by a pseudonym or a word of no meaning"), c.replaced) +
          item(dates_->isChecked() ? tr("dates shifted") : tr("dates taken away"), c.dates) +
          item(tr("UIDs mapped by the key"), c.uids) + item(tr("codes of unknown schemes"), c.codes);
  text += QStringLiteral("</table>");
  QStringList left, notes;
  for (const auto& one : report.leftOut)
    left << tr("%1 × a file that %2").arg(static_cast<qulonglong>(one.files)).arg(QString::fromStdString(one.reason));
  text += listOf(tr("Left out"), left);
  if (report.keyMade) notes << tr("A new key file was made: with another one, pseudonyms would be others.");
  for (const std::string& note : report.notes) notes << sentence(note);
  told_->setHtml(text + listOf(tr("To be known"), notes));
}

}  // namespace glisson::panels
