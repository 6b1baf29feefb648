// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>

#include "commands/command.h"

namespace glisson::commands {

/// Appends a polygon.
class AddPolygon final : public Command {
 public:
  explicit AddPolygon(roi::Polygon polygon) : polygon_(std::move(polygon)) {}
  void apply(Outlines& contours) override { contours.polygons.push_back(polygon_); }
  void revert(Outlines& contours) override { contours.polygons.pop_back(); }
  std::string text() const override {
    return polygon_.state == roi::PolygonState::Draft ? "add draft outline" : "add outline";
  }
  Eigen::Vector3d where_lps_mm() const override { return centreOf(polygon_.points_lps_mm); }

 private:
  roi::Polygon polygon_;
};

}  // namespace glisson::commands
