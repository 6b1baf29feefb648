// SPDX-License-Identifier: GPL-3.0-or-later

// Clicks, keys and what parks an outline.
#include <algorithm>
#include <numeric>
#include <utility>

#include "tools/outline.h"
#include "tools/polygon_tool.h"

namespace glisson::tools {

namespace {

Eigen::Matrix3Xd withPoint(const Eigen::Matrix3Xd& points, Eigen::Index at, const Eigen::Vector3d& p) {
  Eigen::Matrix3Xd longer(3, points.cols() + 1);
  longer.leftCols(at) = points.leftCols(at);
  longer.col(at) = p;
  longer.rightCols(points.cols() - at) = points.rightCols(points.cols() - at);
  return longer;
}

std::vector<Eigen::Index> allOf(const Eigen::Matrix3Xd& points) {
  std::vector<Eigen::Index> all(static_cast<std::size_t>(points.cols()));
  std::iota(all.begin(), all.end(), Eigen::Index{0});
  return all;
}

}  // namespace

Acts PolygonTool::click(const Pointer& at, const SlicePlane& plane) {
  if (state() == ToolState::Drawing) {
    if (onFirstVertex(at, plane)) return close(plane, false);
    past_.push_back(points_);
    future_.clear();
    addVertex(snapped(at, plane));
    return {};
  }
  if (pressedHit_ && pressedHit_->kind != Hit::Kind::Inside) return clickHandle(at, plane);
  const bool insideAny = pressedHit_.has_value();
  if (selected_ && !(at.modifiers.shift && insideAny)) {
    if (insideAny)
      select(pressedHit_->polygon, allOf(contours_.polygons[pressedHit_->polygon].points_lps_mm));
    else
      select(std::nullopt);
    return {};
  }
  if (mode_ == ToolMode::Ellipse) {
    if (insideAny) select(pressedHit_->polygon, allOf(contours_.polygons[pressedHit_->polygon].points_lps_mm));
    return {};
  }
  // Idle, or Shift inside a region: the first vertex (of a hole, by the even-odd rule, where it lies inside a region).
  select(std::nullopt);
  past_.push_back(points_);
  future_.clear();
  addVertex(plane.toLps(at.px));
  if (insideAny)
    message_ = {contours_.polygons[pressedHit_->polygon].state == roi::PolygonState::Interpolated
                    ? say::replacesInterpolated
                    : say::becomesHole,
                {}};
  return {};
}

// A vertex or an edge of an outline that is there.
Acts PolygonTool::clickHandle(const Pointer& at, const SlicePlane& plane) {
  if (at.modifiers.ctrl) {
    const std::size_t index = pressedHit_->polygon;
    const Eigen::Matrix3Xd& points = contours_.polygons[index].points_lps_mm;
    if (pressedHit_->kind == Hit::Kind::Edge) {
      select(index);
      Acts inserted =
          changed(index, withPoint(points, pressedHit_->vertex + 1, plane.toLps(at.px)), PointsChange::Insert, plane);
      if (!inserted.empty()) vertices_ = {pressedHit_->vertex + 1};
      return inserted;
    }
    select(index, {pressedHit_->vertex});
    return removeSelection(plane);
  }
  const Eigen::Index n = contours_.polygons[pressedHit_->polygon].points_lps_mm.cols();
  std::vector<Eigen::Index> clicked{pressedHit_->vertex};
  if (pressedHit_->kind == Hit::Kind::Edge) clicked.push_back((pressedHit_->vertex + 1) % n);
  if (at.modifiers.shift && selected_ == pressedHit_->polygon) {
    for (const Eigen::Index v : clicked) {
      const auto found = std::find(vertices_.begin(), vertices_.end(), v);
      if (found == vertices_.end())
        vertices_.push_back(v);
      else
        vertices_.erase(found);
    }
  } else {
    select(pressedHit_->polygon, clicked);
  }
  return {};
}

Acts PolygonTool::doubleClick(const Pointer& at, const SlicePlane& plane) {
  if (hasDisc()) return press(at, plane);  // a quick second touch of the disc
  // The press and release before it were clicks already: in Drawing they added the last vertex.
  if (state() == ToolState::Drawing) {
    const bool justBegun = points_.cols() == 1 && (plane.toPixel(points_.col(0)) - at.px).norm() <= reach::hit_px;
    const std::optional<Hit> under = justBegun ? hitTest(at.px, plane) : std::nullopt;
    if (under) {
      // Begun by the first click of this very double-click, on an outline: its properties were meant.
      clearDrawing();
      select(under->polygon, allOf(contours_.polygons[under->polygon].points_lps_mm));
      properties_ = under->polygon;
      message_ = {};
      return {};
    }
    return close(plane, false);  // or says what is missing
  }
  const std::optional<Hit> hit = hitTest(at.px, plane);
  if (state() == ToolState::Editing && hit && hit->polygon == *selected_) return accept(plane);
  if (hit) {
    select(hit->polygon, allOf(contours_.polygons[hit->polygon].points_lps_mm));
    properties_ = hit->polygon;
  }
  return {};
}

Acts PolygonTool::rightClick(const Pointer& at, const SlicePlane& plane) {
  message_ = {};
  if (state() == ToolState::Drawing) return close(plane, false);
  const std::optional<Hit> hit = hitTest(at.px, plane);
  if (hit && selected_ != hit->polygon) {
    const bool whole = hit->kind == Hit::Kind::Inside;
    select(hit->polygon,
           whole ? allOf(contours_.polygons[hit->polygon].points_lps_mm) : std::vector<Eigen::Index>{hit->vertex});
  }
  return {};
}

Acts PolygonTool::key(ToolKey key, const SlicePlane& plane) {
  message_ = {};
  if (key == ToolKey::Escape && (drag_ == Drag::Ellipse || drag_ == Drag::Brush)) {
    drag_ = Drag::None;
    clearDrawing();
    return {};
  }
  const ToolState now = state();
  switch (key) {
    case ToolKey::Enter:
      if (now == ToolState::Drawing) return close(plane, false);
      if (now == ToolState::Editing) return accept(plane);
      return {};
    case ToolKey::CtrlEnter:
      if (now == ToolState::Drawing) return close(plane, true);
      if (now == ToolState::Editing) return accept(plane);
      return {};
    case ToolKey::Backspace:
      if (now == ToolState::Drawing) {
        past_.push_back(points_);
        future_.clear();
        points_.conservativeResize(3, points_.cols() - 1);
        if (points_.cols() == 0) clearDrawing();
        updateCrossing(plane);
      } else if (now == ToolState::Editing && !interpolated()) {
        // Takes a draft up again where it was left.
        const std::size_t index = *selected_;
        select(std::nullopt);
        points_ = contours_.polygons[index].points_lps_mm;
        if (mode_ != ToolMode::Freehand) mode_ = ToolMode::Polygon;
        return {RemovePolygon{index}};
      }
      return {};
    case ToolKey::Delete: return now == ToolState::Drawing ? Acts{} : removeSelection(plane);
    case ToolKey::Escape:
      if (now == ToolState::Drawing) {
        Acts parked = leaveSlice(plane);
        message_ = {say::parked, {}};
        selected_ = contours_.polygons.size();  // the draft, once it is added: a second Esc discards it
        return parked;
      }
      if (now == ToolState::Editing && !interpolated()) {
        const std::size_t index = *selected_;
        select(std::nullopt);
        message_ = {say::discarded, {}};
        return {RemovePolygon{index}};
      }
      select(std::nullopt);
      return {};
  }
  return {};
}

Acts PolygonTool::leaveSlice(const SlicePlane& plane) {
  Acts acts;
  if (points_.cols() > 0) {
    acts.emplace_back(AddPolygon{polygonOf(outlineInWork(), plane, roi::PolygonState::Draft)});
    message_ = {say::parkedOnSlice, {std::to_string(plane.slice + 1)}};
  }
  drag_ = Drag::None;
  properties_.reset();
  box_.reset();
  preview_.resize(3, 0);
  hover_.reset();
  select(std::nullopt);
  clearDrawing();
  return acts;
}

bool PolygonTool::undoDrawing(const SlicePlane& plane) {
  if (state() != ToolState::Drawing || past_.empty()) return false;
  future_.push_back(points_);
  points_ = past_.back();
  past_.pop_back();
  updateCrossing(plane);
  return true;
}

bool PolygonTool::redoDrawing(const SlicePlane& plane) {
  if (future_.empty()) return false;
  select(std::nullopt);
  past_.push_back(points_);
  points_ = future_.back();
  future_.pop_back();
  updateCrossing(plane);
  return true;
}

}  // namespace glisson::tools
