// SPDX-License-Identifier: GPL-3.0-or-later

// Acts on the selection: nudge, split, trim, kind; and the tool in hand.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "tools/outline.h"
#include "tools/polygon_tool.h"
#include "tools/reshape.h"

namespace glisson::tools {

Acts PolygonTool::setMode(ToolMode mode, const SlicePlane& plane) {
  if (mode == mode_) return {};
  Acts acts = points_.cols() > 0 ? leaveSlice(plane) : Acts{};
  if (drag_ == Drag::Ellipse || drag_ == Drag::Brush) drag_ = Drag::None;
  clearDrawing();  // nothing of it is done again by another tool
  mode_ = mode;
  hover_.reset();
  return acts;
}

void PolygonTool::setFreehandSpacing(double px) {
  freehand_px_ = std::clamp(px, 1.0, 100.0);
}

void PolygonTool::setBrushRadius(double px) {
  brush_px_ = std::clamp(px, 4.0, 200.0);
}

void PolygonTool::selectAll(const SlicePlane& plane) {
  if (state() == ToolState::Drawing) return;
  std::optional<std::size_t> polygon = selected_;
  if (!polygon) polygon = nearestPolygon(pointer_ ? plane.toPixel(*pointer_) : Eigen::Vector2d::Zero(), plane);
  if (!polygon || *polygon >= contours_.polygons.size()) return;
  std::vector<Eigen::Index> all(static_cast<std::size_t>(contours_.polygons[*polygon].points_lps_mm.cols()));
  std::iota(all.begin(), all.end(), Eigen::Index{0});
  select(polygon, std::move(all));
}

Acts PolygonTool::nudge(const Eigen::Vector2d& pixels, const SlicePlane& plane) {
  if (state() == ToolState::Drawing || !selected_ || vertices_.empty() || drag_ != Drag::None) return {};
  const Eigen::Array2d sign = plane.scale_px_mm.array().sign();
  const Eigen::Vector2d step_mm = (pixels.array() * sign * plane.grid.spacing_mm.head<2>().array()).matrix();
  const Eigen::Vector3d shift = plane.grid.direction * Eigen::Vector3d(step_mm.x(), step_mm.y(), 0.0);
  Eigen::Matrix3Xd points = contours_.polygons[*selected_].points_lps_mm;
  for (const Eigen::Index v : vertices_) points.col(v) += shift;
  return changed(*selected_, std::move(points), PointsChange::Nudge, plane);
}

Acts PolygonTool::split(const SlicePlane& plane) {
  message_ = {};
  if (state() == ToolState::Drawing || !selected_) {
    message_ = {say::selectFirst, {}};
    return {};
  }
  const std::size_t index = *selected_;
  const roi::Polygon& whole = contours_.polygons[index];
  const Eigen::Index n = whole.points_lps_mm.cols();
  if (const auto ends = cutBetween(n, vertices_)) {
    auto [first, second] = cut(whole.points_lps_mm, ends->first, ends->second);
    return cutAlong(index, std::move(first), std::move(second), plane);
  }
  std::vector<Eigen::Index> chosen = vertices_;
  if (chosen.empty()) {
    chosen.resize(static_cast<std::size_t>(n));
    std::iota(chosen.begin(), chosen.end(), Eigen::Index{0});
  }
  Eigen::Matrix3Xd points = withHalvedEdges(whole.points_lps_mm, chosen);
  if (points.cols() == n) {
    message_ = {say::splitNeeds, {}};
    return {};
  }
  vertices_.clear();
  return {ChangePoints{index, std::move(points), PointsChange::Insert}};
}

Acts PolygonTool::trim(const SlicePlane& plane) {
  message_ = {};
  if (state() == ToolState::Drawing || !selected_) {
    message_ = {say::selectFirst, {}};
    return {};
  }
  const std::size_t index = *selected_;
  const Eigen::Matrix3Xd& points = contours_.polygons[index].points_lps_mm;
  const Eigen::Index n = points.cols();
  if (const auto ends = cutBetween(n, vertices_)) {
    const auto [first, second] = cut(points, ends->first, ends->second);
    const auto area = [](const Eigen::Matrix3Xd& ring) {
      Eigen::Vector3d twice = Eigen::Vector3d::Zero();
      for (Eigen::Index i = 0; i < ring.cols(); ++i) {
        const Eigen::Vector3d a = ring.col(i) - ring.col(0), b = ring.col((i + 1) % ring.cols()) - ring.col(0);
        twice += a.cross(b);
      }
      return 0.5 * twice.norm();
    };
    Acts acts = changed(index, area(first) >= area(second) ? first : second, PointsChange::Delete, plane);
    if (!acts.empty()) vertices_.clear();
    return acts;
  }
  std::vector<Eigen::Index> chosen = vertices_;
  if (chosen.empty()) {
    chosen.resize(static_cast<std::size_t>(n));
    std::iota(chosen.begin(), chosen.end(), Eigen::Index{0});
  }
  std::sort(chosen.begin(), chosen.end());
  std::vector<Eigen::Index> kept;
  std::size_t at = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const bool isChosen = at < chosen.size() && chosen[at] == i;
    if (!isChosen || at % 2 == 0) kept.push_back(i);
    if (isChosen) ++at;
  }
  if (kept.size() < 3 || static_cast<Eigen::Index>(kept.size()) == n) {
    message_ = {say::trimNeeds, {}};
    return {};
  }
  Acts acts = changed(index, points(Eigen::all, kept), PointsChange::Delete, plane);
  if (!acts.empty()) vertices_.clear();
  return acts;
}

Acts PolygonTool::cutAlong(std::size_t index, Eigen::Matrix3Xd first, Eigen::Matrix3Xd second,
                           const SlicePlane& plane) {
  const roi::Polygon& whole = contours_.polygons[index];
  const bool counts = whole.state != roi::PolygonState::Draft;
  const bool crossed = counts && crosses(whole.points_lps_mm, plane);
  message_ = {say::cutInTwo, {}};
  std::vector<roi::Polygon> parts(2, whole);
  parts[0].points_lps_mm = std::move(first);
  parts[1].points_lps_mm = std::move(second);
  for (roi::Polygon& part : parts) {
    if (!counts) continue;
    if (Sentence why = refusal(part.points_lps_mm, plane, true); !why.empty()) {
      message_ = std::move(why);
      return {};
    }
    // A chord through a bay of the outline runs across its edges.
    if (!crossed && crosses(part.points_lps_mm, plane)) {
      part.state = roi::PolygonState::Draft;
      message_ = {say::crossesNow, {}};
    }
  }
  select(index);
  return {ReplacePolygons{{index}, std::move(parts), ReplaceReason::Cut}};
}

Acts PolygonTool::setKind(bool exclude) {
  message_ = {};
  if (state() == ToolState::Drawing || !selected_) {
    message_ = {say::selectFirst, {}};
    return {};
  }
  if (contours_.polygons[*selected_].exclude == exclude) return {};
  message_ = {exclude ? say::leftOut : say::counts, {}};
  return {ChangeKind{*selected_, exclude}};
}

}  // namespace glisson::tools
