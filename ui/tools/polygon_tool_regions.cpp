// SPDX-License-Identifier: GPL-3.0-or-later

// Outlines as sets of points: brush, eraser, union, difference, intersection.
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/error.h"
#include "roi/set_operations.h"
#include "tools/outline.h"
#include "tools/polygon_tool.h"

namespace glisson::tools {

namespace {

/// Whether two rings are one, whichever vertex they start from and whichever way they run.
bool sameRing(const Outline& a, const Outline& b) {
  const Eigen::Index n = a.cols();
  if (n != b.cols() || n == 0) return false;
  for (Eigen::Index s = 0; s < n; ++s) {
    if (a.col(0) != b.col(s)) continue;
    bool forth = true, back = true;
    for (Eigen::Index v = 0; v < n && (forth || back); ++v) {
      forth = forth && a.col(v) == b.col((s + v) % n);
      back = back && a.col(v) == b.col((s + n - v) % n);
    }
    if (forth || back) return true;
  }
  return false;
}

}  // namespace

void PolygonTool::paintTo(const Pointer& at, const SlicePlane& plane) {
  stroke_->dragTo(plane.toPlane_mm(plane.toLps(at.px)), at.modifiers.shift);
  shape_.clear();
  const double radius_mm = brush_px_ / plane.scale_px_mm.cwiseAbs().mean();
  const double tolerance_mm =
      std::min(reach::simplify * plane.grid.spacing_mm.head<2>().minCoeff(), reach::round * radius_mm);
  for (const Outline& ring : stroke_->rings(tolerance_mm)) shape_.push_back(plane.fromPlane(ring));
}

roi::FlatRegion PolygonTool::regionOf(const std::vector<std::size_t>& polygons, const SlicePlane& plane) const {
  roi::FlatRegion region;
  for (const std::size_t p : polygons) {
    region.rings_mm.push_back(planePoints(contours_.polygons[p].points_lps_mm, plane));
    region.flips.push_back(contours_.polygons[p].combine == roi::Combine::Parity);
  }
  return region;
}

// Outlines of the slice that meet these rings, those that meet them in turn (holes), and so on: what is left over
// means the same without them.
std::vector<std::size_t> PolygonTool::meeting(std::vector<Outline> rings, bool exclude,
                                              std::optional<std::size_t> without, const SlicePlane& plane) const {
  std::vector<std::pair<std::size_t, Outline>> others;
  for (std::size_t p = 0; p < contours_.polygons.size(); ++p) {
    const roi::Polygon& polygon = contours_.polygons[p];
    if (p != without && polygon.exclude == exclude && polygon.points_lps_mm.cols() >= 3 && plane.holds(polygon))
      others.emplace_back(p, planePoints(polygon.points_lps_mm, plane));
  }
  std::vector<std::size_t> group;
  while (!rings.empty()) {
    const Outline ring = std::move(rings.back());
    rings.pop_back();
    std::erase_if(others, [&](const auto& other) {
      if (!roi::meet(ring, other.second)) return false;
      group.push_back(other.first);
      rings.push_back(other.second);
      return true;
    });
  }
  std::sort(group.begin(), group.end());
  return group;
}

// What counts goes on to count; what is new is to be accepted first.
roi::PolygonState PolygonTool::stateOf(const std::vector<std::size_t>& polygons) const {
  const auto any = [&](roi::PolygonState state) {
    return std::any_of(polygons.begin(), polygons.end(),
                       [&](std::size_t p) { return contours_.polygons[p].state == state; });
  };
  if (any(roi::PolygonState::Accepted)) return roi::PolygonState::Accepted;
  return any(roi::PolygonState::Draft) || polygons.empty() ? roi::PolygonState::Draft : roi::PolygonState::Interpolated;
}

PolygonTool::Parts PolygonTool::partsOf(const roi::FlatRegion& region, const std::vector<std::size_t>& group,
                                        const roi::Polygon& like, const SlicePlane& plane) const {
  Parts result;
  // Vertices that stay keep their bits: they do not go through the plane and back.
  std::map<std::pair<double, double>, Eigen::Vector3d> known;
  std::vector<std::pair<std::size_t, Outline>> before;
  for (const std::size_t p : group) {
    const roi::Polygon& polygon = contours_.polygons[p];
    before.emplace_back(p, planePoints(polygon.points_lps_mm, plane));
    for (Eigen::Index v = 0; v < polygon.points_lps_mm.cols(); ++v)
      known.try_emplace({before.back().second(0, v), before.back().second(1, v)}, polygon.points_lps_mm.col(v));
  }
  std::vector<std::pair<double, roi::Polygon>> bySize;
  for (std::size_t r = 0; r < region.rings_mm.size(); ++r) {
    const Outline& ring = region.rings_mm[r];
    const roi::Combine combine = region.flips[r] ? roi::Combine::Parity : roi::Combine::Union;
    const auto same = std::find_if(before.begin(), before.end(), [&](const auto& b) {
      return contours_.polygons[b.first].combine == combine && sameRing(ring, b.second);
    });
    if (same != before.end()) {
      before.erase(same);
      continue;
    }
    roi::Polygon polygon = like;
    polygon.combine = combine;
    polygon.points_lps_mm = plane.fromPlane(ring);
    for (Eigen::Index v = 0; v < ring.cols(); ++v)
      if (const auto found = known.find({ring(0, v), ring(1, v)}); found != known.end())
        polygon.points_lps_mm.col(v) = found->second;
    if (refusal(polygon.points_lps_mm, plane).empty())
      bySize.emplace_back(std::abs(signedArea(ring)), std::move(polygon));
    else
      ++result.small;
  }
  std::stable_sort(bySize.begin(), bySize.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  for (auto& [area, polygon] : bySize) result.parts.push_back(std::move(polygon));
  for (const auto& [p, ring] : before) result.replaced.push_back(p);
  return result;
}

Acts PolygonTool::replaced(Parts parts, ReplaceReason reason, const char* said) {
  message_ = {said, {}};
  if (parts.small > 0)
    message_ = {say::smallParts, {std::to_string(reach::minimumVoxels), std::to_string(parts.small)}};
  if (parts.parts.empty())
    select(std::nullopt);
  else
    select(parts.replaced.empty() ? contours_.polygons.size() : parts.replaced.front());
  return {ReplacePolygons{std::move(parts.replaced), std::move(parts.parts), reason}};
}

Acts PolygonTool::endBrush(const SlicePlane& plane) {
  roi::FlatRegion painted;
  for (const Eigen::Matrix3Xd& ring : std::exchange(shape_, {})) painted.rings_mm.push_back(planePoints(ring, plane));
  painted.flips.assign(painted.rings_mm.size(), true);  // a ring and its holes, even-odd
  stroke_.reset();
  if (painted.rings_mm.empty()) return {};
  const bool erases = mode_ == ToolMode::Eraser;
  const bool exclude = selected_ && *selected_ < contours_.polygons.size() && contours_.polygons[*selected_].exclude &&
                       plane.holds(contours_.polygons[*selected_]);
  const std::vector<std::size_t> group = meeting(painted.rings_mm, exclude, std::nullopt, plane);
  if (erases && group.empty()) {
    message_ = {say::nothingToErase, {}};
    return {};
  }
  const roi::FlatRegion result =
      roi::combined(regionOf(group, plane), painted, erases ? roi::SetOperation::Difference : roi::SetOperation::Union);
  roi::Polygon like = polygonOf({}, plane, stateOf(group));
  like.exclude = exclude;
  Parts parts = partsOf(result, group, like, plane);
  if (parts.parts.empty() && (parts.replaced.empty() || !erases)) {
    if (parts.small > 0)
      message_ = {say::smallParts, {std::to_string(reach::minimumVoxels), std::to_string(parts.small)}};
    return {};  // nothing was added that was not there
  }
  const bool draft = !parts.parts.empty() && like.state == roi::PolygonState::Draft;
  const char* said = erases && parts.parts.empty() ? say::erased : draft && !erases ? say::painted : "";
  return replaced(std::move(parts), erases ? ReplaceReason::Erase : ReplaceReason::Brush, said);
}

Acts PolygonTool::combine(roi::SetOperation operation, const SlicePlane& plane) {
  message_ = {};
  if (state() == ToolState::Drawing || !selected_ || *selected_ >= contours_.polygons.size()) {
    message_ = {say::selectFirst, {}};
    return {};
  }
  const std::size_t index = *selected_;
  const roi::FlatRegion chosen = regionOf({index}, plane);
  std::vector<std::size_t> group = meeting(chosen.rings_mm, contours_.polygons[index].exclude, index, plane);
  if (group.empty()) {
    message_ = {say::meetsNone, {}};
    return {};
  }
  const roi::FlatRegion result = roi::combined(regionOf(group, plane), chosen, operation);
  const std::vector<std::size_t> others = group;
  group.push_back(index);
  std::sort(group.begin(), group.end());
  const bool unites = operation == roi::SetOperation::Union, takes = operation == roi::SetOperation::Difference;
  roi::Polygon like = polygonOf({}, plane, stateOf(unites ? group : others));
  like.exclude = contours_.polygons[index].exclude;
  Parts parts = partsOf(result, group, like, plane);
  if (parts.replaced.empty()) {
    message_ = {say::combinedAlready, {}};
    return {};
  }
  if (parts.parts.empty() && parts.replaced.size() == group.size()) {
    message_ = {say::nothingLeft, {}};
    return {};
  }
  return replaced(std::move(parts),
                  unites  ? ReplaceReason::Unite
                  : takes ? ReplaceReason::Subtract
                          : ReplaceReason::Intersect,
                  unites  ? say::united
                  : takes ? say::takenOut
                          : say::shared);
}

}  // namespace glisson::tools
