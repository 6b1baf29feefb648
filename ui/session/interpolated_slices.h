// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <variant>

#include "commands/replace_contours.h"
#include "session/act_command.h"
#include "tools/slice_plane.h"

namespace glisson::session {

/// One undo step for an act that touches a slice with interpolated outlines.
struct SettledAct {
  std::unique_ptr<commands::Command> command;
  std::optional<std::size_t> selected;  ///< the act's polygon among the polygons as they will be
};

/// What an act means for the interpolated outlines of its slice: they are accepted together with the one among them
/// that is accepted or corrected, and give way to an outline that is drawn there and accepted. Empty where the act has
/// no say over interpolated outlines.
inline std::optional<SettledAct> settleInterpolated(const tools::Act& act, const roi::ContourStack& contours,
                                                    const image::Grid& grid) {
  using roi::PolygonState;
  std::optional<std::size_t> index;
  bool replaces = false;
  if (const auto* added = std::get_if<tools::AddPolygon>(&act)) {
    if (added->polygon.state != PolygonState::Accepted) return std::nullopt;
    index = contours.polygons.size();
    replaces = true;
  } else if (const auto* changed = std::get_if<tools::ChangeState>(&act)) {
    if (changed->state != PolygonState::Accepted) return std::nullopt;
    index = changed->index;
    replaces = contours.polygons.at(*index).state == PolygonState::Draft;
  } else if (const auto* moved = std::get_if<tools::ChangePoints>(&act)) {
    if (contours.polygons.at(moved->index).state != PolygonState::Interpolated) return std::nullopt;
    index = moved->index;
  } else if (const auto* made = std::get_if<tools::ReplacePolygons>(&act)) {
    if (made->parts.empty() || made->indices.empty()) return std::nullopt;
    const bool any = std::any_of(made->indices.begin(), made->indices.end(), [&](std::size_t i) {
      return contours.polygons.at(i).state == PolygonState::Interpolated;
    });
    if (!any || made->parts.front().state == PolygonState::Draft) return std::nullopt;
    index = made->indices.front();
  } else {
    return std::nullopt;
  }
  const std::unique_ptr<commands::Command> alone = commandOf(act, contours);
  commands::Outlines after;
  static_cast<roi::ContourStack&>(after) = contours;
  alone->apply(after);
  const int slice = tools::sliceOf(after.polygons[*index], grid);
  bool any = false;
  for (std::size_t p = after.polygons.size(); p-- > 0;) {
    roi::Polygon& polygon = after.polygons[p];
    if (polygon.state != PolygonState::Interpolated || tools::sliceOf(polygon, grid) != slice) continue;
    any = true;
    if (replaces && p != *index) {
      after.polygons.erase(after.polygons.begin() + static_cast<std::ptrdiff_t>(p));
      if (p < *index) --*index;
    } else {
      polygon.state = PolygonState::Accepted;
    }
  }
  if (!any) return std::nullopt;
  return SettledAct{
      std::make_unique<commands::ReplaceContours>(contours, std::move(after), alone->text(), alone->where_lps_mm()),
      index};
}

/// Where a reader's outlines stand, slice by slice.
struct OutlineCoverage {
  std::set<int> drawn, interpolated;  ///< slices with accepted outlines; with interpolated ones only
  std::set<int> empty;                ///< slices between the first and the last of these that hold none
  std::set<int> drafts;               ///< slices with outlines that do not count, beside others or alone
};

inline OutlineCoverage coverageOf(const roi::ContourStack& contours, const image::Grid& grid) {
  OutlineCoverage c;
  for (const roi::Polygon& p : contours.polygons) {
    if (p.points_lps_mm.cols() == 0) continue;
    if (p.state == roi::PolygonState::Draft) c.drafts.insert(tools::sliceOf(p, grid));
    if (p.exclude || p.state == roi::PolygonState::Draft) continue;
    (p.state == roi::PolygonState::Accepted ? c.drawn : c.interpolated).insert(tools::sliceOf(p, grid));
  }
  for (const int k : c.drawn) c.interpolated.erase(k);
  std::set<int> all = c.drawn;
  all.insert(c.interpolated.begin(), c.interpolated.end());
  if (!all.empty())
    for (int k = *all.begin(); k < *all.rbegin(); ++k)
      if (!all.contains(k)) c.empty.insert(k);
  return c;
}

/// What made the outlines that count, by slice: the slices that nobody has drawn, accepted or not.
inline std::map<int, commands::MadeBy> madeSlices(const commands::Outlines& contours, const image::Grid& grid) {
  std::map<int, commands::MadeBy> made;
  std::set<int> byHand;
  for (const roi::Polygon& p : contours.polygons) {
    if (p.exclude || p.points_lps_mm.cols() == 0 || p.state == roi::PolygonState::Draft) continue;
    if (const auto by = contours.madeBy(p))
      made[tools::sliceOf(p, grid)] = *by;
    else
      byHand.insert(tools::sliceOf(p, grid));
  }
  for (const int k : byHand) made.erase(k);
  return made;
}

}  // namespace glisson::session
