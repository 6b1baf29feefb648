// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "commands/command.h"

namespace glisson::commands {

/// Makes a polygon one that counts, or one that is left out.
class ChangeKind final : public Command {
 public:
  /// index: of contours.polygons, in range.
  ChangeKind(const roi::ContourStack& contours, std::size_t index, bool exclude)
      : index_(index),
        before_(contours.polygons.at(index).exclude),
        after_(exclude),
        where_lps_mm_(centreOf(contours.polygons.at(index).points_lps_mm)) {}
  void apply(Outlines& contours) override { contours.polygons.at(index_).exclude = after_; }
  void revert(Outlines& contours) override { contours.polygons.at(index_).exclude = before_; }
  std::string text() const override { return after_ ? "exclude outline" : "include outline"; }
  Eigen::Vector3d where_lps_mm() const override { return where_lps_mm_; }

 private:
  std::size_t index_;
  bool before_, after_;
  Eigen::Vector3d where_lps_mm_;
};

}  // namespace glisson::commands
