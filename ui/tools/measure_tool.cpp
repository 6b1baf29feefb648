// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/measure_tool.h"

#include "tools/polygon_tool.h"

namespace glisson::tools {

void MeasureTool::press(const Eigen::Vector2d& px, const SlicePlane& plane) {
  pressed_px_ = px;
  if (inWork_) {
    second_ = true;
    inWork_->to_lps_mm = plane.toLps(px);
  } else {
    second_ = false;
    inWork_ = Distance{plane.toLps(px), plane.toLps(px)};
  }
}

void MeasureTool::move(const Eigen::Vector2d& px, const SlicePlane& plane) {
  if (inWork_) inWork_->to_lps_mm = plane.toLps(px);
}

void MeasureTool::release(const Eigen::Vector2d& px, const SlicePlane& plane) {
  if (!inWork_) return;
  inWork_->to_lps_mm = plane.toLps(px);
  const bool dragged = (px - pressed_px_).norm() > reach::drag_px;
  if (!dragged && !second_) return;  // the first of two clicks
  if (inWork_->length_mm() > 0.0) distances_.push_back(*inWork_);
  if (distances_.size() > kept) distances_.erase(distances_.begin());
  inWork_.reset();
}

void MeasureTool::removeLast() {
  if (inWork_)
    inWork_.reset();
  else if (!distances_.empty())
    distances_.pop_back();
}

void MeasureTool::clear() {
  inWork_.reset();
  distances_.clear();
}

}  // namespace glisson::tools
