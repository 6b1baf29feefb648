// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/slice_view.h"

#include <QKeyEvent>
#include <QMouseEvent>
#include <QWheelEvent>
#include <algorithm>
#include <cmath>

#include "tools/outline.h"

namespace glisson::views {

namespace {

tools::Pointer pointerOf(const QPointF& at, Qt::KeyboardModifiers modifiers, bool touch = false) {
  tools::Pointer pointer;
  pointer.px = {at.x(), at.y()};
  pointer.modifiers.shift = modifiers.testFlag(Qt::ShiftModifier);
  pointer.modifiers.ctrl = modifiers.testFlag(Qt::ControlModifier);
  pointer.touch = touch;
  return pointer;
}

tools::Pointer pointerOf(const QMouseEvent& event) {
  const bool touch = event.deviceType() == QInputDevice::DeviceType::TouchScreen;
  return pointerOf(event.position(), event.modifiers(), touch);
}

int dominantAxis(const Eigen::Vector3d& direction) {
  Eigen::Index axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  return static_cast<int>(axis);
}

}  // namespace

SliceView::SliceView(QWidget* parent) : QWidget(parent) {
  setMouseTracking(true);
  setFocusPolicy(Qt::StrongFocus);
  setMinimumSize(220, 220);
  setCursor(std::nullopt);
  QWidget::setCursor(Qt::CrossCursor);
}

void SliceView::setVolume(ShownVolume volume) {
  const bool sameGrid = volume.values && volume_.values && volume.values->grid.sameGeometry(volume_.values->grid);
  volume_ = std::move(volume);
  if (!sameGrid) {
    slice_ = sliceCount() / 2;
    fit();
    cutRegion();
  }
  stale_ = true;
  update();
  if (hasVolume()) emit sliceChanged(slice_);
}

void SliceView::setContours(const roi::ContourStack* contours, const tools::PolygonTool* tool) {
  contours_ = contours;
  tool_ = tool;
  update();
}

void SliceView::setSlice(int slice) {
  if (!hasVolume()) return;
  const int wanted = std::clamp(slice, 0, sliceCount() - 1);
  if (wanted == slice_) return;
  emit sliceAboutToChange();
  slice_ = wanted;
  stale_ = true;
  cutRegion();
  update();
  emit sliceChanged(slice_);
}

void SliceView::showPoint(const Eigen::Vector3d& p_lps) {
  if (hasVolume()) setSlice(static_cast<int>(std::lround(volume_.values->grid.lpsToIndex(p_lps).z())));
}

void SliceView::setCursor(std::optional<Eigen::Vector3d> p_lps) {
  cursor_ = p_lps;
  update();
}

void SliceView::setWindow(double low, double high) {
  if (!(high > low)) return;
  volume_.low = low;
  volume_.high = high;
  stale_ = true;
  update();
}

void SliceView::setHint(const QString& hint) {
  hint_ = hint;
  update();
}

QRectF SliceView::imageArea() const {
  const double bar = volume_.stiffness ? 64.0 : 0.0;
  return {8.0, 8.0, std::max(width() - 16.0 - bar, 10.0), std::max(height() - 16.0, 10.0)};
}

// Screen right is the patient's left in axial and coronal slices and posterior in sagittal ones; down is posterior or
// inferior.
Eigen::Vector2d SliceView::axisSigns() const {
  if (!hasVolume()) return Eigen::Vector2d::Ones();
  const Eigen::Matrix3d& direction = volume_.values->grid.direction;
  const int axisI = dominantAxis(direction.col(0)), axisJ = dominantAxis(direction.col(1));
  const double right = direction.col(0)[axisI] > 0.0 ? 1.0 : -1.0;
  double down = direction.col(1)[axisJ] > 0.0 ? 1.0 : -1.0;
  if (axisJ == 2) down = -down;
  return {right, down};
}

void SliceView::fit() {
  fitted_ = true;
  if (!hasVolume()) return;
  const image::Grid& grid = volume_.values->grid;
  const Eigen::Vector2d extent_mm = grid.spacing_mm.head<2>().cwiseProduct(grid.size.head<2>().cast<double>());
  const QRectF area = imageArea();
  zoom_px_mm_ = std::min(area.width() / extent_mm.x(), area.height() / extent_mm.y());
  const Eigen::Vector2d half_mm =
      0.5 * grid.spacing_mm.head<2>().cwiseProduct((grid.size.head<2>().array() - 1).matrix().cast<double>());
  offset_px_ = Eigen::Vector2d(area.center().x(), area.center().y()) - zoom_px_mm_ * axisSigns().cwiseProduct(half_mm);
  update();
  emit resettled();
}

tools::SlicePlane SliceView::plane() const {
  tools::SlicePlane plane;
  if (!hasVolume()) return plane;
  plane.grid = volume_.values->grid;
  plane.slice = slice_;
  plane.offset_px = offset_px_;
  plane.scale_px_mm = zoom_px_mm_ * axisSigns();
  const auto k = static_cast<std::size_t>(slice_);
  if (k < volume_.sopInstanceUids.size()) plane.sopInstanceUid = volume_.sopInstanceUids[k];
  return plane;
}

std::optional<double> SliceView::valueAt(const Eigen::Vector3d& p_lps) const {
  if (!hasVolume()) return std::nullopt;
  const image::Grid& grid = volume_.values->grid;
  const Eigen::Vector3i voxel = grid.lpsToIndex(p_lps).array().round().matrix().cast<int>();
  if (!grid.contains(voxel)) return std::nullopt;
  return volume_.values->at(voxel);
}

void SliceView::zoomAt(const QPointF& at, double factor) {
  const double wanted = std::clamp(zoom_px_mm_ * factor, 0.2, 60.0);
  const Eigen::Vector2d centre(at.x(), at.y());
  offset_px_ = centre + (offset_px_ - centre) * (wanted / zoom_px_mm_);
  zoom_px_mm_ = wanted;
  fitted_ = false;
  if (tool_) emit toolMoved(pointerOf(at, Qt::NoModifier));
  emit placeChanged();
  update();
}

Eigen::Vector3d SliceView::centre_lps() const {
  const QPointF middle = imageArea().center();
  return plane().toLps({middle.x(), middle.y()});
}

void SliceView::showPlace(const Eigen::Vector3d& centre_lps, double zoom_px_mm) {
  if (!hasVolume()) return;
  zoom_px_mm_ = std::clamp(zoom_px_mm, 0.2, 60.0);
  const Eigen::Vector2d off = plane().toPixel(centre_lps);
  const QPointF middle = imageArea().center();
  offset_px_ += Eigen::Vector2d(middle.x(), middle.y()) - off;
  fitted_ = false;
  update();
}

void SliceView::resizeEvent(QResizeEvent*) {
  fitted_ ? fit() : emit resettled();
}

void SliceView::mousePressEvent(QMouseEvent* event) {
  if (!hasVolume()) return;
  pressed_ = last_ = event->position();
  moved_ = false;
  const bool alt = event->modifiers().testFlag(Qt::AltModifier);
  if (event->button() == Qt::MiddleButton || (event->button() == Qt::LeftButton && space_))
    drag_ = Drag::Pan;
  else if (event->button() == Qt::LeftButton && (alt || leftWindows_))
    volume_.stiffness ? emit windowRefused() : void(drag_ = Drag::Window);
  else if (event->button() == Qt::RightButton)
    drag_ = rightWindows_ && !volume_.stiffness ? Drag::Window : Drag::Zoom;
  else if (event->button() == Qt::LeftButton) {
    drag_ = Drag::Tool;
    emit toolPressed(pointerOf(*event));
  }
}

void SliceView::mouseMoveEvent(QMouseEvent* event) {
  if (!hasVolume()) return;
  const QPointF at = event->position(), step = at - last_;
  last_ = at;
  byKeys_ = false;
  if ((at - pressed_).manhattanLength() > tools::reach::drag_px) moved_ = true;
  switch (drag_) {
    case Drag::Pan:
      offset_px_ += Eigen::Vector2d(step.x(), step.y());
      fitted_ = false;
      emit placeChanged();
      update();
      break;
    case Drag::Zoom:
      if (moved_) zoomAt(pressed_, std::exp(-step.y() * 0.01));
      break;
    case Drag::Window: {
      if (!moved_ && event->buttons().testFlag(Qt::RightButton)) break;  // it may become a click
      // Right widens the window, up makes the picture brighter, relative to what is shown.
      const double width = volume_.high - volume_.low, level = 0.5 * (volume_.high + volume_.low);
      const double newWidth = width * std::exp(step.x() * 0.005);
      const double newLevel = volume_.wave ? 0.0 : level + step.y() * width * 0.004;  // white is no displacement
      setWindow(newLevel - 0.5 * newWidth, newLevel + 0.5 * newWidth);
      emit windowChanged(volume_.low, volume_.high);
      break;
    }
    case Drag::Tool:
    case Drag::None: emit toolMoved(pointerOf(*event)); break;
  }
  emit cursorMoved(plane().toLps({at.x(), at.y()}));
  update();
}

void SliceView::mouseReleaseEvent(QMouseEvent* event) {
  const Drag was = std::exchange(drag_, Drag::None);
  if (!hasVolume()) return;
  if (was == Drag::Tool) emit toolReleased(pointerOf(*event));
  if (event->button() == Qt::RightButton && (was == Drag::Zoom || was == Drag::Window) && !moved_)
    emit toolRightClicked(pointerOf(*event));
  update();
}

void SliceView::mouseDoubleClickEvent(QMouseEvent* event) {
  if (!hasVolume()) return;
  if (event->button() == Qt::LeftButton)
    emit toolDoubleClicked(pointerOf(*event));
  else if (event->button() == Qt::MiddleButton)
    fit();
}

void SliceView::wheelEvent(QWheelEvent* event) {
  const int turned = event->angleDelta().y();
  if (!hasVolume() || turned == 0) return;
  constexpr int notch = QWheelEvent::DefaultDeltasPerStep;
  event->accept();
  if (event->modifiers().testFlag(Qt::ControlModifier)) {
    zoomAt(event->position(), std::pow(1.15, static_cast<double>(turned) / notch));
    return;
  }
  // A touchpad turns by little at a time: a slice for each whole notch, and nothing is kept when it turns round.
  if ((turned > 0) != (wheel_ > 0)) wheel_ = 0;
  wheel_ += turned;
  const int slices = wheel_ / notch;
  wheel_ -= slices * notch;
  if (slices != 0) setSlice(slice_ + slices);
}

void SliceView::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Space) {
    space_ = true;
    return;
  }
  event->ignore();  // whoever takes it accepts it
  emit keyDown(event);
  if (!event->isAccepted()) QWidget::keyPressEvent(event);
}

void SliceView::keyReleaseEvent(QKeyEvent* event) {
  if (event->isAutoRepeat()) return;
  if (event->key() == Qt::Key_Space)
    space_ = false;
  else
    emit keyUp(event);
}

// When an outline changes, not at every frame: it takes the square of its vertices.
void SliceView::judgeCrossings() {
  if (!contours_) return;
  const tools::SlicePlane shown = plane();
  judged_.resize(contours_->polygons.size());
  for (std::size_t p = 0; p < judged_.size(); ++p) {
    const roi::Polygon& polygon = contours_->polygons[p];
    const Eigen::Matrix3Xd& points = polygon.points_lps_mm;
    Judged& judged = judged_[p];
    if (!shown.holds(polygon) || (judged.points_lps_mm.cols() == points.cols() && judged.points_lps_mm == points))
      continue;
    tools::Outline flat(2, points.cols());
    for (Eigen::Index i = 0; i < points.cols(); ++i) flat.col(i) = shown.toPlane_mm(points.col(i));
    judged = {points, tools::crossesItself(flat, true)};
  }
}

void SliceView::setNote(const QString& note) {
  if (note == note_) return;
  note_ = note;
  update();
}

void SliceView::enterEvent(QEnterEvent*) {
  setFocus(Qt::MouseFocusReason);
}

void SliceView::leaveEvent(QEvent*) {
  space_ = hidden_ = false;
  emit cursorLeft();
}

}  // namespace glisson::views
