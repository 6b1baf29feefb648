// SPDX-License-Identifier: GPL-3.0-or-later

// What keys, buttons and menus of the Segment page do.
#include <QKeyEvent>
#include <cmath>

#include "panels/grey_window.h"
#include "panels/image_layers.h"
#include "panels/keys.h"
#include "panels/outline_panel.h"
#include "panels/plane_views.h"
#include "panels/segment_page.h"
#include "session/session.h"
#include "views/slice_view.h"

namespace glisson::panels {

using tools::Command;
using tools::ToolKey;
using tools::ToolMode;

void SegmentPage::keyDown(QKeyEvent* event) {
  const std::optional<Command> command = keys_.commandFor(*event);
  if (!command) return;
  event->accept();
  if (*command == Command::HideOverlays) {
    for (views::SliceView* view : {mri_, mre_, planes_->both()[0], planes_->both()[1]}) view->setOverlaysHidden(true);
  } else {
    run(*command);
  }
}

void SegmentPage::keyUp(QKeyEvent* event) {
  if (keys_.commandFor(*event) != Command::HideOverlays) return;
  for (views::SliceView* view : {mri_, mre_, planes_->both()[0], planes_->both()[1]}) view->setOverlaysHidden(false);
}

void SegmentPage::run(Command command) {
  if (command == Command::Help) {
    emit helpWanted();
    return;
  }
  if (!mri_->hasVolume()) return;
  if (!runOutline(command)) runView(command);
  session_.toolMoved();
  showTool();
}

bool SegmentPage::runOutline(Command command) {
  tools::PolygonTool& tool = session_.tool();
  const auto key = [&](ToolKey k) { session_.apply(tool.key(k, mri_->plane())); };
  switch (command) {
    case Command::Polygon: take(Hand::Outline, ToolMode::Polygon); return true;
    case Command::Freehand: take(Hand::Outline, ToolMode::Freehand); return true;
    case Command::Sculpt: take(Hand::Outline, ToolMode::Sculpt); return true;
    case Command::Ellipse: take(Hand::Outline, ToolMode::Ellipse); return true;
    case Command::Brush: take(Hand::Outline, ToolMode::Brush); return true;
    case Command::Eraser: take(Hand::Outline, ToolMode::Eraser); return true;
    case Command::Livewire: take(Hand::Outline, ToolMode::Livewire); return true;
    case Command::Spline: take(Hand::Outline, ToolMode::Spline); return true;
    case Command::Unite: session_.apply(tool.combine(roi::SetOperation::Union, mri_->plane())); return true;
    case Command::Subtract: session_.apply(tool.combine(roi::SetOperation::Difference, mri_->plane())); return true;
    case Command::Intersect: session_.apply(tool.combine(roi::SetOperation::Intersection, mri_->plane())); return true;
    case Command::CloseOrAccept:
      if (chooseWaiting()) key(ToolKey::Enter);
      return true;
    case Command::CloseAndAccept:
      if (chooseWaiting()) key(ToolKey::CtrlEnter);
      return true;
    case Command::LastVertex: hand_ == Hand::Measure ? measure_.removeLast() : key(ToolKey::Backspace); return true;
    case Command::Delete: hand_ == Hand::Measure ? measure_.removeLast() : key(ToolKey::Delete); return true;
    case Command::Park: hand_ == Hand::Measure ? measure_.cancel() : key(ToolKey::Escape); return true;
    case Command::Split: session_.apply(tool.split(mri_->plane())); return true;
    case Command::Trim: session_.apply(tool.trim(mri_->plane())); return true;
    case Command::Undo: session_.undo(); return true;
    case Command::Redo: session_.redo(); return true;
    case Command::SelectAll: tool.selectAll(mri_->plane()); return true;
    case Command::Deselect: tool.deselect(); return true;
    case Command::Copy: session_.copyOutlines(); return true;
    case Command::Paste: session_.pasteOutlines(); return true;
    case Command::PasteBetween: session_.pasteBetween(); return true;
    case Command::Include:
    case Command::Exclude: session_.apply(tool.setKind(command == Command::Exclude)); return true;
    case Command::Interpolate: session_.interpolateOutlines(); return true;
    case Command::AcceptAll: session_.acceptInterpolated(); return true;
    case Command::Propose: session_.propose(cursor_.value_or(mri_->centre_lps())); return true;
    case Command::CompareReaders:
      session_.secondReader().polygons.empty() ? emit secondReaderWanted() : session_.compareReaders();
      return true;
    default: return false;
  }
}

// Enter accepts what waits on the slice shown, without its having to be clicked first. False: nothing waits there.
bool SegmentPage::chooseWaiting() {
  tools::PolygonTool& tool = session_.tool();
  if (tool.state() == tools::ToolState::Drawing || tool.selected()) return true;
  const auto& polygons = session_.contours().polygons;
  const tools::SlicePlane plane = mri_->plane();
  for (const roi::PolygonState state : {roi::PolygonState::Draft, roi::PolygonState::Interpolated})
    for (std::size_t p = 0; p < polygons.size(); ++p) {
      if (polygons[p].state != state || !plane.holds(polygons[p])) continue;
      tool.selectPolygon(p);
      return true;
    }
  emit session_.message(tr("Nothing on this slice waits to be accepted."));
  return false;
}

bool SegmentPage::runView(Command command) {
  switch (command) {
    case Command::Measure: take(Hand::Measure, session_.tool().mode()); return true;
    case Command::WindowLevel: take(Hand::Window, session_.tool().mode()); return true;
    case Command::NudgeLeft:
    case Command::NudgeRight: nudge({command == Command::NudgeLeft ? -0.1 : 0.1, 0.0}, 0); return true;
    case Command::NudgeUp:
    case Command::NudgeDown:
      nudge({0.0, command == Command::NudgeUp ? -0.1 : 0.1}, command == Command::NudgeUp ? 1 : -1);
      return true;
    case Command::NudgeLeftFar:
    case Command::NudgeRightFar: nudge({command == Command::NudgeLeftFar ? -1.0 : 1.0, 0.0}, 0); return true;
    case Command::NudgeUpFar:
    case Command::NudgeDownFar: nudge({0.0, command == Command::NudgeUpFar ? -1.0 : 1.0}, 0); return true;
    case Command::CrosshairLeft:
    case Command::CrosshairRight: moveCrosshair({command == Command::CrosshairLeft ? -1.0 : 1.0, 0.0}); return true;
    case Command::CrosshairUp:
    case Command::CrosshairDown: moveCrosshair({0.0, command == Command::CrosshairUp ? -1.0 : 1.0}); return true;
    case Command::CrosshairLeftFar:
    case Command::CrosshairRightFar:
      moveCrosshair({command == Command::CrosshairLeftFar ? -10.0 : 10.0, 0.0});
      return true;
    case Command::CrosshairUpFar:
    case Command::CrosshairDownFar:
      moveCrosshair({0.0, command == Command::CrosshairUpFar ? -10.0 : 10.0});
      return true;
    case Command::ClickHere: clickAtCrosshair(); return true;
    case Command::FirstSlice: mri_->setSlice(0); return true;
    case Command::LastSlice: mri_->setSlice(mri_->sliceCount() - 1); return true;
    case Command::SliceUp:
    case Command::SliceDown: mri_->setSlice(mri_->slice() + (command == Command::SliceUp ? 1 : -1)); return true;
    case Command::NextPending:
      if (const auto next = session_.nextPending(mri_->slice()))
        mri_->setSlice(*next);
      else
        emit session_.message(tr("Every slice is outlined or marked."));
      return true;
    case Command::MarkNoLiver:
    case Command::MarkNoWave:
      session_.toggleMark(command == Command::MarkNoLiver ? commands::SliceMark::NoLiver : commands::SliceMark::NoWave);
      return true;
    case Command::InnerRoi: inner(0); return true;
    case Command::InnerLess:
    case Command::InnerMore: inner(command == Command::InnerMore ? 1 : -1); return true;
    case Command::AutoWindow: preset(0); return true;
    case Command::Preset1:
    case Command::Preset2:
    case Command::Preset3:
    case Command::Preset4:
    case Command::Preset5: preset(1 + static_cast<int>(command) - static_cast<int>(Command::Preset1)); return true;
    case Command::LinkViews:
      linked_ = !linked_;
      linkPlace(mri_, mre_);
      emit session_.message(linked_ ? tr("The views move together.") : tr("The views move on their own."));
      return true;
    case Command::StiffnessScale: {
      const double high = layers_->stiffnessScale() < 10.0 ? 20.0 : 8.0;
      layers_->setStiffnessScale(high);
      panel_->setScale(high);
      showFusion();
      return true;
    }
    case Command::PlayWave: layers_->togglePlay(); return true;
    case Command::Planes: showPlanes(!alone_ && planes_->isHidden()); return true;
    case Command::FillWindow: fillWith(alone_ ? nullptr : viewUnderMouse()); return true;
    case Command::Fuse: setFusion(fusion_ > 0.0 ? 0.0 : lastFusion_); return true;
    default: return false;
  }
}

void SegmentPage::take(Hand hand, ToolMode mode) {
  hand_ = hand;
  measure_.cancel();
  mri_->setLeftDragWindows(hand == Hand::Window);
  for (views::SliceView* view : {mre_, planes_->both()[0], planes_->both()[1]})
    view->setLeftDragWindows(hand == Hand::Window);
  // Another tool parks an unfinished outline.
  session_.apply(hand == Hand::Outline ? session_.tool().setMode(mode, mri_->plane())
                                       : session_.tool().leaveSlice(mri_->plane()));
}

void SegmentPage::nudge(const Eigen::Vector2d& pixels, int slices) {
  const tools::Acts acts = session_.tool().nudge(pixels, mri_->plane());
  if (!acts.empty())
    session_.apply(acts);
  else if (slices != 0)
    mri_->setSlice(mri_->slice() + slices);
}

tools::Pointer SegmentPage::atCrosshair() const {
  tools::Pointer at;
  at.px = mri_->plane().toPixel(cursor_.value_or(mri_->centre_lps()));
  return at;
}

// In pixels of the image, as it is seen: an outline can be drawn without a mouse.
void SegmentPage::moveCrosshair(const Eigen::Vector2d& pixels) {
  const tools::SlicePlane plane = mri_->plane();
  Eigen::Vector3d index = plane.grid.lpsToIndex(cursor_.value_or(mri_->centre_lps()));
  index.head<2>() += (pixels.array() * plane.scale_px_mm.array().sign()).matrix();
  const Eigen::Vector2d last = (plane.grid.size.head<2>().array() - 1).cast<double>().matrix();
  index.head<2>() = index.head<2>().cwiseMax(0.0).cwiseMin(last);
  index.z() = plane.slice;
  const Eigen::Vector3d p_lps = plane.grid.indexToLps(index);
  setCrosshair(p_lps);
  showCursor(p_lps);
  mri_->setCursorByKeys();
  const Eigen::Vector2d px = plane.toPixel(p_lps);
  if (!mri_->rect().contains(QPointF(px.x(), px.y()).toPoint())) {
    mri_->showPlace(p_lps, mri_->zoom_px_mm());
    linkPlace(mri_, mre_);
  }
  if (hand_ == Hand::Measure)
    measure_.move(atCrosshair().px, mri_->plane());
  else
    session_.apply(session_.tool().move(atCrosshair(), mri_->plane()));
}

void SegmentPage::clickAtCrosshair() {
  moveCrosshair(Eigen::Vector2d::Zero());
  const tools::Pointer at = atCrosshair();
  const tools::SlicePlane plane = mri_->plane();
  if (hand_ == Hand::Measure) {
    measure_.press(at.px, plane);
    measure_.release(at.px, plane);
    return;
  }
  tools::PolygonTool& tool = session_.tool();
  session_.apply(tool.press(at, plane));
  session_.apply(tool.move(at, plane));
  session_.apply(tool.release(at, plane));
}

void SegmentPage::inner(int change) {
  session::MeasureSettings settings = session_.measureSettings();
  if (change == 0) {
    settings.innerRoi = !settings.innerRoi;
  } else if (session_.tool().hasDisc() && hand_ == Hand::Outline) {
    session_.tool().setBrushRadius(session_.tool().brushRadius() * (change > 0 ? 1.25 : 0.8));
    return;
  } else {
    settings.erosion_pixels += change;
  }
  session_.setMeasureSettings(settings);
}

void SegmentPage::preset(int number) {
  if (!mri_->hasVolume()) return;
  const auto whole = windowOf(*mri_->volume().values);
  const auto [low, high] = number == 0 ? whole : presetOf(number - 1, whole);
  mri_->setWindow(low, high);
  planes_->setWindow(low, high);
}

}  // namespace glisson::panels
