#include "panels/load_page.h"

#include <QComboBox>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QSettings>
#include <QStackedWidget>
#include <QTableWidget>
#include <QTreeWidget>
#include <algorithm>
#include <array>
#include <memory>

#include "dicom/thumbnail.h"
#include "panels/form.h"
#include "session/session.h"

namespace glisson::panels {

namespace {

using dicom::SeriesRole;
constexpr std::array roles = {SeriesRole::Anatomical, SeriesRole::Magnitude,  SeriesRole::Wave,
                              SeriesRole::Stiffness,  SeriesRole::Confidence, SeriesRole::Phase,
                              SeriesRole::ColourCopy, SeriesRole::Other};

constexpr int thumbnail_px = 56;

QTableWidgetItem* cell(const QString& text, const QString& tip = {}) {
  auto* item = new QTableWidgetItem(text);
  item->setFlags(Qt::ItemIsEnabled | Qt::ItemIsSelectable);
  item->setToolTip(tip.isEmpty() ? text : tip);
  return item;
}

QString sizeText(const dicom::Series& series) {
  return QStringLiteral("%1 × %2 × %3").arg(series.grid.size.x()).arg(series.grid.size.y()).arg(series.grid.size.z());
}

QString spacingText(const dicom::Series& series) {
  const Eigen::Vector3d& s = series.grid.spacing_mm;
  return QStringLiteral("%1 × %2 × %3 mm").arg(s.x(), 0, 'g', 3).arg(s.y(), 0, 'g', 3).arg(s.z(), 0, 'g', 3);
}

}  // namespace

LoadPage::LoadPage(session::Session& session, QWidget* parent)
    : QWidget(parent),
      session_(session),
      stack_(new QStackedWidget),
      table_(new QTableWidget),
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
  connect(&session_, &session::Session::workStarted, this, [this] { correcting_ = false; });
}

QWidget* LoadPage::makeWelcome() {
  auto* page = new QWidget;
  auto* outer = new QVBoxLayout(page);
  auto* card = new QFrame;
  card->setProperty("role", "card");
  card->setFixedWidth(560);
  auto* layout = new QVBoxLayout(card);
  layout->setContentsMargins(40, 36, 40, 36);
  layout->setSpacing(14);
  auto* logo = new QLabel;
  logo->setPixmap(icon(QStringLiteral("glisson")).pixmap(72, 72));
  layout->addWidget(logo, 0, Qt::AlignHCenter);
  auto* title = labelled(tr("Open a patient"), "heading");
  title->setAlignment(Qt::AlignHCenter);
  layout->addWidget(title);
  auto* text = labelled(tr("A DICOM folder with an abdominal MRI and an MR elastogram. Drop it here, or start with a "
                           "synthetic patient to look around."),
                        "faint");
  text->setAlignment(Qt::AlignHCenter);
  layout->addWidget(text);
  auto* row = new QHBoxLayout;
  auto* open =
      button("openFolderButton", tr("Open DICOM folder…"), QStringLiteral("load"), tr("Open a folder (Ctrl+O)"));
  open->setProperty("primary", true);
  auto* synthetic = button("syntheticButton", tr("Synthetic patient"), QStringLiteral("patient"),
                           tr("Makes a synthetic patient as DICOM and opens it (Ctrl+Shift+N)"));
  row->addWidget(open);
  row->addWidget(synthetic);
  layout->addLayout(row);
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
  table_->setObjectName(QStringLiteral("seriesTable"));
  table_->setColumnCount(7);
  table_->setHorizontalHeaderLabels(
      {tr("No."), tr("Description"), tr("Role"), tr("Why"), tr("Voxels"), tr("Spacing"), tr("Warnings")});
  table_->verticalHeader()->hide();
  table_->verticalHeader()->setDefaultSectionSize(thumbnail_px + 8);
  table_->setIconSize({thumbnail_px, thumbnail_px});
  table_->horizontalHeader()->setDefaultAlignment(Qt::AlignLeft | Qt::AlignVCenter);
  table_->setShowGrid(false);
  table_->setAlternatingRowColors(true);
  table_->setSelectionBehavior(QAbstractItemView::SelectRows);
  table_->horizontalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
  table_->horizontalHeader()->setSectionResizeMode(3, QHeaderView::Stretch);
  table_->horizontalHeader()->setSectionResizeMode(6, QHeaderView::Interactive);
  table_->setColumnWidth(6, 220);
  table_->horizontalHeader()->setSectionResizeMode(2, QHeaderView::Fixed);
  table_->setColumnWidth(2, 150);
  layout->addWidget(table_, 3);
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
  if (status.state == session::StepState::Failed)
    text = tr("Not opened: %1").arg(status.detail);
  else if (question && status.state != session::StepState::Running)
    text = question->kind == session::Question::Kind::None
               ? question->text
               : tr("%1 The elastogram is left out until this is answered.").arg(question->text);
  notice_->setVisible(!text.isEmpty());
  noticeText_->setText(text);
  answer_->setVisible(question && question->kind != session::Question::Kind::None && !session_.busy());
}

void LoadPage::fill() {
  const dicom::ScanResult& scan = session_.scan();
  stack_->setCurrentIndex(1);
  summary_->setText(tr("%1 series, %2 files left out. ✓: in use. Correct a role where the guess is wrong.")
                        .arg(static_cast<qulonglong>(scan.series.size()))
                        .arg(static_cast<qulonglong>(scan.skipped.size())));
  const session::OpenImages& images = session_.images();
  next_->setEnabled(images.mri != nullptr);
  table_->setRowCount(static_cast<int>(scan.series.size()));
  for (int row = 0; row < table_->rowCount(); ++row) {
    const dicom::Series& s = scan.series[static_cast<std::size_t>(row)];
    const bool drawnOn = images.mri && row == images.mriSeries;
    const bool measured = images.stiffness && row == images.stiffnessSeries;
    const QString use =
        drawnOn ? tr("In use: the MRI that is drawn on") : tr("In use: the elastogram that is measured");
    const bool used = drawnOn || measured;
    table_->setItem(
        row, 0, cell((used ? QStringLiteral("✓ ") : QString()) + QString::number(s.number), used ? use : QString()));
    table_->setItem(row, 1, cell(QString::fromStdString(s.description)));
    QFont bold = table_->font();
    bold.setBold(used);
    for (const int column : {0, 1}) table_->item(row, column)->setFont(bold);
    auto* role = new QComboBox;
    for (const SeriesRole r : roles) role->addItem(QString::fromStdString(dicom::name(r)), static_cast<int>(r));
    role->setCurrentIndex(role->findData(static_cast<int>(s.role)));
    role->setEnabled(!s.error);
    connect(role, &QComboBox::activated, this, [this, role, row] {
      session_.setRole(row, static_cast<SeriesRole>(role->currentData().toInt()));
      correcting_ = session_.busy();
    });
    auto* place = new QWidget;  // else the control would be as high as the thumbnail
    auto* middle = new QHBoxLayout(place);
    middle->setContentsMargins(4, 0, 4, 0);
    middle->addWidget(role);
    table_->setCellWidget(row, 2, place);
    table_->setItem(row, 3, cell(QString::fromStdString(s.error ? *s.error : s.roleReason)));
    table_->setItem(row, 4, cell(sizeText(s)));
    table_->setItem(row, 5, cell(spacingText(s)));
    QStringList warnings;
    for (const std::string& w : s.warnings) warnings << QString::fromStdString(w);
    table_->setItem(row, 6, cell(warnings.join(QStringLiteral("; ")), warnings.join(QLatin1Char('\n'))));
  }
  drawThumbnails();
  skipped_->clear();
  for (const dicom::SkippedFile& f : scan.skipped)
    new QTreeWidgetItem(skipped_,
                        {QString::fromStdString(f.file.filename().string()), QString::fromStdString(f.reason)});
}

// The middle slice of every series, read and averaged down by a worker.
void LoadPage::drawThumbnails() {
  if (painter_.busy()) return;
  auto pictures = std::make_shared<std::vector<dicom::Thumbnail>>();
  const int size = qRound(thumbnail_px * devicePixelRatioF());
  const QString path = session_.path();
  painter_.start(
      [pictures, size, series = session_.scan().series](const Progress& progress) {
        for (const dicom::Series& s : series) {
          progress.check();
          pictures->push_back(dicom::thumbnail(s, size));
        }
      },
      [this, pictures, path](std::exception_ptr failure) {
        if (path != session_.path()) {
          drawThumbnails();  // another patient was opened meanwhile
          return;
        }
        if (failure) return;  // the table says what is wrong with a series
        for (int row = 0; row < std::min(table_->rowCount(), static_cast<int>(pictures->size())); ++row) {
          const dicom::Thumbnail& t = (*pictures)[static_cast<std::size_t>(row)];
          if (t.width == 0 || !table_->item(row, 1)) continue;
          QImage image = QImage(t.grey.data(), t.width, t.height, t.width, QImage::Format_Grayscale8).copy();
          image.setDevicePixelRatio(devicePixelRatioF());
          table_->item(row, 1)->setIcon(QIcon(QPixmap::fromImage(image)));
        }
      });
}

}  // namespace glisson::panels
