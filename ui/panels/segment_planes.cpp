// SPDX-License-Identifier: GPL-3.0-or-later

// Where the views of the Segment page lie: two beside each other, the two other planes below them, or one alone; the
// crosshair that links them, and the map over the MRI.
#include <QGuiApplication>
#include <QHBoxLayout>
#include <QPushButton>
#include <QSplitter>
#include <algorithm>
#include <cmath>

#include "panels/image_layers.h"
#include "panels/outline_panel.h"
#include "panels/plane_views.h"
#include "panels/segment_page.h"
#include "session/session.h"
#include "views/slice_view.h"

namespace glisson::panels {

using views::SliceView;

void SegmentPage::makeViews() {
  const auto column = [](QWidget* above, SliceView* view) {
    auto* both = new QWidget;
    auto* layout = new QVBoxLayout(both);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(0);
    layout->addWidget(above);
    layout->addWidget(view, 1);
    return both;
  };
  auto* strip = new QWidget;
  auto* row = new QHBoxLayout(strip);
  row->setContentsMargins(6, 4, 6, 4);
  row->setSpacing(2);
  makeStrip(row);
  constexpr int twoRows_px = 64;
  strip->setFixedHeight(twoRows_px);
  layers_->setFixedHeight(twoRows_px);
  mriColumn_ = column(strip, mri_);
  mreColumn_ = column(layers_, mre_);
  const auto splitter = [](Qt::Orientation orientation, QWidget* first, QWidget* second) {
    auto* made = new QSplitter(orientation);
    made->addWidget(first);
    made->addWidget(second);
    made->setChildrenCollapsible(false);
    made->setHandleWidth(3);
    made->setSizes({1000, 1000});
    return made;
  };
  upper_ = splitter(Qt::Horizontal, mriColumn_, mreColumn_);
  all_ = splitter(Qt::Vertical, upper_, planes_);
  planes_->hide();
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(0);
  layout->addWidget(all_, 1);
  layout->addWidget(panel_);
}

void SegmentPage::connectPlanes() {
  connect(planes_, &PlaneViews::crosshairMoved, this, &SegmentPage::setCrosshair);
  for (SliceView* view : {mre_, planes_->both()[0], planes_->both()[1]})
    connect(view, &SliceView::toolDoubleClicked, this, [this, view] { fillWith(alone_ ? nullptr : view); });
  for (SliceView* view : planes_->both()) {
    connect(view, &SliceView::cursorMoved, this, &SegmentPage::showCursor);
    connect(view, &SliceView::cursorLeft, this, [this] { showCursor(std::nullopt); });
  }
  // What is drawn is looked at from the other sides: the planes go through each vertex, and with Shift after the mouse.
  connect(mri_, &SliceView::toolPressed, this,
          [this](const tools::Pointer& at) { setCrosshair(mri_->plane().toLps(at.px)); });
  for (SliceView* view : {mri_, mre_})
    connect(view, &SliceView::cursorMoved, this, [this](const Eigen::Vector3d& p_lps) {
      if (QGuiApplication::keyboardModifiers().testFlag(Qt::ShiftModifier)) setCrosshair(p_lps);
    });
  connect(mri_, &SliceView::windowChanged, planes_, &PlaneViews::setWindow);
  connect(&session_, &session::Session::statisticsChanged, this,
          [this] { planes_->setRegion(session_.statistics().region); });
  connect(panel_, &OutlinePanel::scaleWanted, this, &SegmentPage::showFusion);
  connect(panel_, &OutlinePanel::fusionWanted, this, &SegmentPage::setFusion);
}

void SegmentPage::setCrosshair(const Eigen::Vector3d& p_lps) {
  if (!mri_->hasVolume()) return;
  crosshair_ = p_lps;
  mri_->showPoint(p_lps);
  planes_->setCrosshair(p_lps);
  if (planes_->isHidden()) return;
  for (SliceView* view : {mri_, mre_}) view->setCursor(p_lps);
}

// The slice was changed in the view that is drawn on: the crosshair comes along.
void SegmentPage::keepCrosshairOnSlice() {
  if (!crosshair_ || !mri_->hasVolume()) return;
  const image::Grid& grid = mri_->volume().values->grid;
  Eigen::Vector3d index = grid.lpsToIndex(*crosshair_);
  if (std::lround(index.z()) == mri_->slice()) return;
  index.z() = mri_->slice();
  crosshair_ = grid.indexToLps(index);
  planes_->setCrosshair(*crosshair_);
}

void SegmentPage::showPlanes(bool on) {
  if (alone_) fillWith(nullptr);
  planes_->setVisible(on);
  planesButton_->setChecked(on);
  if (on && crosshair_) planes_->setCrosshair(*crosshair_);
}

void SegmentPage::fillWith(SliceView* view) {
  const bool planes = planesButton_->isChecked();
  alone_ = view;
  const bool inPlanes = view && view != mri_ && view != mre_;
  upper_->setVisible(!inPlanes);
  mriColumn_->setVisible(!view || view == mri_);
  mreColumn_->setVisible(!view || view == mre_);
  planes_->setVisible(inPlanes || (!view && planes));
  for (SliceView* plane : planes_->both()) plane->setVisible(!inPlanes || plane == view);
  panel_->setVisible(!view);
  if (view) view->setFocus();
}

SliceView* SegmentPage::viewUnderMouse() const {
  for (SliceView* view : {mri_, mre_, planes_->both()[0], planes_->both()[1]})
    if (view->isVisible() && (view->underMouse() || view->hasFocus())) return view;
  return mri_;
}

void SegmentPage::setFusion(double opacity) {
  fusion_ = std::clamp(opacity, 0.0, 1.0);
  if (fusion_ > 0.0) lastFusion_ = fusion_;
  panel_->setFusion(fusion_);
  showFusion();
}

void SegmentPage::showFusion() {
  views::Fusion fusion;
  const auto& map = session_.images().stiffness;
  if (map) fusion.values = std::shared_ptr<const image::ScalarVolume>(map, &map->values_kPa);
  fusion.high_kPa = layers_->stiffnessScale();
  fusion.opacity = fusion_;
  mri_->setFusion(fusion);
  planes_->setFusion(fusion);
}

}  // namespace glisson::panels
