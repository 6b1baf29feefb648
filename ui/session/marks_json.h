// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>

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

}  // namespace glisson::session
