// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/polygon_tool.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "tools/outline.h"
#include "tools/reshape.h"

namespace glisson::tools {

namespace {

std::vector<Eigen::Index> allOf(const Eigen::Matrix3Xd& points) {
  std::vector<Eigen::Index> all(static_cast<std::size_t>(points.cols()));
  std::iota(all.begin(), all.end(), Eigen::Index{0});
  return all;
}

}  // namespace

ToolState PolygonTool::state() const {
  if (points_.cols() > 0) return ToolState::Drawing;
  if (!selected_) return ToolState::Idle;
  if (*selected_ >= contours_.polygons.size()) return ToolState::Editing;  // asked for, about to be added
  return contours_.polygons[*selected_].state == roi::PolygonState::Accepted ? ToolState::Accepted : ToolState::Editing;
}

bool PolygonTool::interpolated() const {
  return selected_ && *selected_ < contours_.polygons.size() &&
         contours_.polygons[*selected_].state == roi::PolygonState::Interpolated;
}

Acts PolygonTool::press(const Pointer& at, const SlicePlane& plane) {
  message_ = {};
  drag_ = Drag::Press;
  pressed_px_ = at.px;
  pressedModifiers_ = at.modifiers;
  pressedHit_ = state() == ToolState::Drawing ? std::nullopt : hitTest(at.px, plane);
  if (paints()) {
    const double radius_mm = brush_px_ / plane.scale_px_mm.cwiseAbs().mean();
    stroke_.emplace(plane, followsImage(plane) ? image_ : nullptr, plane.toPlane_mm(plane.toLps(at.px)), radius_mm);
    drag_ = Drag::Brush;
    paintTo(at, plane);
  }
  return {};
}

Acts PolygonTool::move(const Pointer& at, const SlicePlane& plane) {
  pointer_ = snapped(at, plane);
  const bool drawing = state() == ToolState::Drawing;
  closes_ = drawing && onFirstVertex(at, plane);
  hover_ = drawing || drag_ == Drag::Freehand || hasDisc() ? std::nullopt : hitTest(at.px, plane);
  if (drag_ == Drag::Press && ((at.px - pressed_px_).norm() > reach::drag_px || mode_ == ToolMode::Sculpt))
    beginDrag(plane);

  if (drag_ == Drag::Freehand) {
    const Eigen::Vector2d way = at.px - lastFreehand_px_;
    // Evenly spaced even where the mouse reports seldom.
    const int steps = static_cast<int>(way.norm() / freehand_px_);
    for (int s = 1; s <= steps; ++s) addVertex(plane.toLps(lastFreehand_px_ + way.normalized() * (freehand_px_ * s)));
    if (steps > 0) lastFreehand_px_ += way.normalized() * (freehand_px_ * steps);
    closes_ = onFirstVertex(at, plane);
  } else if (drag_ == Drag::Move) {
    const Eigen::Vector3d shift = plane.toLps(at.px) - plane.toLps(pressed_px_);
    preview_ = contours_.polygons[*selected_].points_lps_mm;
    for (const Eigen::Index v : vertices_) preview_.col(v) += shift;
  } else if (drag_ == Drag::Sculpt) {
    sculptTo(at.px, plane);
  } else if (drag_ == Drag::Ellipse) {
    drawEllipse(at, plane);
  } else if (drag_ == Drag::Brush) {
    paintTo(at, plane);
  } else if (drag_ == Drag::Box) {
    box_ = Box{pressed_px_, at.px};
  }
  updateCrossing(plane);
  return {};
}

void PolygonTool::beginDrag(const SlicePlane& plane) {
  if (mode_ == ToolMode::Sculpt) {
    beginSculpt(plane);
    return;
  }
  const bool drawing = state() == ToolState::Drawing;
  const bool handle = pressedHit_ && pressedHit_->kind != Hit::Kind::Inside;
  const bool ownInside = pressedHit_ && selected_ && pressedHit_->polygon == *selected_;
  const bool moves = (handle || ownInside) && !pressedModifiers_.ctrl && !pressedModifiers_.shift;
  if (mode_ == ToolMode::Ellipse && !moves) {
    select(std::nullopt);
    drag_ = Drag::Ellipse;
    return;
  }
  if (curved() && (drawing || (!handle && !selected_))) return;  // a click, where it is let go
  if (drawing || mode_ == ToolMode::Freehand || (!handle && !selected_)) {
    drag_ = Drag::Freehand;
    select(std::nullopt);
    past_.push_back(points_);
    future_.clear();
    freehandStart_ = points_.cols();
    if (!drawing) {
      points_.resize(3, 1);
      points_.col(0) = plane.toLps(pressed_px_);
      lastFreehand_px_ = pressed_px_;
    } else {
      lastFreehand_px_ = plane.toPixel(points_.col(points_.cols() - 1));
    }
  } else if (moves) {
    drag_ = Drag::Move;
    const std::size_t polygon = pressedHit_->polygon;
    const Eigen::Matrix3Xd& points = contours_.polygons[polygon].points_lps_mm;
    const bool sameSelection = selected_ == polygon && pressedHit_->kind == Hit::Kind::Vertex &&
                               std::find(vertices_.begin(), vertices_.end(), pressedHit_->vertex) != vertices_.end();
    if (pressedHit_->kind == Hit::Kind::Inside) {
      select(polygon, allOf(points));
    } else if (!sameSelection) {
      std::vector<Eigen::Index> grabbed{pressedHit_->vertex};
      if (pressedHit_->kind == Hit::Kind::Edge) grabbed.push_back((pressedHit_->vertex + 1) % points.cols());
      select(polygon, grabbed);
    }
  } else if (selected_) {
    drag_ = Drag::Box;
  }
}

Acts PolygonTool::release(const Pointer& at, const SlicePlane& plane) {
  const Drag was = std::exchange(drag_, Drag::None);
  Acts acts = was == Drag::Press && mode_ != ToolMode::Sculpt ? click(at, plane) : endDrag(was, at, plane);
  box_.reset();
  updateCrossing(plane);
  return acts;
}

Acts PolygonTool::endDrag(Drag was, const Pointer& at, const SlicePlane& plane) {
  if (was == Drag::Freehand) {
    const bool closing = onFirstVertex(at, plane);
    if (!closing) addVertex(plane.toLps(at.px));
    endFreehand(plane);
    return closing || mode_ == ToolMode::Freehand ? close(plane, false) : Acts{};
  }
  if (was == Drag::Ellipse) {
    drawEllipse(at, plane);
    if (shape_.empty()) return {};
    Eigen::Matrix3Xd ring = std::exchange(shape_, {}).front();
    return closeOutline(std::move(ring), plane, false);
  }
  if (was == Drag::Brush) {
    paintTo(at, plane);
    return endBrush(plane);
  }
  if (was == Drag::Move || was == Drag::Sculpt) {
    const bool sculpted = was == Drag::Sculpt;
    const Eigen::Matrix3Xd points = std::exchange(preview_, Eigen::Matrix3Xd(3, 0));
    if (points.cols() == 0 || (sculpted && points == contours_.polygons[*selected_].points_lps_mm)) return {};
    return changed(*selected_, points, sculpted ? PointsChange::Sculpt : PointsChange::Move, plane);
  }
  if (was == Drag::Box && selected_ && box_) {
    const Eigen::Array2d low = box_->from_px.cwiseMin(box_->to_px).array();
    const Eigen::Array2d high = box_->from_px.cwiseMax(box_->to_px).array();
    const Eigen::Matrix3Xd& points = contours_.polygons[*selected_].points_lps_mm;
    std::vector<Eigen::Index> caught = pressedModifiers_.shift ? vertices_ : std::vector<Eigen::Index>{};
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      const Eigen::Array2d px = plane.toPixel(points.col(i)).array();
      if ((px >= low).all() && (px <= high).all() && std::find(caught.begin(), caught.end(), i) == caught.end())
        caught.push_back(i);
    }
    vertices_ = caught;
  }
  return {};
}

void PolygonTool::beginSculpt(const SlicePlane& plane) {
  const std::optional<std::size_t> target =
      selected_ && *selected_ < contours_.polygons.size() ? selected_ : nearestPolygon(pressed_px_, plane);
  if (!target) {
    message_ = {say::nothingToSculpt, {}};
    drag_ = Drag::None;
    return;
  }
  select(*target);
  drag_ = Drag::Sculpt;
  preview_ = contours_.polygons[*target].points_lps_mm;
  lastFreehand_px_ = pressed_px_;
  sculptTo(pressed_px_, plane);
}

// The disc goes along the way of the mouse in steps of a third of its radius, so that nothing slips through.
void PolygonTool::sculptTo(const Eigen::Vector2d& px, const SlicePlane& plane) {
  const double perPixel_mm = 1.0 / plane.scale_px_mm.cwiseAbs().mean();
  const double radius_mm = brush_px_ * perPixel_mm;
  const double step_mm =
      std::max(radius_mm / 4.0, std::min(0.5 * plane.grid.spacing_mm.head<2>().minCoeff(), radius_mm));
  const Eigen::Vector2d way = px - lastFreehand_px_;
  const int steps = std::max(1, static_cast<int>(std::ceil(way.norm() / (brush_px_ / 3.0))));
  const Outline before = planePoints(preview_, plane);
  Outline flat = before;
  for (int s = 1; s <= steps; ++s) {
    const Eigen::Vector2d at = lastFreehand_px_ + way * (static_cast<double>(s) / steps);
    flat = pushed(flat, plane.toPlane_mm(plane.toLps(at)), radius_mm, step_mm);
  }
  lastFreehand_px_ = px;
  if (flat.cols() < 3 || flat == before) return;
  Eigen::Matrix3Xd points = plane.fromPlane(flat);
  // Vertices out of reach keep their bits: they do not go through the plane and back.
  for (Eigen::Index i = 0, j = 0; i < flat.cols(); ++i)
    for (Eigen::Index k = j; k < before.cols(); ++k)
      if (flat.col(i) == before.col(k)) {
        points.col(i) = preview_.col(k);
        j = k + 1;
        break;
      }
  preview_ = std::move(points);
}

void PolygonTool::contoursChanged() {
  if (points_.cols() == 0) past_.clear(), future_.clear();
  hover_.reset();
  preview_.resize(3, 0);
  if (selected_ && *selected_ >= contours_.polygons.size()) select(std::nullopt);
  if (!selected_) return;
  const Eigen::Index n = contours_.polygons[*selected_].points_lps_mm.cols();
  std::erase_if(vertices_, [n](Eigen::Index v) { return v >= n; });
}

}  // namespace glisson::tools
