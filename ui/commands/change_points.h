#pragma once

#include <cstddef>
#include <utility>

#include "commands/command.h"

namespace glisson::commands {

/// Gives a polygon other vertices: moved, inserted or deleted ones.
class ChangePoints final : public Command {
 public:
  /// index: of contours.polygons, in range. points: 3 × n LPS mm. text: "move vertices", ...
  ChangePoints(const roi::ContourStack& contours, std::size_t index, Eigen::Matrix3Xd points_lps_mm, std::string text)
      : index_(index),
        before_(contours.polygons.at(index).points_lps_mm),
        after_(std::move(points_lps_mm)),
        text_(std::move(text)) {}
  void apply(Outlines& contours) override { contours.polygons.at(index_).points_lps_mm = after_; }
  void revert(Outlines& contours) override { contours.polygons.at(index_).points_lps_mm = before_; }
  std::string text() const override { return text_; }
  Eigen::Vector3d where_lps_mm() const override { return centreOf(after_); }

 private:
  std::size_t index_;
  Eigen::Matrix3Xd before_, after_;
  std::string text_;
};

}  // namespace glisson::commands
