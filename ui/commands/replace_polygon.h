// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "commands/command.h"

namespace glisson::commands {

/// One polygon gives way to parts of it: the first takes its place, the others come last.
class ReplacePolygon final : public Command {
 public:
  /// index: of contours.polygons, in range. parts: at least one.
  ReplacePolygon(const roi::ContourStack& contours, std::size_t index, std::vector<roi::Polygon> parts)
      : index_(index), before_(contours.polygons.at(index)), parts_(std::move(parts)) {}
  void apply(Outlines& contours) override {
    contours.polygons.at(index_) = parts_.front();
    contours.polygons.insert(contours.polygons.end(), parts_.begin() + 1, parts_.end());
  }
  void revert(Outlines& contours) override {
    contours.polygons.resize(contours.polygons.size() - (parts_.size() - 1));
    contours.polygons.at(index_) = before_;
  }
  std::string text() const override { return "cut outline"; }
  Eigen::Vector3d where_lps_mm() const override { return centreOf(before_.points_lps_mm); }

 private:
  std::size_t index_;
  roi::Polygon before_;
  std::vector<roi::Polygon> parts_;
};

}  // namespace glisson::commands
