// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <utility>

#include "commands/command.h"

namespace glisson::commands {

/// Gives a polygon other vertices: moved, inserted or deleted ones.
class ChangePoints final : public Command {
 public:
  /// index: of contours.polygons, in range. points: 3 × n LPS mm. text: "move vertices", ... toDraft: the outline has
  /// to be accepted anew.
  ChangePoints(const roi::ContourStack& contours, std::size_t index, Eigen::Matrix3Xd points_lps_mm, std::string text,
               bool toDraft = false)
      : index_(index),
        before_(contours.polygons.at(index).points_lps_mm),
        after_(std::move(points_lps_mm)),
        stateBefore_(contours.polygons.at(index).state),
        stateAfter_(toDraft ? roi::PolygonState::Draft : stateBefore_),
        text_(std::move(text)) {}
  void apply(Outlines& contours) override { set(contours, after_, stateAfter_); }
  void revert(Outlines& contours) override { set(contours, before_, stateBefore_); }
  std::string text() const override { return text_; }
  Eigen::Vector3d where_lps_mm() const override { return centreOf(after_); }

 private:
  void set(Outlines& contours, const Eigen::Matrix3Xd& points, roi::PolygonState state) {
    contours.polygons.at(index_).points_lps_mm = points;
    contours.polygons.at(index_).state = state;
  }
  std::size_t index_;
  Eigen::Matrix3Xd before_, after_;
  roi::PolygonState stateBefore_, stateAfter_;
  std::string text_;
};

}  // namespace glisson::commands
