// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/compare_page.h"

#include <QCheckBox>
#include <QComboBox>
#include <QSlider>
#include <QSplitter>
#include <QStackedWidget>
#include <QStandardItemModel>
#include <QTreeWidget>
#include <cmath>

#include "panels/contact_table.h"
#include "panels/form.h"
#include "panels/language.h"
#include "panels/method_chart.h"
#include "panels/palette_choice.h"
#include "panels/trust_panel.h"
#include "pipeline/pictures.h"
#include "render/maps.h"
#include "session/session.h"
#include "session/trust.h"
#include "views/picture_view.h"
#include "views/scene_view.h"

namespace glisson::panels {

namespace {

QString mm(double value) {
  return QString::number(value, 'f', 2) + QStringLiteral("\u00a0mm");  // number and unit on one line
}

/// The slice of an overlay as a map: of the difference, or of the chance of 5 mm. ring: a place to mark, or null.
render::Picture mapOf(const render::RetractionScene& scene, const render::SliceOverlayOptions& overlay, bool chance,
                      const Eigen::Vector3d* ring) {
  render::MapOptions map{.high = 10.0};
  map.language = spoken();
  map.slice = overlay.slice;
  map.margin_mm = overlay.margin_mm;
  if (ring != nullptr) map.ring_lps_mm = *ring;
  return chance ? render::probabilityPicture(scene, map) : render::differencePicture(scene, map);
}

}  // namespace

ComparePage::ComparePage(session::Session& session, QWidget* parent)
    : QWidget(parent),
      session_(session),
      overlay_(new views::PictureView),
      scene_(new views::SceneView),
      boxes_(new views::PictureView),
      forces_(new views::PictureView),
      sources_(new views::PictureView) {
  overlay_->setObjectName(QStringLiteral("overlayView"));
  overlay_->setHint(tr("Run the retraction to compare MRE with the atlas."));
  scene_->setObjectName(QStringLiteral("compareScene"));
  scene_->setHint(tr("The vessels in 3-D appear here."));
  boxes_->setObjectName(QStringLiteral("boxPlotView"));
  boxes_->setHint(tr("The box plot of the differences appears here."));
  forces_->setObjectName(QStringLiteral("forceView"));
  sources_->setObjectName(QStringLiteral("sourcesView"));
  beside_ = new QStackedWidget;
  beside_->addWidget(scene_);
  beside_->addWidget(boxes_);
  beside_->addWidget(new MethodChart(session_));
  beside_->addWidget(forces_);
  beside_->addWidget(sources_);
  auto* left = new QWidget;
  auto* column = new QVBoxLayout(left);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  column->addWidget(overlay_, 1);
  auto* bar = new QHBoxLayout;
  bar->setContentsMargins(14, 8, 14, 8);
  slice_ = new QSlider(Qt::Horizontal);
  slice_->setObjectName(QStringLiteral("overlaySlice"));
  slice_->setEnabled(false);
  sliceText_ = new QLabel;
  sliceText_->setMinimumWidth(110);
  sliceText_->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
  bar->addWidget(slice_, 1);
  bar->addWidget(sliceText_);
  column->addLayout(bar);
  auto* splitter = new QSplitter;
  splitter->setHandleWidth(3);
  splitter->setChildrenCollapsible(false);
  splitter->addWidget(left);
  splitter->addWidget(beside_);
  splitter->setSizes({1000, 1000});
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(0);
  row->addWidget(splitter, 1);
  row->addWidget(makeSide());
  connect(slice_, &QSlider::valueChanged, this, [this] {
    chosen_ = true;
    vessel_.reset();
    drawSlice();
  });
  connect(overlay_, &views::PictureView::sliceWanted, this,
          [this](int step) { slice_->setValue(slice_->value() + step); });
  connect(overlay_, &views::PictureView::resized, this, [this] {
    if (magnify_->isChecked() && what_->currentIndex() == 0 && insetBelow() != zoomIsBelow_) drawSlice();
  });
  connect(&session_, &session::Session::runFinished, this, &ComparePage::showResult);
  connect(&session_, &session::Session::loaded, this, &ComparePage::showResult);
  connect(&session_, &session::Session::statusChanged, this, &ComparePage::showOutdated);
  showNumbers();
}

QWidget* ComparePage::makeSide() {
  auto* frame = new SidePanel;
  QVBoxLayout* side = frame->column();
  side->addWidget(labelled(tr("MRE against atlas"), "heading"));
  side->addWidget(makeOutdated());
  side->addWidget(section(tr("Difference at the retractor")));
  retractor_ = labelled({}, "number");
  retractor_->setObjectName(QStringLiteral("differenceAtRetractor"));
  side->addWidget(retractor_);
  retractorError_ = labelled({}, "faint");
  retractorError_->setObjectName(QStringLiteral("differenceAtRetractorError"));
  side->addWidget(retractorError_);
  verdict_ = labelled({}, "text");
  verdict_->setObjectName(QStringLiteral("differenceVerdict"));
  side->addWidget(verdict_);
  side->addWidget(section(tr("How far to trust it")));
  trust_ = new TrustPanel(session_, QStringLiteral("validityText"));
  side->addWidget(trust_);
  connect(trust_, &TrustPanel::runWanted, this, &ComparePage::runWanted);
  side->addWidget(section(tr("Contact")));
  contact_ = new ContactTable(session_);
  side->addWidget(contact_);
  side->addWidget(section(tr("Over the whole liver")));
  numbers_ = labelled({}, "faint");
  numbers_->setObjectName(QStringLiteral("differenceNumbers"));
  side->addWidget(numbers_);
  side->addWidget(section(tr("Hepatic vessels")));
  vessels_ = labelled({}, "faint");
  vessels_->setObjectName(QStringLiteral("vesselNumbers"));
  side->addWidget(vessels_);
  side->addWidget(makeVesselList());
  side->addStretch();
  side->addWidget(section(tr("Display")));
  side->addWidget(makeDisplay());
  export_ = button("exportButton", tr("Export pictures and report…"), {},
                   tr("Slices, difference map, 3-D and box plot in these colours, report and record of the run"));
  export_->setEnabled(false);
  side->addWidget(export_);
  video_ = button("videoButton", tr("Film the retraction…"), {},
                  tr("The 3-D view from rest to the end, as WebM or MP4, with this camera and these colours"));
  video_->setEnabled(false);
  side->addWidget(video_);
  connect(export_, &QPushButton::clicked, this, &ComparePage::askWhereTo);
  connect(video_, &QPushButton::clicked, this, &ComparePage::askForVideo);
  connect(&session_, &session::Session::exported, this, &ComparePage::exported);
  connect(&session_, &session::Session::statusChanged, this, [this] {
    const bool can = session_.picture() && !session_.busy();
    export_->setEnabled(can);
    video_->setEnabled(can && session_.picture()->valid);
  });
  return frame;
}

QWidget* ComparePage::makeDisplay() {
  auto* held = new QWidget;
  auto* form = new QFormLayout(held);
  form->setContentsMargins(0, 0, 0, 0);
  const auto choice = [form](const char* name, const QString& label, const QStringList& items) {
    auto* box = new QComboBox;
    box->setObjectName(QLatin1String(name));
    box->addItems(items);
    form->addRow(label, box);
    return box;
  };
  colours_ = choice("paletteChoice", tr("Colours"), {tr("Red / blue"), tr("Orange / blue (colour-blind)")});
  colours_->setCurrentIndex(chosenPalette() == render::Palette::ColourBlind ? 1 : 0);
  scene_->setPalette3D(palette_());
  scene_->setLanguage(spoken());
  view_ = new QComboBox;
  view_->setObjectName(QStringLiteral("cameraChoice"));
  view_->addItem(tr("Oblique"), static_cast<int>(render::View3D::Oblique));
  view_->addItem(tr("From the front"), static_cast<int>(render::View3D::Anterior));
  view_->addItem(tr("From below"), static_cast<int>(render::View3D::Inferior));
  form->addRow(tr("Camera"), view_);
  shown_ = choice(
      "shownChoice", tr("3-D shows"),
      {tr("Both answers"), tr("Contact pressure, MRE"), tr("Contact pressure, atlas"), tr("How sure the vessels are")});
  what_ = choice("sliceChoice", tr("Slice"), {tr("Overlay"), tr("Difference in mm"), tr("Chance of 5 mm")});
  chart_ = choice(
      "besideChoice", tr("Beside it"),
      {tr("3-D"), tr("Box plot"), tr("Error against run time"), tr("Force against travel"), tr("What it depends on")});
  arrows_ = new QCheckBox(tr("Displacement arrows"));
  arrows_->setObjectName(QStringLiteral("arrowsChoice"));
  arrows_->setToolTip(tr("From rest to where either answer puts a place, true to scale, in the slice and in 3-D; at "
                         "most %1 places")
                          .arg(render::mostArrows));
  form->addRow(QString(), arrows_);
  magnify_ = new QCheckBox(tr("Magnify the difference"));
  magnify_->setObjectName(QStringLiteral("magnifyChoice"));
  magnify_->setToolTip(tr("Beside the slice: where both answers differ most in it, or the vessel that was chosen"));
  magnify_->setChecked(true);
  form->addRow(QString(), magnify_);
  for (QComboBox* box : {colours_, view_, shown_, what_, chart_}) {  // none makes the panel wider than it is
    box->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    box->setMinimumContentsLength(10);
  }
  linkDisplay();
  return held;
}

void ComparePage::linkDisplay() {
  connect(arrows_, &QCheckBox::toggled, this, [this](bool on) {
    scene_->setArrows(on);
    drawSlice();
  });
  connect(magnify_, &QCheckBox::toggled, this, &ComparePage::drawSlice);
  connect(scene_, &views::SceneView::markChosen, this,
          [this](int id) { list_->setCurrentItem(list_->topLevelItem(id - 1)); });
  connect(what_, &QComboBox::currentIndexChanged, this, [this](int index) {
    magnify_->setEnabled(index == 0);
    drawSlice();
  });
  connect(chart_, &QComboBox::currentIndexChanged, this, [this](int index) {
    beside_->setCurrentIndex(index);
    view_->setEnabled(index == 0);
  });
  connect(shown_, &QComboBox::currentIndexChanged, this, [this](int index) {
    chart_->setCurrentIndex(0);
    scene_->setShown(static_cast<render::Shown3D>(index));
    markVessels(-1);
  });
  connect(colours_, &QComboBox::currentIndexChanged, this, [this] {
    choosePalette(palette_());
    scene_->setPalette3D(palette_());
    drawSlice();
  });
  connect(view_, &QComboBox::activated, this,
          [this] { scene_->setView(static_cast<render::View3D>(view_->currentData().toInt())); });
}

render::Palette ComparePage::palette_() const {
  return colours_->currentIndex() == 1 ? render::Palette::ColourBlind : render::Palette::RedBlue;
}

void ComparePage::showResult() {
  const auto picture = session_.picture();
  scene_->setScene(picture);
  slice_->setEnabled(picture != nullptr);
  vessel_.reset();
  showVessels();
  drawCharts();
  showWhatThereIs();
  overlay_->clear();  // never the picture of the run before beside the numbers of this one
  if (!picture) {
    overlay_->setHint(tr("Run the retraction to compare MRE with the atlas."));
    sliceText_->clear();
    showNumbers();
    return;
  }
  const QSignalBlocker quiet(slice_);
  slice_->setRange(0, picture->mri.grid.size.z() - 1);
  chosen_ = false;
  drawSlice();
  showNumbers();
}

/// Pressure and way of the bar are there after a run with a rigid bar; how sure it is, where that was asked for.
void ComparePage::showWhatThereIs() {
  const auto picture = session_.picture();
  const bool bar = picture && picture->bar;
  const auto offer = [](QComboBox* box, int index, bool there) {
    qobject_cast<QStandardItemModel*>(box->model())->item(index)->setEnabled(there);
    if (!there && box->currentIndex() == index) box->setCurrentIndex(0);
  };
  offer(shown_, 3, bar && picture->sure && picture->sure->vessel95_mm.size() > 0);
  offer(what_, 2, bar && picture->sure && !picture->sure->beyond.values.empty());
  if (!bar) shown_->setCurrentIndex(0);
  shown_->setEnabled(bar);
  shown_->setToolTip(bar ? tr("Liver and vessels of both answers, or the contact pressure on one")
                         : tr("Contact pressure is known after a run with a rigid bar."));
  forces_->setHint(tr("After a run with a rigid bar: its force against its travel."));
  sources_->setHint(
      tr("After a run that says how sure it is (Model): what the difference at the retractor depends on."));
}

bool ComparePage::insetBelow() const {
  return overlay_->height() > overlay_->width();
}

void ComparePage::drawSlice() {
  const auto picture = session_.picture();
  if (!picture) return;
  if (!overlay_->hasPicture()) overlay_->setHint(tr("Drawing the slice…"));
  if (chosen_) sliceText_->setText(tr("slice %1 / %2").arg(slice_->value() + 1).arg(slice_->maximum() + 1));
  if (painter_.busy()) {
    wanted_ = true;
    return;
  }
  render::SliceOverlayOptions options;
  options.slice = chosen_ ? slice_->value() : -1;
  options.palette = palette_();
  options.margin_mm = 40.0;
  options.arrows = arrows_->isChecked();
  options.zoomBelow = insetBelow();
  zoomIsBelow_ = options.zoomBelow;
  const bool magnify = magnify_->isChecked();
  const std::optional<session::VesselPlace> vessel = vessel_;
  const int what = what_->currentIndex();
  struct Drawn {
    render::Picture picture;
    int slice = 0;
  };
  auto drawn = std::make_shared<Drawn>();
  painter_.start(
      [picture, options, drawn, what, magnify, vessel](const Progress&) mutable {
        // The first picture is of the slice where MRE and atlas differ most.
        if (options.slice < 0) options.slice = render::sliceOfLargestDifference(*picture);
        drawn->slice = options.slice;
        if (magnify)
          options.zoomCentre_lps_mm =
              vessel ? vessel->seen_lps : pipeline::placeOfLargestDifference(*picture, options.slice);
        if (vessel) options.ring_lps_mm = vessel->seen_lps;
        drawn->picture = what == 0 ? render::sliceOverlay(*picture, options)
                                   : mapOf(*picture, options, what == 2, vessel ? &vessel->rest_lps : nullptr);
      },
      [this, picture, drawn](std::exception_ptr failure) {
        const int shown = drawn->slice;
        if (failure) {
          overlay_->setHint(session::reasonOf(failure));
        } else if (picture == session_.picture()) {
          overlay_->setPicture(drawn->picture);
          if (!std::exchange(chosen_, true)) {
            const QSignalBlocker quiet(slice_);
            slice_->setValue(shown);
            sliceText_->setText(tr("slice %1 / %2").arg(shown + 1).arg(slice_->maximum() + 1));
          }
        }
        if (std::exchange(wanted_, false))
          drawSlice();
        else if (!failure)
          emit overlayShown(shown);
      });
}

QString ComparePage::verdictOf(pipeline::Significance significance) {
  switch (significance) {
    case pipeline::Significance::Open: return tr("Cannot be told from the 5\u00a0mm that matter clinically.");
    case pipeline::Significance::Beyond: return tr("5\u00a0mm or more: it matters clinically.");
    case pipeline::Significance::Below: break;
  }
  return tr("Below the 5\u00a0mm that matter clinically.");
}

void ComparePage::showNumbers() {
  const auto result = session_.result();
  contact_->show_();
  trust_->show_();
  showOutdated();
  if (!result || !result->difference) {
    retractor_->setText(QStringLiteral("–"));
    retractorError_->clear();
    verdict_->setText(!result                        ? QString()
                      : session::isNoAnswer(*result) ? tr("No difference is given: one of the two runs is no answer.")
                                                     : tr("Nothing was compared."));
    numbers_->setText(result ? QStringLiteral("–") : tr("Not run yet."));
    vessels_->setText(QStringLiteral("–"));
    return;
  }
  const comparison::Difference& d = *result->difference;
  retractor_->setText(mm(d.at_retractor_mm));
  const auto& e = result->discretisation;
  QStringList beside;
  if (const QString sure = interval(); !sure.isEmpty()) beside << sure;
  if (e && e->difference && e->difference->at_retractor_mm)
    beside << tr("± %1 by the size of the cells").arg(mm(*e->difference->at_retractor_mm));
  retractorError_->setText(beside.join(QLatin1Char('\n')));
  verdict_->setText(verdictOf(pipeline::significanceOf(*result)));
  numbers_->setText(tr("mean %1, 95th percentile %2, largest %3").arg(mm(d.mean_mm), mm(d.p95_mm), mm(d.max_mm)));
  vessels_->setText(d.vessel_mm.empty()
                        ? tr("No vessel landmarks were found.")
                        : tr("%1 landmarks: mean %2, 95th percentile %3, largest %4; %5 of them at 5\u00a0mm or more")
                                  .arg(static_cast<qulonglong>(d.vessel_mm.size()))
                                  .arg(mm(d.vesselMean_mm), mm(d.vesselP95_mm), mm(d.vesselMax_mm))
                                  .arg(std::llround(d.vesselFractionBeyond * static_cast<double>(d.vessel_mm.size()))) +
                              ofVessels());
}

}  // namespace glisson::panels
