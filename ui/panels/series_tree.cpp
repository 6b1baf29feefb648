// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/series_tree.h"

#include <QComboBox>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QTimer>
#include <algorithm>
#include <array>
#include <memory>

#include "session/said.h"
#include "session/series_groups.h"
#include "session/session.h"
#include "session/volume_files.h"

namespace glisson::panels {

namespace {

using dicom::SeriesRole;
constexpr std::array roles = {SeriesRole::Anatomical, SeriesRole::Magnitude,  SeriesRole::Wave,
                              SeriesRole::Stiffness,  SeriesRole::Confidence, SeriesRole::Phase,
                              SeriesRole::ColourCopy, SeriesRole::Other};

constexpr int thumbnail_px = 48;

QString nameOf(SeriesRole role) {
  switch (role) {
    case SeriesRole::Anatomical: return SeriesTree::tr("anatomical");
    case SeriesRole::Magnitude: return SeriesTree::tr("magnitude");
    case SeriesRole::Wave: return SeriesTree::tr("wave");
    case SeriesRole::Stiffness: return SeriesTree::tr("stiffness");
    case SeriesRole::Confidence: return SeriesTree::tr("confidence");
    case SeriesRole::ColourCopy: return SeriesTree::tr("colour copy");
    case SeriesRole::Phase: return SeriesTree::tr("raw phase");
    case SeriesRole::Other: break;
  }
  return SeriesTree::tr("other");
}

QString sizeText(const dicom::Series& series) {
  return QStringLiteral("%1 × %2 × %3").arg(series.grid.size.x()).arg(series.grid.size.y()).arg(series.grid.size.z());
}

QString spacingText(const dicom::Series& series) {
  const Eigen::Vector3d& s = series.grid.spacing_mm;
  return QStringLiteral("%1 × %2 × %3 mm").arg(s.x(), 0, 'g', 3).arg(s.y(), 0, 'g', 3).arg(s.z(), 0, 'g', 3);
}

QString headingOf(const session::PatientGroup& patient) {
  return patient.number == 0 ? SeriesTree::tr("Volume files, of no named patient")
                             : SeriesTree::tr("Patient %1").arg(patient.number);
}

QString headingOf(const session::StudyGroup& study) {
  const QString day = study.date.empty() ? SeriesTree::tr("without a date") : QString::fromStdString(study.date);
  return study.modalities.empty()
             ? SeriesTree::tr("Files, %1").arg(day)
             : SeriesTree::tr("%1 examination, %2").arg(QString::fromStdString(study.modalities), day);
}

/// A fixed height, and the thumbnail beside the name.
void look(QTreeWidgetItem* item, const QString& text, int column, const QString& tip = {}) {
  item->setText(column, text);
  item->setToolTip(column, tip.isEmpty() ? text : tip);
}

}  // namespace

SeriesTree::SeriesTree(session::Session& session, QWidget* parent) : QTreeWidget(parent), session_(session) {
  setObjectName(QStringLiteral("seriesTree"));
  setAccessibleName(tr("Patients, studies and series"));
  setHeaderLabels({tr("Series"), tr("In use"), tr("Role"), tr("Why"), tr("Voxels"), tr("Spacing"), tr("Warnings")});
  setIconSize({thumbnail_px, thumbnail_px});
  setAlternatingRowColors(true);
  setSelectionMode(QAbstractItemView::SingleSelection);
  header()->setDefaultAlignment(Qt::AlignLeft | Qt::AlignVCenter);
  header()->setStretchLastSection(false);
  header()->setSectionResizeMode(QHeaderView::ResizeToContents);
  header()->setSectionResizeMode(Name, QHeaderView::Interactive);
  header()->resizeSection(Name, 320);
  header()->setSectionResizeMode(Role, QHeaderView::Fixed);
  header()->resizeSection(Role, 150);
  header()->setSectionResizeMode(Why, QHeaderView::Stretch);
  header()->setSectionResizeMode(Warnings, QHeaderView::Interactive);
  header()->resizeSection(Warnings, 180);
  connect(this, &QTreeWidget::itemChanged, this, [this](QTreeWidgetItem* item, int column) {
    if (filling_ || column != Use) return;
    const auto found = std::find(items_.begin(), items_.end(), item);
    // The tree is made anew by what follows: not while it is at work.
    const int series = static_cast<int>(found - items_.begin());
    if (found != items_.end()) QTimer::singleShot(0, this, [this, series] { take(series); });
  });
  connect(&session_, &session::Session::workStarted, this, [this] { correcting_ = false; });
}

QTreeWidgetItem* SeriesTree::itemOf(int series) const {
  return series < 0 || series >= static_cast<int>(items_.size()) ? nullptr : items_[static_cast<std::size_t>(series)];
}

void SeriesTree::take(int series) {
  if (series >= static_cast<int>(session_.scan().series.size())) return;
  const SeriesRole role = session_.scan().series[static_cast<std::size_t>(series)].role;
  if (!session_.inUse(series)) {
    session_.setRole(series, role == SeriesRole::Other ? SeriesRole::Anatomical : role);
    correcting_ = session_.busy();
  }
  if (!session_.busy()) fill();  // what is in use stays in use until another one is taken
}

QTreeWidgetItem* SeriesTree::addSeries(QTreeWidgetItem* study, int index) {
  const dicom::Series& s = session_.scan().series[static_cast<std::size_t>(index)];
  auto* item = new QTreeWidgetItem(study);
  const session::OpenImages& images = session_.images();
  const bool drawnOn = images.mri && index == images.mriSeries;
  const bool used = session_.inUse(index);
  const QString name = QString::fromStdString(s.description);
  look(item, session::isVolume(s) ? name : QStringLiteral("%1  %2").arg(s.number).arg(name), Name);
  item->setSizeHint(Name, QSize(0, thumbnail_px + 8));
  item->setCheckState(Use, used ? Qt::Checked : Qt::Unchecked);
  item->setToolTip(Use, drawnOn ? tr("In use: the MRI that is drawn on")
                        : used  ? tr("In use: the elastogram that is measured")
                                : tr("Use this one"));
  Qt::ItemFlags flags = Qt::ItemIsEnabled | Qt::ItemIsSelectable;
  if (!s.error) flags |= Qt::ItemIsUserCheckable;
  item->setFlags(flags);
  QFont bold = font();
  bold.setBold(used);
  item->setFont(Name, bold);
  look(item, QString::fromStdString(s.error ? *s.error : s.roleReason), Why);
  look(item, sizeText(s), Voxels);
  look(item, spacingText(s), Spacing);
  const QStringList warnings = session::said(s.warnings, s.diagnostics);
  look(item, warnings.join(QStringLiteral("; ")), Warnings, warnings.join(QLatin1Char('\n')));
  auto* role = new QComboBox;
  for (const SeriesRole r : roles) role->addItem(nameOf(r), static_cast<int>(r));
  role->setCurrentIndex(role->findData(static_cast<int>(s.role)));
  role->setEnabled(!s.error);
  role->setAccessibleName(tr("Role of series %1").arg(s.number));
  connect(role, &QComboBox::activated, this, [this, role, index] {
    session_.setRole(index, static_cast<SeriesRole>(role->currentData().toInt()));
    correcting_ = session_.busy();
  });
  auto* place = new QWidget;  // else the control would be as high as the thumbnail
  auto* middle = new QHBoxLayout(place);
  middle->setContentsMargins(4, 0, 4, 0);
  middle->addWidget(role);
  setItemWidget(item, Role, place);
  return item;
}

void SeriesTree::fill() {
  filling_ = true;
  clear();
  items_.assign(session_.scan().series.size(), nullptr);
  for (const session::PatientGroup& patient : session::groupsOf(session_.scan())) {
    auto* head = new QTreeWidgetItem(this, {headingOf(patient)});
    head->setFirstColumnSpanned(true);
    head->setFlags(Qt::ItemIsEnabled);
    QFont bold = font();
    bold.setBold(true);
    head->setFont(Name, bold);
    for (const session::StudyGroup& study : patient.studies) {
      auto* examination = new QTreeWidgetItem(head, {headingOf(study)});
      examination->setFirstColumnSpanned(true);
      examination->setFlags(Qt::ItemIsEnabled);
      for (const int series : study.series) items_[static_cast<std::size_t>(series)] = addSeries(examination, series);
    }
  }
  expandAll();
  filling_ = false;
  drawThumbnails();
}

// The middle slice of every series, read and averaged down by a worker.
void SeriesTree::drawThumbnails() {
  if (painter_.busy()) return;
  auto pictures = std::make_shared<std::vector<dicom::Thumbnail>>();
  const int size = qRound(thumbnail_px * devicePixelRatioF());
  const QString path = session_.path();
  painter_.start(
      [pictures, size, series = session_.scan().series](const Progress& progress) {
        for (const dicom::Series& s : series) {
          progress.check();
          pictures->push_back(session::smallPicture(s, size));
        }
      },
      [this, pictures, path](std::exception_ptr failure) {
        if (path != session_.path()) {
          drawThumbnails();  // another patient was opened meanwhile
          return;
        }
        if (failure) return;  // the tree says what is wrong with a series
        filling_ = true;
        for (std::size_t i = 0; i < std::min(items_.size(), pictures->size()); ++i) {
          const dicom::Thumbnail& t = (*pictures)[i];
          if (t.width == 0 || !items_[i]) continue;
          QImage image = QImage(t.grey.data(), t.width, t.height, t.width, QImage::Format_Grayscale8).copy();
          image.setDevicePixelRatio(devicePixelRatioF());
          items_[i]->setIcon(Name, QIcon(QPixmap::fromImage(image)));
        }
        filling_ = false;
      });
}

}  // namespace glisson::panels
