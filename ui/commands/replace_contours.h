// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <utility>

#include "commands/command.h"

namespace glisson::commands {

/// Takes another set of contours: an import, or a clean sheet. Marks of slices stay.
class ReplaceContours final : public Command {
 public:
  /// where: a point of the slice that undo shows; without it that of the middle polygon.
  ReplaceContours(const roi::ContourStack& before, roi::ContourStack after, std::string text,
                  std::optional<Eigen::Vector3d> where_lps_mm = std::nullopt)
      : before_(before), after_(std::move(after)), text_(std::move(text)), wanted_lps_mm_(std::move(where_lps_mm)) {}
  void apply(Outlines& contours) override { static_cast<roi::ContourStack&>(contours) = after_; }
  void revert(Outlines& contours) override { static_cast<roi::ContourStack&>(contours) = before_; }
  std::string text() const override { return text_; }
  Eigen::Vector3d where_lps_mm() const override {
    if (wanted_lps_mm_) return *wanted_lps_mm_;
    const roi::ContourStack& shown = after_.polygons.empty() ? before_ : after_;
    return shown.polygons.empty() ? Eigen::Vector3d::Zero()
                                  : centreOf(shown.polygons[shown.polygons.size() / 2].points_lps_mm);
  }

 private:
  roi::ContourStack before_, after_;
  std::string text_;
  std::optional<Eigen::Vector3d> wanted_lps_mm_;
};

}  // namespace glisson::commands
