// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "commands/command.h"

namespace glisson::commands {

/// Polygons give way to others: those that come first take their places, what is more comes last; places without a
/// successor go.
class ReplacePolygons final : public Command {
 public:
  /// indices: of contours.polygons, in range, ascending. parts: at least one where there are no indices. text: "cut
  /// outline", ...
  ReplacePolygons(const roi::ContourStack& contours, std::vector<std::size_t> indices, std::vector<roi::Polygon> parts,
                  std::string text)
      : indices_(std::move(indices)), parts_(std::move(parts)), text_(std::move(text)) {
    for (const std::size_t index : indices_) before_.push_back(contours.polygons.at(index));
  }
  void apply(Outlines& contours) override {
    const std::size_t both = std::min(indices_.size(), parts_.size());
    for (std::size_t n = 0; n < both; ++n) contours.polygons.at(indices_[n]) = parts_[n];
    for (std::size_t n = indices_.size(); n-- > both;)
      contours.polygons.erase(contours.polygons.begin() + static_cast<std::ptrdiff_t>(indices_[n]));
    contours.polygons.insert(contours.polygons.end(), parts_.begin() + static_cast<std::ptrdiff_t>(both), parts_.end());
  }
  void revert(Outlines& contours) override {
    const std::size_t both = std::min(indices_.size(), parts_.size());
    contours.polygons.resize(contours.polygons.size() - (parts_.size() - both));
    for (std::size_t n = both; n < indices_.size(); ++n)
      contours.polygons.insert(contours.polygons.begin() + static_cast<std::ptrdiff_t>(indices_[n]), before_[n]);
    for (std::size_t n = 0; n < both; ++n) contours.polygons.at(indices_[n]) = before_[n];
  }
  std::string text() const override { return text_; }
  Eigen::Vector3d where_lps_mm() const override {
    return centreOf((before_.empty() ? parts_ : before_).front().points_lps_mm);
  }

 private:
  std::vector<std::size_t> indices_;
  std::vector<roi::Polygon> before_, parts_;
  std::string text_;
};

}  // namespace glisson::commands
