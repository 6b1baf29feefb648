// SPDX-License-Identifier: GPL-3.0-or-later

// Outlines that are more than straight lines between clicks: livewire, spline, ellipse.
#include <algorithm>
#include <cmath>

#include "roi/set_operations.h"
#include "tools/outline.h"
#include "tools/polygon_tool.h"
#include "tools/shapes.h"

namespace glisson::tools {

namespace {

constexpr double mostOfIt = 0.95;  ///< of a livewire outline that its largest part holds where only its ends overlap

double leastSpacing(const SlicePlane& plane) {
  return plane.grid.spacing_mm.head<2>().minCoeff();
}

void append(Eigen::Matrix3Xd& line, const Eigen::Matrix3Xd& more) {
  line.conservativeResize(3, line.cols() + more.cols());
  line.rightCols(more.cols()) = more;
}

}  // namespace

void PolygonTool::setImage(std::shared_ptr<const image::ScalarVolume> image) {
  if (image == image_) return;
  image_ = std::move(image);
  stroke_.reset();
  paths_.reset();
  legs_.clear();
}

bool PolygonTool::followsImage(const SlicePlane& plane) const {
  return image_ && image_->grid.sameGeometry(plane.grid) && plane.slice >= 0 && plane.slice < plane.grid.size.z();
}

// Along the edges of the image, with both ends; a straight line where there is none.
Eigen::Matrix3Xd PolygonTool::pathBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                          const SlicePlane& plane) {
  Eigen::Matrix3Xd path(3, 2);
  path << from, to;
  if (!followsImage(plane)) return path;
  if (!paths_ || pathsSlice_ != plane.slice) {
    paths_.emplace(*image_, plane.slice);
    pathsSlice_ = plane.slice;
    pathsFrom_.reset();
  }
  const Eigen::Vector2d spacing = plane.grid.spacing_mm.head<2>();
  if (pathsFrom_ != from) {
    paths_->startAt(plane.toPlane_mm(from).cwiseQuotient(spacing));
    pathsFrom_ = from;
  }
  Outline flat = paths_->to(plane.toPlane_mm(to).cwiseQuotient(spacing));
  if (flat.cols() < 3) return path;
  for (Eigen::Index v = 0; v < flat.cols(); ++v) flat.col(v) = flat.col(v).cwiseProduct(spacing);
  flat.col(0) = plane.toPlane_mm(from);
  flat.rightCols(1) = plane.toPlane_mm(to);
  const std::vector<Eigen::Index> kept = simplify(flat, reach::simplify * leastSpacing(plane));
  path = plane.fromPlane(flat(Eigen::all, kept));
  path.col(0) = from;
  path.rightCols(1) = to;
  return path;
}

const Eigen::Matrix3Xd& PolygonTool::legBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                                const SlicePlane& plane) {
  const auto known =
      std::find_if(legs_.begin(), legs_.end(), [&](const Leg& leg) { return leg.from == from && leg.to == to; });
  if (known != legs_.end()) return known->path;
  legs_.push_back({from, to, pathBetween(from, to, plane)});
  return legs_.back().path;
}

Eigen::Matrix3Xd PolygonTool::spline(const Eigen::Matrix3Xd& through, const SlicePlane& plane) const {
  if (through.cols() < 3) return through;
  return plane.fromPlane(closedSpline(planePoints(through, plane), reach::smooth * leastSpacing(plane)));
}

void PolygonTool::updateCurve(const SlicePlane& plane) {
  if (!curved() || points_.cols() == 0) {
    curve_.resize(3, 0);
    outline_.resize(3, 0);
    return;
  }
  if (mode_ == ToolMode::Spline) {
    outline_ = spline(points_, plane);
    curve_ = outline_;
    if (pointer_ && !closes_) {
      Eigen::Matrix3Xd through(3, points_.cols() + 1);
      through << points_, *pointer_;
      curve_ = spline(through, plane);
    }
    // What the curve will be once it is closed.
    if (curve_.cols() > 2) append(curve_, Eigen::Vector3d(curve_.col(0)));
    return;
  }
  outline_ = points_.leftCols(1);
  for (Eigen::Index v = 0; v + 1 < points_.cols(); ++v) {
    const Eigen::Matrix3Xd& leg = legBetween(points_.col(v), points_.col(v + 1), plane);
    append(outline_, leg.rightCols(leg.cols() - 1));
  }
  curve_ = outline_;
  if (!pointer_) return;
  const Eigen::Matrix3Xd band =
      pathBetween(points_.rightCols(1), closes_ ? Eigen::Vector3d(points_.col(0)) : *pointer_, plane);
  append(curve_, band.rightCols(band.cols() - 1));
}

// The outline that closing makes of the clicked points.
Eigen::Matrix3Xd PolygonTool::closedOutline(const SlicePlane& plane) {
  if (!curved() || points_.cols() < 3) return points_;
  if (mode_ == ToolMode::Spline) return spline(points_, plane);
  updateCurve(plane);
  Eigen::Matrix3Xd outline = outline_;
  const Eigen::Matrix3Xd& last = legBetween(points_.rightCols(1), points_.col(0), plane);
  append(outline, last.middleCols(1, last.cols() - 2));
  const Outline flat = planePoints(outline, plane);
  if (!crossesItself(flat, true)) return outline;
  // Two ways along one edge overlap near the click between them: what they enclose there is no more than hairs.
  const std::vector<Outline> rings = roi::boundaryOf({flat}, [](const std::vector<bool>& in) { return in[0]; });
  const auto largest = std::max_element(rings.begin(), rings.end(), [](const Outline& a, const Outline& b) {
    return std::abs(signedArea(a)) < std::abs(signedArea(b));
  });
  double all = 0.0;
  for (const Outline& ring : rings) all += std::abs(signedArea(ring));
  if (largest == rings.end() || std::abs(signedArea(*largest)) < mostOfIt * all) return outline;
  return plane.fromPlane(*largest);
}

void PolygonTool::drawEllipse(const Pointer& at, const SlicePlane& plane) {
  const Outline ring = ellipse(plane.toPlane_mm(plane.toLps(pressed_px_)), plane.toPlane_mm(plane.toLps(at.px)),
                               at.modifiers.shift, reach::smooth * leastSpacing(plane));
  shape_.assign(ring.cols() > 0 ? 1 : 0, plane.fromPlane(ring));
}

}  // namespace glisson::tools
