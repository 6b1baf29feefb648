// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <utility>

#include "commands/command.h"

namespace glisson::commands {

/// Gives the region another name.
class Rename final : public Command {
 public:
  /// where: a point of the slice shown, LPS mm.
  Rename(const roi::ContourStack& contours, std::string name, Eigen::Vector3d where_lps_mm)
      : before_(contours.name), after_(std::move(name)), where_lps_mm_(std::move(where_lps_mm)) {}
  void apply(Outlines& contours) override { contours.name = after_; }
  void revert(Outlines& contours) override { contours.name = before_; }
  std::string text() const override { return "rename region"; }
  Eigen::Vector3d where_lps_mm() const override { return where_lps_mm_; }

 private:
  std::string before_, after_;
  Eigen::Vector3d where_lps_mm_;
};

}  // namespace glisson::commands
