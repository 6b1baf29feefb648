// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <type_traits>
#include <variant>

#include "commands/add_polygon.h"
#include "commands/change_kind.h"
#include "commands/change_points.h"
#include "commands/change_state.h"
#include "commands/remove_polygon.h"
#include "commands/replace_polygons.h"
#include "tools/polygon_tool.h"

namespace glisson::session {

/// What undo would take back, for the menu.
inline const char* textOf(tools::ReplaceReason reason) {
  switch (reason) {
    case tools::ReplaceReason::Cut: return "cut outline";
    case tools::ReplaceReason::Brush: return "brush";
    case tools::ReplaceReason::Erase: return "erase";
    case tools::ReplaceReason::Unite: return "unite outlines";
    case tools::ReplaceReason::Subtract: return "take outline out";
    case tools::ReplaceReason::Intersect: return "keep common part";
  }
  return "";
}

/// The undoable command for what a gesture asks.
inline std::unique_ptr<commands::Command> commandOf(const tools::Act& act, const roi::ContourStack& contours) {
  return std::visit(
      [&contours](const auto& a) -> std::unique_ptr<commands::Command> {
        using A = std::decay_t<decltype(a)>;
        if constexpr (std::is_same_v<A, tools::AddPolygon>) {
          return std::make_unique<commands::AddPolygon>(a.polygon);
        } else if constexpr (std::is_same_v<A, tools::RemovePolygon>) {
          return std::make_unique<commands::RemovePolygon>(contours, a.index);
        } else if constexpr (std::is_same_v<A, tools::ChangeState>) {
          return std::make_unique<commands::ChangeState>(contours, a.index, a.state);
        } else if constexpr (std::is_same_v<A, tools::ChangeKind>) {
          return std::make_unique<commands::ChangeKind>(contours, a.index, a.exclude);
        } else if constexpr (std::is_same_v<A, tools::ReplacePolygons>) {
          return std::make_unique<commands::ReplacePolygons>(contours, a.indices, a.parts, textOf(a.reason));
        } else {
          const char* text = a.change == tools::PointsChange::Move     ? "move vertices"
                             : a.change == tools::PointsChange::Insert ? "insert vertex"
                             : a.change == tools::PointsChange::Sculpt ? "sculpt"
                             : a.change == tools::PointsChange::Nudge  ? "nudge"
                                                                       : "delete vertices";
          return std::make_unique<commands::ChangePoints>(contours, a.index, a.points_lps_mm, text, a.toDraft);
        }
      },
      act);
}

}  // namespace glisson::session
