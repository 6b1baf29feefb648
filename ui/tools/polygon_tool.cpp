#include "tools/polygon_tool.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "tools/outline.h"

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
  message_.clear();
  drag_ = Drag::Press;
  pressed_px_ = at.px;
  pressedModifiers_ = at.modifiers;
  pressedHit_ = state() == ToolState::Drawing ? std::nullopt : hitTest(at.px, plane);
  return {};
}

Acts PolygonTool::move(const Pointer& at, const SlicePlane& plane) {
  pointer_ = snapped(at, plane);
  const bool drawing = state() == ToolState::Drawing;
  closes_ = drawing && onFirstVertex(at.px, plane);
  hover_ = drawing || drag_ == Drag::Freehand ? std::nullopt : hitTest(at.px, plane);

  if (drag_ == Drag::Press && (at.px - pressed_px_).norm() > reach::drag_px) {
    const bool handle = pressedHit_ && pressedHit_->kind != Hit::Kind::Inside;
    const bool ownInside = pressedHit_ && selected_ && pressedHit_->polygon == *selected_;
    if (drawing || (!handle && !selected_)) {
      drag_ = Drag::Freehand;
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
    } else if ((handle || ownInside) && !pressedModifiers_.ctrl && !pressedModifiers_.shift) {
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

  if (drag_ == Drag::Freehand) {
    const Eigen::Vector2d way = at.px - lastFreehand_px_;
    // Evenly spaced even where the mouse reports seldom.
    const int steps = static_cast<int>(way.norm() / reach::freehand_px);
    for (int s = 1; s <= steps; ++s)
      addVertex(plane.toLps(lastFreehand_px_ + way.normalized() * (reach::freehand_px * s)));
    if (steps > 0) lastFreehand_px_ += way.normalized() * (reach::freehand_px * steps);
    closes_ = onFirstVertex(at.px, plane);
  } else if (drag_ == Drag::Move) {
    const Eigen::Vector3d shift = plane.toLps(at.px) - plane.toLps(pressed_px_);
    preview_ = contours_.polygons[*selected_].points_lps_mm;
    for (const Eigen::Index v : vertices_) preview_.col(v) += shift;
  } else if (drag_ == Drag::Box) {
    box_ = Box{pressed_px_, at.px};
  }
  updateCrossing(plane);
  return {};
}

Acts PolygonTool::release(const Pointer& at, const SlicePlane& plane) {
  const Drag was = std::exchange(drag_, Drag::None);
  Acts acts;
  if (was == Drag::Press) {
    acts = click(at, plane);
  } else if (was == Drag::Freehand) {
    const bool closing = onFirstVertex(at.px, plane);
    if (!closing) addVertex(plane.toLps(at.px));
    endFreehand(plane);
    if (closing) acts = close(plane, false);
  } else if (was == Drag::Move) {
    if (preview_.cols() > 0) acts.push_back(ChangePoints{*selected_, preview_, PointsChange::Move});
    preview_.resize(3, 0);
    asked_ = false;
  } else if (was == Drag::Box && selected_ && box_) {
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
  box_.reset();
  updateCrossing(plane);
  return acts;
}

Acts PolygonTool::click(const Pointer& at, const SlicePlane& plane) {
  if (state() == ToolState::Drawing) {
    if (onFirstVertex(at.px, plane)) return close(plane, false);
    past_.push_back(points_);
    future_.clear();
    addVertex(snapped(at, plane));
    return {};
  }
  const bool onHandle = pressedHit_ && pressedHit_->kind != Hit::Kind::Inside;
  if (at.modifiers.ctrl && onHandle) {
    const std::size_t index = pressedHit_->polygon;
    const Eigen::Matrix3Xd& points = contours_.polygons[index].points_lps_mm;
    if (pressedHit_->kind == Hit::Kind::Edge) {
      select(index, {pressedHit_->vertex + 1});
      return {
          ChangePoints{index, withPoint(points, pressedHit_->vertex + 1, plane.toLps(at.px)), PointsChange::Insert}};
    }
    select(index, {pressedHit_->vertex});
    return removeSelection();
  }
  if (onHandle) {
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
  const bool insideAny = pressedHit_.has_value();
  if (selected_ && !(at.modifiers.shift && insideAny)) {
    if (insideAny)
      select(pressedHit_->polygon, allOf(contours_.polygons[pressedHit_->polygon].points_lps_mm));
    else
      select(std::nullopt);
    return {};
  }
  // Idle, or Shift inside a region: the first vertex (of a hole, by the even-odd rule, where it lies inside a region).
  select(std::nullopt);
  past_.push_back(points_);
  future_.clear();
  addVertex(plane.toLps(at.px));
  if (insideAny)
    message_ = contours_.polygons[pressedHit_->polygon].state == roi::PolygonState::Interpolated
                   ? "Once accepted, this outline replaces the interpolated ones of the slice."
                   : "An outline inside a region becomes a hole.";
  return {};
}

Acts PolygonTool::doubleClick(const Pointer& at, const SlicePlane& plane) {
  // The press and release before it were clicks already: in Drawing they added the last vertex.
  if (state() == ToolState::Drawing) {
    if (points_.cols() < 3) return {};
    return close(plane, false);
  }
  const std::optional<Hit> hit = hitTest(at.px, plane);
  if (state() == ToolState::Editing && hit && hit->polygon == *selected_) return accept(plane);
  return {};
}

Acts PolygonTool::rightClick(const Pointer&, const SlicePlane& plane) {
  message_.clear();
  return state() == ToolState::Drawing ? close(plane, false) : Acts{};
}

Acts PolygonTool::key(ToolKey key, const SlicePlane& plane) {
  message_.clear();
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
        return {RemovePolygon{index}};
      }
      return {};
    case ToolKey::Delete:
      return now == ToolState::Drawing ? Acts{} : removeSelection();
    case ToolKey::Escape:
      if (now == ToolState::Drawing) {
        Acts parked = leaveSlice(plane);
        selected_ = contours_.polygons.size();  // the draft, once it is added: a second Esc discards it
        return parked;
      }
      if (now == ToolState::Editing && !interpolated()) {
        const std::size_t index = *selected_;
        select(std::nullopt);
        message_ = "Draft discarded; undo brings it back.";
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
    acts.push_back(AddPolygon{polygonOf(plane, roi::PolygonState::Draft)});
    message_ = "Outline parked as a draft; click it to go on, Esc to discard.";
  }
  drag_ = Drag::None;
  box_.reset();
  preview_.resize(3, 0);
  hover_.reset();
  select(std::nullopt);
  clearDrawing();
  return acts;
}

bool PolygonTool::undoDrawing() {
  if (state() != ToolState::Drawing || past_.empty()) return false;
  future_.push_back(points_);
  points_ = past_.back();
  past_.pop_back();
  crosses_ = false;
  return true;
}

bool PolygonTool::redoDrawing() {
  if (future_.empty()) return false;
  past_.push_back(points_);
  points_ = future_.back();
  future_.pop_back();
  return true;
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
