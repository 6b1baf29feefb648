// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "commands/command.h"

namespace glisson::commands {

/// Accepts a polygon, or makes a draft of it again.
class ChangeState final : public Command {
 public:
  /// index: of contours.polygons, in range.
  ChangeState(const roi::ContourStack& contours, std::size_t index, roi::PolygonState state)
      : index_(index),
        before_(contours.polygons.at(index).state),
        after_(state),
        where_lps_mm_(centreOf(contours.polygons.at(index).points_lps_mm)) {}
  void apply(Outlines& contours) override { contours.polygons.at(index_).state = after_; }
  void revert(Outlines& contours) override { contours.polygons.at(index_).state = before_; }
  std::string text() const override {
    return after_ == roi::PolygonState::Accepted ? "accept outline" : "make outline a draft";
  }
  Eigen::Vector3d where_lps_mm() const override { return where_lps_mm_; }

 private:
  std::size_t index_;
  roi::PolygonState before_, after_;
  Eigen::Vector3d where_lps_mm_;
};

}  // namespace glisson::commands
