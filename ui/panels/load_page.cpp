// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/load_page.h"

#include <QHBoxLayout>
#include <QHeaderView>
#include <QSettings>
#include <QStackedWidget>
#include <QTreeWidget>

#include "panels/form.h"
#include "panels/region_list.h"
#include "panels/series_tree.h"
#include "session/session.h"

namespace glisson::panels {

LoadPage::LoadPage(session::Session& session, QWidget* parent)
    : QWidget(parent),
      session_(session),
      stack_(new QStackedWidget),
      tree_(new SeriesTree(session)),
      regions_(new RegionList(session)),
      skipped_(new QTreeWidget),
      summary_(labelled({}, "faint")),
      noticeText_(labelled({}, "text")),
      notice_(new QFrame),
      answer_(
          button("answerButton", tr("Answer…"), {}, tr("Asks again whether, and as what, the elastogram is used"))) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  notice_->setObjectName(QStringLiteral("loadNotice"));
  auto* row = new QHBoxLayout(notice_);
  row->setContentsMargins(24, 12, 24, 0);
  noticeText_->setObjectName(QStringLiteral("loadNoticeText"));
  row->addWidget(noticeText_, 1);
  row->addWidget(answer_);
  layout->addWidget(notice_);
  connect(answer_, &QPushButton::clicked, this, &LoadPage::answerWanted);
  connect(&session_, &session::Session::statusChanged, this, &LoadPage::showNotice);
  showNotice();
  layout->addWidget(stack_);
  stack_->addWidget(makeWelcome());
  stack_->addWidget(makeTable());
  connect(&session_, &session::Session::loaded, this, &LoadPage::fill);
  connect(regions_, &RegionList::wanted, this, &LoadPage::regionWanted);
}

bool LoadPage::correcting() const {
  return tree_->correcting();
}

QWidget* LoadPage::makeWelcome() {
  auto* page = new QWidget;
  auto* outer = new QVBoxLayout(page);
  auto* card = new QFrame;
  card->setProperty("role", "card");
  card->setFixedWidth(720);
  auto* layout = new QVBoxLayout(card);
  layout->setContentsMargins(40, 36, 40, 36);
  layout->setSpacing(14);
  auto* logo = new QLabel;
  logo->setPixmap(icon(QStringLiteral("glisson")).pixmap(72, 72));
  layout->addWidget(logo, 0, Qt::AlignHCenter);
  auto* title = labelled(tr("Open a patient"), "heading");
  title->setAlignment(Qt::AlignHCenter);
  layout->addWidget(title);
  auto* text = labelled(tr("A DICOM folder with an abdominal MRI and an MR elastogram, or NIfTI, NRRD and MetaImage "
                           "volumes, masks and stiffness maps. Drop them here together, or start with a synthetic "
                           "patient to look around."),
                        "faint");
  text->setAlignment(Qt::AlignHCenter);
  layout->addWidget(text);
  auto* row = new QHBoxLayout;
  auto* open =
      button("openFolderButton", tr("Open DICOM folder…"), QStringLiteral("load"), tr("Open a folder (Ctrl+O)"));
  open->setProperty("primary", true);
  auto* synthetic = button("syntheticButton", tr("Synthetic patient"), QStringLiteral("patient"),
                           tr("Makes a synthetic patient as DICOM and opens it (Ctrl+Shift+N)"));
  auto* files = button("openFilesButton", tr("Open files…"), QStringLiteral("import"),
                       tr("Volumes, masks, maps, an archive or a case (Ctrl+Shift+O)"));
  row->addWidget(open);
  row->addWidget(files);
  row->addWidget(synthetic);
  layout->addLayout(row);
  connect(files, &QPushButton::clicked, this, &LoadPage::filesWanted);
  const QStringList recent = QSettings().value(QStringLiteral("recent")).toStringList().mid(0, 4);
  if (!recent.isEmpty()) layout->addWidget(section(tr("Recent")));
  for (const QString& path : recent) {
    const QString shown = path.endsWith(QStringLiteral("/case.json")) ? path.section(QLatin1Char('/'), -2, -2)
                                                                      : path.section(QLatin1Char('/'), -1);
    auto* again = button("recentButton", shown, QStringLiteral("load"), path);
    again->setProperty("flat", true);
    layout->addWidget(again);
    connect(again, &QPushButton::clicked, this, [this, path] { emit pathWanted(path); });
  }
  outer->addWidget(card, 0, Qt::AlignCenter);
  connect(open, &QPushButton::clicked, this, &LoadPage::openWanted);
  connect(synthetic, &QPushButton::clicked, this, &LoadPage::syntheticWanted);
  return page;
}

QWidget* LoadPage::makeTable() {
  auto* page = new QWidget;
  auto* layout = new QVBoxLayout(page);
  layout->setContentsMargins(24, 20, 24, 20);
  layout->setSpacing(10);
  auto* head = new QHBoxLayout;
  auto* titles = new QVBoxLayout;
  titles->addWidget(labelled(tr("Series"), "heading"));
  titles->addWidget(summary_);
  head->addLayout(titles, 1);
  auto* another =
      button("openAnotherButton", tr("Open another…"), QStringLiteral("load"), tr("Open another folder (Ctrl+O)"));
  head->addWidget(another, 0, Qt::AlignTop);
  connect(another, &QPushButton::clicked, this, &LoadPage::openWanted);
  next_ = button("toSegmentButton", tr("Outline the liver"), {}, tr("Goes on with the series in use"));
  next_->setProperty("primary", true);
  head->addWidget(next_, 0, Qt::AlignTop);
  connect(next_, &QPushButton::clicked, this, &LoadPage::segmentWanted);
  layout->addLayout(head);
  layout->addWidget(tree_, 3);
  regionsHead_ = section(tr("Outlines and masks beside the images"));
  layout->addWidget(regionsHead_);
  layout->addWidget(regions_);
  layout->addWidget(section(tr("Files left out")));
  skipped_->setObjectName(QStringLiteral("skippedFiles"));
  skipped_->setHeaderLabels({tr("File"), tr("Reason")});
  skipped_->setRootIsDecorated(false);
  skipped_->header()->setSectionResizeMode(0, QHeaderView::ResizeToContents);
  layout->addWidget(skipped_, 1);
  return page;
}

void LoadPage::showNotice() {
  const session::StepStatus status = session_.status(session::Step::Load);
  const std::optional<session::Question>& question = session_.images().question;
  QString text;
  const std::optional<session::Refusal>& refusal = session_.refusal();
  if (refusal) {
    text = tr("“%1” was not opened: %2").arg(refusal->what, refusal->reason);
    if (session_.images().mri) text += QLatin1Char('\n') + tr("What was open before is still open.");
  } else if (status.state == session::StepState::Failed)
    text = tr("Not opened: %1").arg(status.detail);
  else if (question && status.state != session::StepState::Running)
    text = question->kind == session::Question::Kind::None
               ? question->text
               : tr("%1 The elastogram is left out until this is answered.").arg(question->text);
  notice_->setVisible(!text.isEmpty());
  noticeText_->setText(text);
  noticeText_->setTextFormat(Qt::PlainText);  // names of files are in it
  answer_->setVisible(!refusal && question && question->kind != session::Question::Kind::None && !session_.busy());
}

void LoadPage::fill() {
  const dicom::ScanResult& scan = session_.scan();
  stack_->setCurrentIndex(1);
  summary_->setText(tr("%1 series, %2 files left out. Tick the series to be used; correct a role where it is wrong.")
                        .arg(static_cast<qulonglong>(scan.series.size()))
                        .arg(static_cast<qulonglong>(scan.skipped.size())));
  next_->setEnabled(session_.images().mri != nullptr);
  tree_->fill();
  regions_->fill();
  regionsHead_->setVisible(!session_.regions().empty());
  skipped_->clear();
  for (const dicom::SkippedFile& f : scan.skipped)
    new QTreeWidgetItem(skipped_,
                        {QString::fromStdString(f.file.filename().string()), QString::fromStdString(f.reason)});
}

}  // namespace glisson::panels
