// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "base/error.h"
#include "commands/outlines.h"

namespace glisson::session {

/// Marks of slices as in a case file: [{"slice": 3, "mark": "no-liver"}], slices counted from 0.
inline nlohmann::json marksToJson(const std::map<int, commands::SliceMark>& marks) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& [slice, mark] : marks)
    list.push_back({{"slice", slice}, {"mark", mark == commands::SliceMark::NoLiver ? "no-liver" : "no-wave"}});
  return list;
}

/// The reverse. Throws BadInput for another mark; nlohmann's exceptions for another shape.
inline std::map<int, commands::SliceMark> marksFromJson(const nlohmann::json& list) {
  std::map<int, commands::SliceMark> marks;
  for (const nlohmann::json& entry : list) {
    const auto word = entry.at("mark").get<std::string>();
    if (word != "no-liver" && word != "no-wave")
      throw BadInput("a slice is marked '" + word.substr(0, 40) + "'; marks are no-liver and no-wave");
    marks[entry.at("slice").get<int>()] =
        word == "no-liver" ? commands::SliceMark::NoLiver : commands::SliceMark::NoWave;
  }
  return marks;
}

inline constexpr std::array<std::pair<commands::MadeBy, const char*>, 3> madeByNames = {
    {{commands::MadeBy::Interpolation, "interpolated"},
     {commands::MadeBy::Proposal, "proposed"},
     {commands::MadeBy::Copy, "copied"}}};

/// What the program made among the outlines that are there: {"interpolated": ["00ab..."]}, sixteen hexadecimal digits
/// each.
inline nlohmann::json madeToJson(const commands::Outlines& outlines) {
  nlohmann::json made = nlohmann::json::object();
  for (const auto& [by, name] : madeByNames)
    for (const roi::Polygon& p : outlines.polygons) {
      if (outlines.madeBy(p) != by) continue;
      char digits[17];
      std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(commands::digestOf(p)));
      made[name].push_back(digits);
    }
  return made;
}

/// The reverse; what it does not know is left out. Throws nlohmann's exceptions for another shape.
inline std::map<std::uint64_t, commands::MadeBy> madeFromJson(const nlohmann::json& made) {
  std::map<std::uint64_t, commands::MadeBy> by;
  for (const auto& [what, name] : madeByNames)
    if (made.contains(name))
      for (const nlohmann::json& digits : made[name])
        by[std::strtoull(digits.get<std::string>().c_str(), nullptr, 16)] = what;
  return by;
}

}  // namespace glisson::session
