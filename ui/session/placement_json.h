// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "session/placement.h"

namespace glisson::session {

inline nlohmann::json toJson(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}
inline Eigen::Vector3d vectorFromJson(const nlohmann::json& j) {
  return {j.at(0).get<double>(), j.at(1).get<double>(), j.at(2).get<double>()};
}

inline nlohmann::json toJson(const Placement& p) {
  nlohmann::json holds = nlohmann::json::array();
  for (const Placement::Hold& h : p.holds)
    holds.push_back({{"centre_lps_mm", toJson(h.centre_lps)}, {"edge_mm", h.edge_mm}});
  nlohmann::json j = {{"bar_axis", toJson(p.barAxis)}, {"hoist_direction", toJson(p.hoistDirection)}, {"holds", holds}};
  if (p.barAt_lps) j["bar_at_lps_mm"] = toJson(*p.barAt_lps);
  return j;
}

/// The reverse. Throws BadInput where bar and hoist are nearly parallel, nlohmann's exceptions for a missing key.
inline Placement placementFromJson(const nlohmann::json& j) {
  Placement p;
  if (j.contains("bar_at_lps_mm")) p.barAt_lps = vectorFromJson(j["bar_at_lps_mm"]);
  p.barAxis = vectorFromJson(j.at("bar_axis"));
  p.hoistDirection = vectorFromJson(j.at("hoist_direction"));
  for (const auto& h : j.at("holds"))
    p.holds.push_back({vectorFromJson(h.at("centre_lps_mm")), h.at("edge_mm").get<double>()});
  const double cross = p.barAxis.normalized().cross(p.hoistDirection.normalized()).norm();
  if (!(cross >= 0.1)) throw BadInput("the case's retractor lies along its own hoist; place it again");
  return p;
}

}  // namespace glisson::session
