// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/segment_page.h"

#include <QButtonGroup>
#include <QComboBox>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QSettings>
#include <QSpinBox>
#include <algorithm>
#include <cmath>

#include "panels/form.h"
#include "panels/grey_window.h"
#include "panels/image_layers.h"
#include "panels/keys.h"
#include "panels/outline_panel.h"
#include "panels/plane_views.h"
#include "session/session.h"
#include "views/slice_view.h"

namespace glisson::panels {

using tools::Command;
using views::SliceView;

SegmentPage::SegmentPage(session::Session& session, Keys& keys, QWidget* parent)
    : QWidget(parent),
      session_(session),
      keys_(keys),
      mri_(new SliceView),
      mre_(new SliceView),
      layers_(new ImageLayers(mre_)),
      panel_(new OutlinePanel(session, keys)),
      planes_(new PlaneViews) {
  mri_->setObjectName(QStringLiteral("mriView"));
  mre_->setObjectName(QStringLiteral("mreView"));
  mri_->setHint(tr("Open images first (step Load)."));
  mre_->setHint(tr("No elastogram is open."));
  mri_->setAccessibleName(tr("MRI slice"));
  mre_->setAccessibleName(tr("Elastography slice"));
  makeViews();
  mri_->setContours(&session_.contours(), &session_.tool());
  mre_->setContours(&session_.contours(), nullptr);
  mri_->setMeasurements(&measure_);
  mre_->setMeasurements(&measure_);
  for (SliceView* view : {mri_, mre_}) view->setSecondReader(&session_.secondReader());
  for (SliceView* view : {mri_, mre_, planes_->both()[0], planes_->both()[1]}) {
    connect(view, &SliceView::keyDown, this, &SegmentPage::keyDown);
    connect(view, &SliceView::keyUp, this, &SegmentPage::keyUp);
  }
  connectTool();
  connectCursor();
  connectPlanes();
  connect(panel_, &OutlinePanel::commandWanted, this, &SegmentPage::run);
  connect(panel_, &OutlinePanel::sliceWanted, mri_, &SliceView::setSlice);
  connect(panel_, &OutlinePanel::importWanted, this, &SegmentPage::importWanted);
  connect(panel_, &OutlinePanel::scaleWanted, layers_, &ImageLayers::setStiffnessScale);
  connect(&session_, &session::Session::loaded, this, &SegmentPage::showImages);
  connect(&session_, &session::Session::toolChanged, this, &SegmentPage::showTool);
  connect(&session_, &session::Session::contoursChanged, this, &SegmentPage::showSlice);
  connect(&session_, &session::Session::statisticsChanged, this, [this] { mre_->setInner(session_.innerMask()); });
  connect(&session_, &session::Session::pointWanted, mri_, &SliceView::showPoint);
  showTool();
}

namespace {

/// One row would make the window wider than a small screen.
QLayout* inTwoRows(const QList<QAbstractButton*>& buttons) {
  auto* grid = new QGridLayout;
  grid->setSpacing(2);
  const auto inRow = static_cast<int>((buttons.size() + 1) / 2);
  for (int i = 0; i < static_cast<int>(buttons.size()); ++i) grid->addWidget(buttons[i], i / inRow, i % inRow);
  return grid;
}

}  // namespace

void SegmentPage::makeStrip(QHBoxLayout* strip) {
  auto* group = new QButtonGroup(this);
  const auto tool = [&](const char* name, const char* iconName, Command command) {
    QPushButton* b = button(name, {}, QString::fromLatin1(iconName), keys_.tip(command));
    b->setAccessibleName(nameOf(command));
    b->setProperty("flat", true);
    b->setCheckable(true);
    b->setMinimumHeight(28);
    connect(b, &QPushButton::clicked, this, [this, command] { run(command); });
    return b;
  };
  // In the order of ToolMode.
  modes_ = {tool("polygonTool", "polygon", Command::Polygon),    tool("freehandTool", "freehand", Command::Freehand),
            tool("sculptTool", "sculpt", Command::Sculpt),       tool("ellipseTool", "ellipse", Command::Ellipse),
            tool("brushTool", "brush", Command::Brush),          tool("eraserTool", "eraser", Command::Eraser),
            tool("livewireTool", "livewire", Command::Livewire), tool("splineTool", "spline", Command::Spline)};
  ruler_ = tool("measureTool", "measure", Command::Measure);
  window_ = tool("windowTool", "window", Command::WindowLevel);
  for (QPushButton* b : modes_) group->addButton(b);
  for (QPushButton* b : {ruler_, window_}) group->addButton(b);
  strip->addLayout(inTwoRows(group->buttons()));
  modes_.front()->setChecked(true);
  spacing_ = new QSpinBox;
  spacing_->setObjectName(QStringLiteral("freehandSpacing"));
  spacing_->setRange(1, 100);
  spacing_->setButtonSymbols(QAbstractSpinBox::NoButtons);  // wheel and arrow keys step it
  spacing_->setSuffix(tr(" px"));
  spacing_->setFixedWidth(58);
  spacing_->setToolTip(tr("Freehand: a vertex every so many pixels of the screen"));
  spacing_->setAccessibleName(tr("Spacing of freehand vertices"));
  const QString setting = QStringLiteral("segment/freehandSpacing");
  spacing_->setValue(QSettings().value(setting, qRound(tools::reach::freehand_px)).toInt());
  session_.tool().setFreehandSpacing(spacing_->value());
  strip->addWidget(spacing_);
  connect(spacing_, &QSpinBox::valueChanged, this, [this, setting](int px) {
    session_.tool().setFreehandSpacing(px);
    QSettings().setValue(setting, px);
  });
  strip->addStretch();
  auto* presets = new QComboBox;
  presets->setObjectName(QStringLiteral("windowPreset"));
  presets->setToolTip(tr("Window and level of the MRI (0 to 5)"));
  presets->addItems({tr("Auto"), tr("Soft"), tr("Liver"), tr("Vessels"), tr("Bright"), tr("Dark")});
  presets->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  presets->setMinimumContentsLength(4);
  strip->addWidget(presets);
  connect(presets, &QComboBox::activated, this, &SegmentPage::preset);
  link_ = tool("linkViews", "link", Command::LinkViews);
  link_->setChecked(true);
  planesButton_ = tool("planesButton", "planes", Command::Planes);
  auto* propose = tool("proposeOutline", "propose", Command::Propose);
  propose->setCheckable(false);
  auto* help = tool("helpButton", "help", Command::Help);
  help->setCheckable(false);
  for (QPushButton* b : {link_, planesButton_, propose, help}) strip->addWidget(b);
}

void SegmentPage::connectTool() {
  const auto pass = [this](auto signal, auto gesture, auto ruler) {
    connect(mri_, signal, this, [this, gesture, ruler](const tools::Pointer& at) {
      if (hand_ == Hand::Measure) {
        if (ruler) (measure_.*ruler)(at.px, mri_->plane());
        mri_->update();
        mre_->update();
        return;
      }
      session_.apply((session_.tool().*gesture)(at, mri_->plane()));
    });
  };
  using Ruler = void (tools::MeasureTool::*)(const Eigen::Vector2d&, const tools::SlicePlane&);
  pass(&SliceView::toolPressed, &tools::PolygonTool::press, &tools::MeasureTool::press);
  pass(&SliceView::toolMoved, &tools::PolygonTool::move, &tools::MeasureTool::move);
  pass(&SliceView::toolReleased, &tools::PolygonTool::release, &tools::MeasureTool::release);
  pass(&SliceView::toolDoubleClicked, &tools::PolygonTool::doubleClick, static_cast<Ruler>(nullptr));
  connect(mri_, &SliceView::toolDoubleClicked, this, [this] {
    if (const auto polygon = session_.tool().takePropertiesWish()) showProperties(*polygon);
  });
  connect(mri_, &SliceView::toolRightClicked, this, [this](const tools::Pointer& at) {
    const bool drawing = session_.tool().state() == tools::ToolState::Drawing;
    session_.apply(session_.tool().rightClick(at, mri_->plane()));
    if (!drawing) showMenu(mri_->mapToGlobal(QPointF(at.px.x(), at.px.y()).toPoint()));
  });
  connect(mri_, &SliceView::sliceAboutToChange, this,
          [this] { session_.apply(session_.tool().leaveSlice(mri_->plane())); });
}

void SegmentPage::connectCursor() {
  const auto middleOf = [](const SliceView* view) {
    const tools::SlicePlane plane = view->plane();
    return plane.grid.indexToLps({plane.grid.size.x() / 2.0, plane.grid.size.y() / 2.0, 1.0 * plane.slice});
  };
  // One view leads, the other follows; what follows does not lead in turn.
  connect(mri_, &SliceView::sliceChanged, this, [this, middleOf] {
    if (linked_ && !following_) {
      following_ = true;
      mre_->showPoint(middleOf(mri_));
      following_ = false;
    }
    session_.setShownPlane(mri_->plane());
    keepCrosshairOnSlice();
    showSlice();
  });
  connect(mre_, &SliceView::sliceChanged, this, [this, middleOf] {
    if (!linked_ || following_ || !mre_->underMouse()) return;
    following_ = true;
    mri_->showPoint(middleOf(mre_));
    following_ = false;
  });
  connect(mri_, &SliceView::placeChanged, this, [this] { linkPlace(mri_, mre_); });
  connect(mre_, &SliceView::placeChanged, this, [this] { linkPlace(mre_, mri_); });
  for (SliceView* view : {mri_, mre_}) {
    // What is fitted or has another size is settled by the MRI.
    connect(view, &SliceView::resettled, this, [this] { linkPlace(mri_, mre_); });
    connect(view, &SliceView::cursorMoved, this, &SegmentPage::showCursor);
    connect(view, &SliceView::cursorLeft, this, [this] { showCursor(std::nullopt); });
    connect(view, &SliceView::windowRefused, this, [this] {
      emit session_.message(tr("The stiffness scale is 0–8 or 0–20 kPa, so that a colour always means the same: %1.")
                                .arg(keys_.tip(Command::StiffnessScale)));
    });
  }
}

void SegmentPage::showCursor(const std::optional<Eigen::Vector3d>& p_lps) {
  cursor_ = p_lps;
  // With all planes open the crosshair stays where the mouse has left.
  for (SliceView* view : {mri_, mre_}) view->setCursor(p_lps || planes_->isHidden() ? p_lps : crosshair_);
  planes_->setCursor(p_lps);
  QString text;
  if (p_lps && session_.images().stiffness) {
    const image::ScalarVolume& map = session_.images().stiffness->values_kPa;
    const Eigen::Vector3i voxel = map.grid.lpsToIndex(*p_lps).array().round().matrix().cast<int>();
    if (map.grid.contains(voxel))
      text = tr("Under the cursor: %1 kPa (µ)").arg(static_cast<double>(map.at(voxel)), 0, 'f', 2);
  }
  panel_->setCursorText(text);
}

void SegmentPage::linkPlace(SliceView* from, SliceView* to) {
  if (!linked_ || following_ || !from->hasVolume() || !to->hasVolume()) return;
  following_ = true;
  to->showPlace(from->centre_lps(), from->zoom_px_mm());
  following_ = false;
}

void SegmentPage::showImages() {
  const session::OpenImages& images = session_.images();
  measure_.clear();
  if (!images.mri) {
    mri_->clear();
    mre_->clear();
    planes_->setImage(nullptr, 0.0, 1.0);
    crosshair_.reset();
    panel_->setSlice(-1);
    return;
  }
  views::ShownVolume mri;
  mri.values = images.mri;
  std::tie(mri.low, mri.high) = windowOf(*images.mri);
  mri.title = tr("MRI");
  mri.sopInstanceUids = session_.scan().series[static_cast<std::size_t>(images.mriSeries)].sopInstanceUids;
  const bool other = !mri_->hasVolume() || !mri_->volume().values->grid.sameGeometry(images.mri->grid);
  mri_->setVolume(mri);
  layers_->setImages(images);
  planes_->setImage(images.mri, mri.low, mri.high);
  showFusion();
  if (other) showFirstSlice();
  setCrosshair(mri_->centre_lps());
  linkPlace(mri_, mre_);
  session_.setShownPlane(mri_->plane());
  showSlice();
}

// The slice nearest to the middle that lies at the height of a slice of the elastogram: what is drawn there first is
// seen on the stiffness map as it is.
void SegmentPage::showFirstSlice() {
  if (!session_.images().stiffness) return;
  const image::Grid& map = session_.images().stiffness->values_kPa.grid;
  const Eigen::Vector3d middle = map.lpsToIndex(mri_->plane().toLps(mri_->plane().offset_px));
  const int k = std::clamp(static_cast<int>(std::lround(middle.z())), 0, map.size.z() - 1);
  mri_->showPoint(map.indexToLps({0.5 * map.size.x(), 0.5 * map.size.y(), 1.0 * k}));
}

void SegmentPage::showSlice() {
  panel_->setSlice(mri_->hasVolume() ? mri_->slice() : -1);
  const auto mark = session_.markOf(mri_->slice());
  mri_->setNote(!mark ? QString() : *mark == commands::SliceMark::NoLiver ? tr("no liver") : tr("no reliable wave"));
}

void SegmentPage::showTool() {
  const tools::ToolMode mode = session_.tool().mode();
  QPushButton* active = hand_ == Hand::Measure  ? ruler_
                        : hand_ == Hand::Window ? window_
                                                : modes_[static_cast<std::size_t>(mode)];
  active->setChecked(true);
  spacing_->setVisible(hand_ == Hand::Outline && mode == tools::ToolMode::Freehand);
  mri_->update();
  mre_->update();
}

}  // namespace glisson::panels
