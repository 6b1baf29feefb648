// SPDX-License-Identifier: GPL-3.0-or-later

// Compare: vessels beyond 5 mm, the box plot, what is said of results that are outdated, and the export.
#include <QCheckBox>
#include <QComboBox>
#include <QFileDialog>
#include <QHeaderView>
#include <QSignalBlocker>
#include <QSlider>
#include <QTreeWidget>
#include <algorithm>

#include "panels/compare_page.h"
#include "panels/contact_table.h"
#include "panels/form.h"
#include "panels/language.h"
#include "panels/trust_panel.h"
#include "pipeline/pictures.h"
#include "session/session.h"
#include "uncertainty/surgeon.h"
#include "views/picture_view.h"
#include "views/scene_view.h"

namespace glisson::panels {

QWidget* ComparePage::makeVesselList() {
  list_ = new QTreeWidget;
  list_->setObjectName(QStringLiteral("vesselList"));
  list_->setAccessibleName(tr("Places on vessels where MRE and atlas lie 5 mm or more apart"));
  list_->setHeaderLabels({tr("Apart"), tr("Slice"), tr("L, P, S (mm)")});
  list_->setRootIsDecorated(false);
  list_->setUniformRowHeights(true);
  list_->setFixedHeight(108);
  list_->header()->setStretchLastSection(true);
  list_->setColumnWidth(0, 78);
  list_->setColumnWidth(1, 60);
  list_->setToolTip(tr("Choose a place: the slice shows it, magnified"));
  connect(list_, &QTreeWidget::currentItemChanged, this,
          [this](QTreeWidgetItem* item) { showVessel(item ? list_->indexOfTopLevelItem(item) : -1); });
  connect(list_, &QTreeWidget::itemClicked, this,
          [this](QTreeWidgetItem* item) { showVessel(list_->indexOfTopLevelItem(item)); });
  return list_;
}

void ComparePage::showVessels() {
  const QSignalBlocker quiet(list_);
  list_->clear();
  places_.clear();
  const auto result = session_.result();
  const auto picture = session_.picture();
  export_->setEnabled(result && picture && !session_.busy());
  video_->setEnabled(export_->isEnabled() && picture->valid);
  if (result && picture) places_ = session::vesselsBeyond(*result, *picture);
  list_->setVisible(!places_.empty());
  QList<QTreeWidgetItem*> rows;
  for (const session::VesselPlace& place : places_) {
    const double k = picture->mri.grid.lpsToIndex(place.seen_lps).z();
    auto* row = new QTreeWidgetItem({tr("%1 mm").arg(place.apart_mm, 0, 'f', 1), QString::number(qRound(k) + 1),
                                     QStringLiteral("%1, %2, %3")
                                         .arg(place.rest_lps.x(), 0, 'f', 0)
                                         .arg(place.rest_lps.y(), 0, 'f', 0)
                                         .arg(place.rest_lps.z(), 0, 'f', 0)});
    rows << row;
  }
  list_->addTopLevelItems(rows);
  markVessels(-1);
}

/// Rings round the listed places in 3-D, the chosen one larger and with its distance.
void ComparePage::markVessels(int chosen) {
  std::vector<views::Mark> marks;
  const int count = shown_->currentIndex() == 0 ? static_cast<int>(places_.size()) : 0;
  for (int n = 0; n < count; ++n) {
    const session::VesselPlace& place = places_[static_cast<std::size_t>(n)];
    views::Mark mark{.id = n + 1, .at_lps = place.seen_lps, .shape = views::Mark::Shape::Ring};
    mark.colour = QColor(255, 176, 32);
    mark.current = n == chosen;
    if (mark.current) mark.text = tr("%1 mm").arg(place.apart_mm, 0, 'f', 1);
    marks.push_back(mark);
  }
  // The chosen one lies over its neighbours.
  if (chosen >= 0 && chosen < count) std::rotate(marks.begin() + chosen, marks.begin() + chosen + 1, marks.end());
  scene_->setMarks(std::move(marks));
}

void ComparePage::showVessel(int row) {
  const auto picture = session_.picture();
  if (row < 0 || row >= static_cast<int>(places_.size()) || !picture) return;
  vessel_ = places_[static_cast<std::size_t>(row)];
  chosen_ = true;
  markVessels(row);
  emit placeChosen(vessel_->rest_lps);
  const QSignalBlocker quiet(slice_);
  slice_->setValue(qRound(picture->mri.grid.lpsToIndex(vessel_->seen_lps).z()));
  drawSlice();
}

void ComparePage::drawCharts() {
  boxes_->clear();
  forces_->clear();
  sources_->clear();
  const auto result = session_.result();
  const auto picture = session_.picture();
  if (!result || !picture || charter_.busy()) return;
  struct Drawn {
    render::Picture boxes, forces, sources;
  };
  auto drawn = std::make_shared<Drawn>();
  charter_.start(
      [result, picture, drawn](const Progress&) {
        constexpr render::ChartSize size{1100, 1000};
        if (result->difference && result->atlas)
          drawn->boxes = render::draw(session::differenceBoxes(*result, *picture), size);
        if (picture->bar && !picture->bar->mre.path.empty())
          drawn->forces = render::draw(pipeline::forceChart(*picture->bar), size);
        if (const auto numbers = pipeline::sureNumbersOf(*result))
          if (const auto chart = pipeline::retractorTornado(*numbers, spoken()))
            drawn->sources = render::draw(*chart, size);
      },
      [this, drawn, result](std::exception_ptr failure) {
        if (result != session_.result()) {
          drawCharts();
        } else if (failure) {
          boxes_->setHint(session::reasonOf(failure));
        } else {
          if (drawn->boxes.width > 0) boxes_->setPicture(drawn->boxes);
          if (drawn->forces.width > 0) forces_->setPicture(drawn->forces);
          if (drawn->sources.width > 0) sources_->setPicture(drawn->sources);
        }
      });
}

namespace {

/// What the last run says of how sure its differences are; null where it does not.
const uncertainty::Headline* headlineOf(const pipeline::RunResult& result) {
  const auto& u = result.uncertainty;
  return u && u->known && u->spread.headline ? &*u->spread.headline : nullptr;
}

QString inWords(const uncertainty::Interval& interval) {
  return QString::fromStdString(uncertainty::rangeOf(interval, spoken())).replace(QLatin1Char(' '), QChar(0xa0));
}

}  // namespace

QString ComparePage::interval() const {
  const uncertainty::Headline* h = headlineOf(*session_.result());
  if (h == nullptr) return {};
  return tr("95 %: %1; chance of 5 mm or more: %2")
      .arg(inWords(h->at_retractor_mm), QString::fromStdString(uncertainty::percent(h->beyond, spoken())));
}

QString ComparePage::ofVessels() const {
  const uncertainty::Headline* h = headlineOf(*session_.result());
  if (h == nullptr || !h->vessels) return {};
  QString words = tr("\n95 %: mean %1, largest %2; %3 to %4 % at 5\u00a0mm or more")
                      .arg(inWords(h->vessels->mean_mm), inWords(h->vessels->max_mm))
                      .arg(100 * h->vessels->beyond.low, 0, 'f', 0)
                      .arg(100 * h->vessels->beyond.high, 0, 'f', 0);
  const auto& u = *session_.result()->uncertainty;
  if (const std::string told = uncertainty::forSurgeon(u.tip, u.spread, spoken()); !told.empty())
    words += QLatin1Char('\n') + QString::fromStdString(told) + QLatin1Char('.');
  return words;
}

QWidget* ComparePage::makeOutdated() {
  auto* card = new QFrame;
  card->setObjectName(QStringLiteral("outdatedCard"));
  card->setProperty("role", "card");
  auto* column = new QVBoxLayout(card);
  column->setContentsMargins(10, 8, 10, 8);
  outdatedText_ = labelled({}, "caution");
  outdatedText_->setObjectName(QStringLiteral("outdatedText"));
  column->addWidget(outdatedText_);
  again_ = button("runAgainButton", tr("Run again"), QStringLiteral("run"), tr("With what is outlined and set now"));
  column->addWidget(again_);
  connect(again_, &QPushButton::clicked, this, &ComparePage::runWanted);
  outdated_ = card;
  return card;
}

// Numbers of a run that is not of what is set now are greyed, its pictures as well.
void ComparePage::showOutdated() {
  const QString words = TrustPanel::outdated(session_);
  outdated_->setVisible(!words.isEmpty());
  outdatedText_->setText(words.isEmpty() ? words : words + QLatin1Char('.'));
  again_->setEnabled(!session_.busy());
  for (QWidget* shown :
       {static_cast<QWidget*>(retractor_), static_cast<QWidget*>(retractorError_), static_cast<QWidget*>(verdict_),
        static_cast<QWidget*>(contact_), static_cast<QWidget*>(numbers_), static_cast<QWidget*>(vessels_)})
    shown->setEnabled(words.isEmpty());
  for (views::PictureView* view : {overlay_, boxes_, forces_}) view->setOutdated(words);
  scene_->setOutdated(words);
}

void ComparePage::askWhereTo() {
  const QString folder = QFileDialog::getExistingDirectory(this, tr("Folder for pictures and report"));
  if (!folder.isEmpty()) exportTo(folder);
}

void ComparePage::askForVideo() {
  const QString file = QFileDialog::getSaveFileName(this, tr("Film the retraction"), QStringLiteral("retraction.webm"),
                                                    tr("Videos (*.webm *.mp4)"));
  if (!file.isEmpty()) filmTo(file);
}

void ComparePage::filmTo(const QString& file) {
  session::VideoWish wish;
  wish.shown = static_cast<render::Shown3D>(shown_->currentIndex());
  wish.palette = palette_();
  wish.view = static_cast<render::View3D>(view_->currentData().toInt());
  wish.arrows = arrows_->isChecked();
  session_.exportVideo(file, wish);
}

void ComparePage::exportTo(const QString& folder) {
  session_.exportInto(folder, palette_());
}

}  // namespace glisson::panels
