// SPDX-License-Identifier: GPL-3.0-or-later

// The rules behind the gestures: what is under the mouse, what closes, what is refused.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "tools/outline.h"
#include "tools/polygon_tool.h"

namespace glisson::tools {

std::optional<Hit> PolygonTool::hitTest(const Eigen::Vector2d& px, const SlicePlane& plane) const {
  std::optional<Hit> vertex, edge, inner;
  double nearestVertex = reach::hit_px, nearestEdge = reach::hit_px, smallest = std::numeric_limits<double>::max();
  for (std::size_t p = 0; p < contours_.polygons.size(); ++p) {
    const roi::Polygon& polygon = contours_.polygons[p];
    if (!plane.holds(polygon)) continue;
    const Eigen::Index n = polygon.points_lps_mm.cols();
    Outline outline(2, n);
    for (Eigen::Index i = 0; i < n; ++i) outline.col(i) = plane.toPixel(polygon.points_lps_mm.col(i));
    for (Eigen::Index i = 0; i < n; ++i) {
      const double toVertex = (outline.col(i) - px).norm();
      if (toVertex <= nearestVertex) nearestVertex = toVertex, vertex = Hit{Hit::Kind::Vertex, p, i};
      const double toEdge = distanceToSegment(px, outline.col(i), outline.col((i + 1) % n));
      if (toEdge <= nearestEdge) nearestEdge = toEdge, edge = Hit{Hit::Kind::Edge, p, i};
    }
    const double area = std::abs(signedArea(outline));
    if (area < smallest && inside(px, outline)) smallest = area, inner = Hit{Hit::Kind::Inside, p, 0};
  }
  if (vertex) return vertex;
  return edge ? edge : inner;
}

bool PolygonTool::onFirstVertex(const Pointer& at, const SlicePlane& plane) const {
  const double reach_px = at.touch ? reach::closeTouch_px : reach::close_px;
  return points_.cols() >= 3 && (plane.toPixel(points_.col(0)) - at.px).norm() <= reach_px;
}

std::optional<std::size_t> PolygonTool::nearestPolygon(const Eigen::Vector2d& px, const SlicePlane& plane) const {
  std::optional<std::size_t> nearest;
  double least = std::numeric_limits<double>::max();
  for (std::size_t p = 0; p < contours_.polygons.size(); ++p) {
    const roi::Polygon& polygon = contours_.polygons[p];
    if (!plane.holds(polygon)) continue;
    const Eigen::Index n = polygon.points_lps_mm.cols();
    for (Eigen::Index i = 0; i < n; ++i) {
      const double d = distanceToSegment(px, plane.toPixel(polygon.points_lps_mm.col(i)),
                                         plane.toPixel(polygon.points_lps_mm.col((i + 1) % n)));
      if (d < least) least = d, nearest = p;
    }
  }
  return nearest;
}

Eigen::Vector3d PolygonTool::snapped(const Pointer& at, const SlicePlane& plane) const {
  if (!at.modifiers.shift || points_.cols() == 0) return plane.toLps(at.px);
  const Eigen::Vector2d last = plane.toPixel(points_.col(points_.cols() - 1));
  const Eigen::Vector2d way = at.px - last;
  constexpr double step = std::numbers::pi / 4.0;
  const double angle = step * std::round(std::atan2(way.y(), way.x()) / step);
  return plane.toLps(last + way.norm() * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
}

void PolygonTool::addVertex(const Eigen::Vector3d& p_lps) {
  points_.conservativeResize(3, points_.cols() + 1);
  points_.col(points_.cols() - 1) = p_lps;
  asked_ = false;
}

void PolygonTool::endFreehand(const SlicePlane& plane) {
  const Eigen::Index start = std::max<Eigen::Index>(freehandStart_ - 1, 0);
  const Eigen::Matrix3Xd stroke = points_.rightCols(points_.cols() - start);
  const double tolerance_mm = reach::simplify * plane.grid.spacing_mm.head<2>().minCoeff();
  const std::vector<Eigen::Index> kept = simplify(planePoints(stroke, plane), tolerance_mm);
  Eigen::Matrix3Xd shorter(3, start + static_cast<Eigen::Index>(kept.size()));
  shorter.leftCols(start) = points_.leftCols(start);
  for (std::size_t i = 0; i < kept.size(); ++i) shorter.col(start + static_cast<Eigen::Index>(i)) = stroke.col(kept[i]);
  points_ = shorter;
}

Acts PolygonTool::close(const SlicePlane& plane, bool acceptToo) {
  return closeOutline(closedOutline(plane), plane, acceptToo);
}

Acts PolygonTool::closeOutline(Eigen::Matrix3Xd points, const SlicePlane& plane, bool acceptToo) {
  message_ = refusal(points, plane);
  if (!message_.empty()) return {};
  const bool crossing = crosses(points, plane);
  const bool accepted = acceptToo && !crossing;
  roi::Polygon polygon =
      polygonOf(std::move(points), plane, accepted ? roi::PolygonState::Accepted : roi::PolygonState::Draft);
  clearDrawing();
  select(contours_.polygons.size());  // its place once it is added
  message_ = {crossing ? say::closedCrossing : accepted ? say::accepted : say::closed, {}};
  asked_ = crossing;
  return {AddPolygon{std::move(polygon)}};
}

Acts PolygonTool::accept(const SlicePlane& plane) {
  const roi::Polygon& polygon = contours_.polygons[*selected_];
  message_ = refusal(polygon.points_lps_mm, plane);
  if (!message_.empty()) return {};
  if (!asked_ && crosses(polygon.points_lps_mm, plane)) {
    asked_ = true;
    message_ = {say::acceptCrossing, {}};
    return {};
  }
  asked_ = false;
  vertices_.clear();
  message_ = {say::accepted, {}};
  return {ChangeState{*selected_, roi::PolygonState::Accepted}};
}

// Points of an outline that is there. One that counts stays a region: too little of it is refused, and where it comes
// to cross itself it is a draft until it is accepted anew.
Acts PolygonTool::changed(std::size_t index, Eigen::Matrix3Xd points, PointsChange change, const SlicePlane& plane) {
  const roi::Polygon& before = contours_.polygons[index];
  ChangePoints act{index, std::move(points), change};
  asked_ = false;
  if (before.state != roi::PolygonState::Draft) {
    if (Sentence why = refusal(act.points_lps_mm, plane, true); !why.empty()) {
      message_ = std::move(why);
      return {};
    }
    if (crosses(act.points_lps_mm, plane) && !crosses(before.points_lps_mm, plane)) {
      act.toDraft = asked_ = true;
      message_ = {say::crossesNow, {}};
    }
  }
  return {std::move(act)};
}

Acts PolygonTool::removeSelection(const SlicePlane& plane) {
  if (!selected_) return {};
  const std::size_t index = *selected_;
  const Eigen::Matrix3Xd& points = contours_.polygons[index].points_lps_mm;
  const Eigen::Index left = points.cols() - static_cast<Eigen::Index>(vertices_.size());
  if (vertices_.empty() || left < 3) {
    if (!vertices_.empty() && left > 0) message_ = {say::wholeDeleted, {}};
    select(std::nullopt);
    return {RemovePolygon{index}};
  }
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    if (std::find(vertices_.begin(), vertices_.end(), i) == vertices_.end()) kept.push_back(i);
  Acts acts = changed(index, points(Eigen::all, kept), PointsChange::Delete, plane);
  if (!acts.empty()) vertices_.clear();
  return acts;
}

bool PolygonTool::crosses(const Eigen::Matrix3Xd& points, const SlicePlane& plane) const {
  return crossesItself(planePoints(points, plane), true);
}

// edit: of an outline that is there, which then stays as it is.
Sentence PolygonTool::refusal(const Eigen::Matrix3Xd& points, const SlicePlane& plane, bool edit) const {
  const Outline outline = planePoints(points, plane);
  const int distinct = distinctPoints(outline, 1e-6);
  if (distinct < 3) return {edit ? say::fewVerticesLeft : say::fewVertices, {std::to_string(distinct)}};
  roi::ContourStack alone;
  alone.polygons.push_back(polygonOf(points, plane, roi::PolygonState::Accepted));
  std::ptrdiff_t voxels = 0;
  try {
    const image::Mask mask = roi::rasterise(alone, plane.sliceGrid());
    voxels = std::count(mask.values.begin(), mask.values.end(), std::uint8_t{1});
  } catch (const BadInput& nothingThere) {
    return {say::asItIs, {nothingThere.what()}};
  }
  if (voxels < reach::minimumVoxels)
    return {edit ? say::fewVoxelsLeft : say::fewVoxels, {std::to_string(reach::minimumVoxels), std::to_string(voxels)}};
  return {};
}

roi::Polygon PolygonTool::polygonOf(Eigen::Matrix3Xd points, const SlicePlane& plane, roi::PolygonState state) {
  roi::Polygon polygon;
  polygon.points_lps_mm = std::move(points);
  polygon.state = state;
  polygon.sopInstanceUid = plane.sopInstanceUid;
  return polygon;
}

Eigen::Matrix2Xd PolygonTool::planePoints(const Eigen::Matrix3Xd& points, const SlicePlane& plane) const {
  Outline flat(2, points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i) flat.col(i) = plane.toPlane_mm(points.col(i));
  return flat;
}

void PolygonTool::updateCrossing(const SlicePlane& plane) {
  updateCurve(plane);
  if (preview_.cols() > 0) {
    crosses_ = crossesItself(planePoints(preview_, plane), true);
  } else if (curved()) {
    // A livewire is judged once it is closed: near its clicks it may run along one edge twice.
    crosses_ = mode_ == ToolMode::Spline && curve_.cols() > 3 &&
               crossesItself(planePoints(curve_.leftCols(curve_.cols() - 1), plane), true);
  } else if (state() == ToolState::Drawing) {
    Eigen::Matrix3Xd band = points_;
    if (pointer_ && drag_ != Drag::Freehand && !closes_) {
      band.conservativeResize(3, band.cols() + 1);
      band.col(band.cols() - 1) = *pointer_;
    }
    crosses_ = crossesItself(planePoints(band, plane), false);
  } else {
    crosses_ = false;
  }
}

void PolygonTool::select(std::optional<std::size_t> polygon, std::vector<Eigen::Index> vertices) {
  if (selected_ != polygon) asked_ = false;
  selected_ = polygon;
  vertices_ = std::move(vertices);
}

void PolygonTool::clearDrawing() {
  points_.resize(3, 0);
  curve_.resize(3, 0);
  outline_.resize(3, 0);
  legs_.clear();
  shape_.clear();
  stroke_.reset();
  past_.clear();
  future_.clear();
  closes_ = crosses_ = false;
}

}  // namespace glisson::tools
