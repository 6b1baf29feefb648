// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tools/slice_plane.h"

namespace glisson::tools {

/// A distance on a slice, LPS mm.
struct Distance {
  Eigen::Vector3d from_lps_mm = Eigen::Vector3d::Zero(), to_lps_mm = Eigen::Vector3d::Zero();
  double length_mm() const { return (to_lps_mm - from_lps_mm).norm(); }
};

/// Measures distances: press and drag, or click both ends. What was measured stays on its slice until it is removed,
/// the newest distances of all.
class MeasureTool {
 public:
  static constexpr std::size_t kept = 100;
  void press(const Eigen::Vector2d& px, const SlicePlane& plane);
  void move(const Eigen::Vector2d& px, const SlicePlane& plane);
  void release(const Eigen::Vector2d& px, const SlicePlane& plane);
  void cancel() { inWork_.reset(); }
  void removeLast();
  void clear();
  const std::vector<Distance>& distances() const { return distances_; }
  const std::optional<Distance>& inWork() const { return inWork_; }

 private:
  std::vector<Distance> distances_;
  std::optional<Distance> inWork_;
  Eigen::Vector2d pressed_px_ = Eigen::Vector2d::Zero();
  bool second_ = false;  ///< the first end was clicked, the second is awaited
};

}  // namespace glisson::tools
