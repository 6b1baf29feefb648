#pragma once

#include <utility>

#include "commands/command.h"

namespace glisson::commands {

/// Takes another set of contours: an import, or a clean sheet.
class ReplaceContours final : public Command {
 public:
  ReplaceContours(const roi::ContourStack& before, roi::ContourStack after, std::string text)
      : before_(before), after_(std::move(after)), text_(std::move(text)) {}
  void apply(roi::ContourStack& contours) override { contours = after_; }
  void revert(roi::ContourStack& contours) override { contours = before_; }
  std::string text() const override { return text_; }
  Eigen::Vector3d where_lps_mm() const override {
    const roi::ContourStack& shown = after_.polygons.empty() ? before_ : after_;
    return shown.polygons.empty() ? Eigen::Vector3d::Zero()
                                  : centreOf(shown.polygons[shown.polygons.size() / 2].points_lps_mm);
  }

 private:
  roi::ContourStack before_, after_;
  std::string text_;
};

}  // namespace glisson::commands
