// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/outline_panel.h"

#include <QButtonGroup>
#include <QCheckBox>
#include <QHeaderView>
#include <QSettings>
#include <QSlider>
#include <QSpinBox>
#include <QTreeWidget>
#include <algorithm>
#include <cmath>
#include <limits>

#include "panels/form.h"
#include "panels/keys.h"
#include "session/session.h"

namespace glisson::panels {

using tools::Command;

namespace {

const QString moreSetting = QStringLiteral("segment/moreNumbers");

}  // namespace

OutlinePanel::OutlinePanel(session::Session& session, const Keys& keys, QWidget* parent)
    : SidePanel(parent), session_(session), keys_(keys) {
  QVBoxLayout* side = column();
  makeTools(side);
  makeReadout(side);
  makeWhatIsMeasured(side);
  makeScale(side);
  makeList(side);
  connect(&session_, &session::Session::statisticsChanged, this, &OutlinePanel::showStatistics);
  connect(&session_, &session::Session::contoursChanged, this, &OutlinePanel::showOutlines);
  connect(&session_, &session::Session::toolChanged, this, &OutlinePanel::showTool);
  connect(&session_, &session::Session::loaded, this, &OutlinePanel::showTool);  // with the settings of the case
  connect(&session_, &session::Session::statusChanged, this, &OutlinePanel::showActions);
  connect(&keys_, &Keys::changed, this, &OutlinePanel::showTool);
  showTool();
}

QPushButton* OutlinePanel::commandButton(const char* name, const QString& text, const QString& iconName,
                                         Command command) {
  QPushButton* made = button(name, text, iconName, keys_.tip(command));
  made->setAccessibleName(nameOf(command));
  connect(made, &QPushButton::clicked, this, [this, command] { emit commandWanted(command); });
  return made;
}

void OutlinePanel::makeTools(QVBoxLayout* side) {
  side->addWidget(labelled(tr("Outline the liver"), "heading"));
  stateText_ = labelled({}, "faint");
  stateText_->setObjectName(QStringLiteral("toolState"));
  stateText_->setMinimumHeight(66);
  stateText_->setAlignment(Qt::AlignTop);
  side->addWidget(stateText_);
  auto* row = new QHBoxLayout;
  undo_ = commandButton("undoButton", {}, QStringLiteral("undo"), Command::Undo);
  redo_ = commandButton("redoButton", {}, QStringLiteral("redo"), Command::Redo);
  delete_ = commandButton("deleteButton", {}, QStringLiteral("delete"), Command::Delete);
  accept_ = commandButton("acceptButton", tr("Accept"), QStringLiteral("accept"), Command::CloseOrAccept);
  accept_->setProperty("primary", true);
  for (QPushButton* b : {undo_, redo_, delete_}) row->addWidget(b);
  side->addWidget(accept_);
  side->addLayout(row);
}

void OutlinePanel::makeReadout(QVBoxLayout* side) {
  side->addSpacing(8);
  side->addWidget(section(tr("Stiffness under the outline")));
  readout_ = labelled({}, "number");
  readout_->setObjectName(QStringLiteral("liveMean"));
  side->addWidget(readout_);
  pooled_ = labelled({}, "faint");
  pooled_->setObjectName(QStringLiteral("liveReadout"));
  pooled_->setMinimumHeight(76);
  pooled_->setAlignment(Qt::AlignTop);
  side->addWidget(pooled_);
  reading_ = labelled({}, "faint");
  reading_->setObjectName(QStringLiteral("readingText"));
  reading_->setToolTip(tr(
      "Repeatability coefficient of the QIBA profile for liver MR elastography, 2022: a change by 19 % of the mean or "
      "more is a true one with 95 % confidence."));
  side->addWidget(reading_);
  more_ = button("moreNumbers", {}, {}, tr("Median, smallest and largest value, mean weighted by area"));
  more_->setProperty("flat", true);
  more_->setProperty("narrow", true);
  side->addWidget(more_, 0, Qt::AlignLeft);
  full_ = labelled({}, "faint");
  full_->setObjectName(QStringLiteral("fullReadout"));
  side->addWidget(full_);
  const auto unfold = [this](bool on) {
    more_->setText(on ? tr("Fewer numbers") : tr("More numbers"));
    full_->setVisible(on);
  };
  unfold(QSettings().value(moreSetting, false).toBool());
  connect(more_, &QPushButton::clicked, this, [this, unfold] {
    unfold(full_->isHidden());
    QSettings().setValue(moreSetting, !full_->isHidden());
  });
  cursor_ = labelled({}, "faint");
  cursor_->setObjectName(QStringLiteral("cursorReadout"));
  side->addWidget(cursor_);
}

void OutlinePanel::makeWhatIsMeasured(QVBoxLayout* side) {
  auto* row = new QHBoxLayout;
  inner_ = new QCheckBox(tr("Inner region"));
  inner_->setObjectName(QStringLiteral("innerRegion"));
  inner_->setToolTip(keys_.tip(Command::InnerRoi));
  erosion_ = new QSpinBox;
  erosion_->setObjectName(QStringLiteral("erosionPixels"));
  erosion_->setRange(0, 50);
  erosion_->setButtonSymbols(QAbstractSpinBox::NoButtons);  // wheel and arrow keys step it
  erosion_->setSuffix(tr(" px"));
  erosion_->setToolTip(tr("Pixels of the elastogram taken off the edge ([ and ])"));
  row->addWidget(inner_, 1);
  row->addWidget(erosion_);
  side->addLayout(row);
  withoutVessels_ = new QCheckBox(tr("Without vessels"));
  withoutVessels_->setObjectName(QStringLiteral("withoutVessels"));
  withoutVessels_->setToolTip(
      tr("Vessels found in the MRI are not measured. They are looked for once the outlines rest."));
  side->addWidget(withoutVessels_);
  connect(withoutVessels_, &QCheckBox::toggled, this, [this](bool on) {
    session::MeasureSettings settings = session_.measureSettings();
    settings.vessels = on;
    session_.setMeasureSettings(settings);
  });
  connect(inner_, &QCheckBox::toggled, this, [this](bool on) {
    session::MeasureSettings settings = session_.measureSettings();
    settings.innerRoi = on;
    session_.setMeasureSettings(settings);
  });
  connect(erosion_, &QSpinBox::valueChanged, this, [this](int px) {
    session::MeasureSettings settings = session_.measureSettings();
    settings.erosion_pixels = px;
    session_.setMeasureSettings(settings);
  });
}

void OutlinePanel::makeScale(QVBoxLayout* side) {
  side->addWidget(section(tr("Colour scale")));
  auto* scales = new QHBoxLayout;
  auto* group = new QButtonGroup(this);
  for (const double high : {8.0, 20.0}) {
    auto* scale =
        button(high < 10 ? "scale8" : "scale20", tr("0 – %1 kPa").arg(high), {}, keys_.tip(Command::StiffnessScale));
    scale->setCheckable(true);
    scale->setChecked(high < 10);
    group->addButton(scale);
    scales->addWidget(scale);
    connect(scale, &QPushButton::clicked, this, [this, high] { emit scaleWanted(high); });
    (high < 10 ? scale8_ : scale20_) = scale;
  }
  side->addLayout(scales);
  auto* laid = new QHBoxLayout;
  auto* name = labelled(tr("Over the MRI"), "faint");
  name->setWordWrap(false);
  fusion_ = new QSlider(Qt::Horizontal);
  fusion_->setObjectName(QStringLiteral("fusionSlider"));
  fusion_->setAccessibleName(tr("Stiffness over the MRI"));
  fusion_->setRange(0, 100);
  fusion_->setToolTip(keys_.tip(Command::Fuse));
  laid->addWidget(name);
  laid->addWidget(fusion_, 1);
  side->addLayout(laid);
  connect(fusion_, &QSlider::valueChanged, this, [this](int percent) { emit fusionWanted(percent / 100.0); });
}

void OutlinePanel::setFusion(double opacity) {
  const QSignalBlocker quiet(fusion_);
  fusion_->setValue(qRound(100.0 * opacity));
}

void OutlinePanel::makeList(QVBoxLayout* side) {
  side->addSpacing(8);
  side->addWidget(section(tr("Outlines")));
  outlines_ = new QTreeWidget;
  outlines_->setObjectName(QStringLiteral("outlineList"));
  outlines_->setHeaderLabels({tr("Slice"), tr("Vertices"), tr("State")});
  outlines_->setRootIsDecorated(false);
  outlines_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  outlines_->header()->setSectionResizeMode(QHeaderView::Stretch);
  side->addWidget(outlines_, 1);
  connect(outlines_, &QTreeWidget::itemClicked, this,
          [this](QTreeWidgetItem* item) { emit sliceWanted(item->data(0, Qt::UserRole).toInt()); });
  volume_ = labelled({}, "text");
  volume_->setObjectName(QStringLiteral("liverVolume"));
  volume_->setToolTip(
      tr("What counts: outlines that were accepted or interpolated, without what is left out, empty "
         "slices between them filled by shape"));
  side->addWidget(volume_);
  coverage_ = labelled({}, "faint");
  coverage_->setObjectName(QStringLiteral("outlineCoverage"));
  side->addWidget(coverage_);
  auto* fill = new QHBoxLayout;
  interpolate_ =
      commandButton("interpolateButton", tr("Interpolate"), QStringLiteral("interpolate"), Command::Interpolate);
  acceptAll_ = commandButton("acceptAllButton", tr("Accept all"), QStringLiteral("accept"), Command::AcceptAll);
  for (QPushButton* b : {interpolate_, acceptAll_}) {
    b->setProperty("narrow", true);
    fill->addWidget(b, 1);
  }
  side->addLayout(fill);
  import_ = button("importButton", tr("Import outlines…"), QStringLiteral("import"),
                   tr("RT Structure Set, contour file or mask (Ctrl+I)"));
  side->addWidget(import_);
  connect(import_, &QPushButton::clicked, this, &OutlinePanel::importWanted);
}

void OutlinePanel::setSlice(int slice) {
  slice_ = slice;
  outlines_->clearSelection();
  showOutlines();
}

void OutlinePanel::setCursorText(const QString& text) {
  cursor_->setText(text);
}

void OutlinePanel::setScale(double high_kPa) {
  (high_kPa < 10.0 ? scale8_ : scale20_)->setChecked(true);
}

void OutlinePanel::showOutlines() {
  outlines_->clear();
  if (!session_.images().mri) return;
  const image::Grid& grid = session_.images().mri->grid;
  struct Row {
    int slice;
    QString vertices, state;
    bool drawn;
  };
  std::vector<Row> rows;
  for (const roi::Polygon& p : session_.contours().polygons) {
    if (p.points_lps_mm.cols() == 0) continue;
    const QString state = p.exclude ? tr("left out") : stateOf(session_.contours(), p);
    rows.push_back({tools::sliceOf(p, grid), QString::number(p.points_lps_mm.cols()), state,
                    p.state == roi::PolygonState::Accepted});
  }
  const session::OutlineCoverage covered = session_.coverage();
  for (const int k : covered.empty) rows.push_back({k, QStringLiteral("–"), tr("empty"), false});
  for (const auto& [k, mark] : session_.contours().marks)
    rows.push_back(
        {k, QStringLiteral("–"), mark == commands::SliceMark::NoLiver ? tr("no liver") : tr("no wave"), true});
  std::stable_sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.slice > b.slice; });
  QTreeWidgetItem* here = nullptr;  // or the row nearest to the slice shown
  int off = std::numeric_limits<int>::max();
  for (const Row& r : rows) {
    auto* item = new QTreeWidgetItem(outlines_, {QString::number(r.slice + 1), r.vertices, r.state});
    item->setData(0, Qt::UserRole, r.slice);
    item->setToolTip(2, r.state);
    if (slice_ >= 0 && std::abs(r.slice - slice_) < off) here = item, off = std::abs(r.slice - slice_);
    if (r.slice == slice_) {
      QFont bold = item->font(0);
      bold.setBold(true);
      for (int c = 0; c < 3; ++c) item->setFont(c, bold);
    } else if (!r.drawn) {
      for (int c = 0; c < 3; ++c) item->setForeground(c, palette().color(QPalette::PlaceholderText));
    }
  }
  if (here) outlines_->scrollToItem(here, QAbstractItemView::PositionAtCenter);
  coverage_->setText(whatCounts());
  showActions();
}

void OutlinePanel::showActions() {
  const session::OutlineCoverage covered = session_.coverage();
  interpolate_->setEnabled(covered.drawn.size() > 1 && covered.empty.size() + covered.interpolated.size() > 0 &&
                           !session_.busy());
  acceptAll_->setEnabled(!covered.interpolated.empty());
}

// What the left button would do, where nothing is drawn or selected.
QString OutlinePanel::hintOf(tools::ToolMode mode) {
  switch (mode) {
    case tools::ToolMode::Sculpt: return tr("Drag to push the outline with the disc; [ and ] change its size.");
    case tools::ToolMode::Ellipse: return tr("Drag an ellipse from corner to corner; with Shift a circle.");
    case tools::ToolMode::Brush:
      return tr(
          "Paint on tissue: the disc keeps to what looks like where it was pressed, with Shift it takes all. [ and "
          "] change its size.");
    case tools::ToolMode::Eraser:
      return tr(
          "Erase parts of outlines: the disc keeps to what looks like where it was pressed, with Shift it takes "
          "all. [ and ] change its size.");
    case tools::ToolMode::Livewire:
      return tr("Click along a border: the line follows the edges of the image from click to click.");
    case tools::ToolMode::Spline: return tr("Click points on the border: a smooth closed curve runs through them.");
    case tools::ToolMode::Polygon:
    case tools::ToolMode::Freehand: break;
  }
  return tr("Click vertices on the MRI, or drag to draw freehand. Click an outline to edit it.");
}

void OutlinePanel::showTool() {
  const tools::ToolState state = session_.tool().state();
  const bool drawing = state == tools::ToolState::Drawing, editing = state == tools::ToolState::Editing;
  undo_->setEnabled(session_.canUndo());
  redo_->setEnabled(session_.canRedo());
  undo_->setToolTip(tr("Undo %1 (%2)").arg(session_.undoText(), keys_.text(tools::Command::Undo)));
  redo_->setToolTip(tr("Redo %1 (%2)").arg(session_.redoText(), keys_.text(tools::Command::Redo)));
  const session::OutlineCoverage covered = session_.coverage();
  accept_->setEnabled(drawing || editing || covered.drafts.contains(slice_) || covered.interpolated.contains(slice_));
  accept_->setText(drawing ? tr("Close") : tr("Accept"));
  delete_->setEnabled(session_.tool().selected().has_value());
  showActions();
  const QSignalBlocker quietInner(inner_), quietErosion(erosion_), quietVessels(withoutVessels_);
  withoutVessels_->setChecked(session_.measureSettings().vessels);
  inner_->setChecked(session_.measureSettings().innerRoi);
  erosion_->setValue(session_.measureSettings().erosion_pixels);
  switch (state) {
    case tools::ToolState::Idle: stateText_->setText(hintOf(session_.tool().mode())); break;
    case tools::ToolState::Drawing:
      stateText_->setText(
          tr("Close on the first vertex, with a right click, a double click or Enter. Backspace takes "
             "the last vertex back, Esc parks a draft."));
      break;
    case tools::ToolState::Editing:
      stateText_->setText(session_.tool().interpolated()
                              ? tr("Interpolated between drawn slices. Enter accepts it, correcting it accepts it too; "
                                   "an outline drawn "
                                   "on this slice replaces it.")
                              : tr("Drag vertices to adjust; Ctrl+click adds or deletes one. Enter accepts."));
      break;
    case tools::ToolState::Accepted:
      stateText_->setText(session_.tool().hasDisc()
                              ? hintOf(session_.tool().mode())
                              : tr("Accepted. It can still be edited; click beside it to draw the next."));
      break;
  }
}

}  // namespace glisson::panels
