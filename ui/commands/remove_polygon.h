// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <utility>

#include "commands/command.h"

namespace glisson::commands {

/// Takes a polygon out; undo puts it back in its place.
class RemovePolygon final : public Command {
 public:
  /// index: of contours.polygons, in range.
  RemovePolygon(const roi::ContourStack& contours, std::size_t index)
      : index_(index), polygon_(contours.polygons.at(index)) {}
  void apply(Outlines& contours) override {
    contours.polygons.erase(contours.polygons.begin() + static_cast<std::ptrdiff_t>(index_));
  }
  void revert(Outlines& contours) override {
    contours.polygons.insert(contours.polygons.begin() + static_cast<std::ptrdiff_t>(index_), polygon_);
  }
  std::string text() const override { return "delete outline"; }
  Eigen::Vector3d where_lps_mm() const override { return centreOf(polygon_.points_lps_mm); }

 private:
  std::size_t index_;
  roi::Polygon polygon_;
};

}  // namespace glisson::commands
