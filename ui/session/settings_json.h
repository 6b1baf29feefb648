// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <nlohmann/json.hpp>

#include "session/parameters_json.h"
#include "session/settings.h"

namespace glisson::session {

/// Puts the choices into the object that says which patient it is.
inline void putChoices(const Choices& choices, nlohmann::json& patient) {
  if (!choices.files.empty()) patient["files"] = choices.files;
  patient["roles"] = nlohmann::json::object();
  for (const auto& [uid, role] : choices.roles) patient["roles"][uid] = dicom::name(role);
  if (choices.together) patient["together"] = *choices.together;
  if (choices.unit)
    patient["elastogram"] = {{"quantity", choices.quantity == StiffnessQuantity::Youngs ? "youngs" : "shear"},
                             {"unit", *choices.unit}};
  if (choices.otherFrame) patient["other_frame"] = true;
}

/// The reverse. Throws BadInput for a role that is not known, nlohmann's exceptions for another shape.
inline Choices choicesFromJson(const nlohmann::json& patient) {
  Choices choices;
  choices.files = patient.value("files", std::vector<std::string>());
  for (const auto& [uid, role] : patient.at("roles").items())
    choices.roles[uid] = dicom::roleNamed(role.get<std::string>());
  if (patient.contains("together")) choices.together = patient["together"].get<bool>();
  if (patient.contains("elastogram")) {
    const nlohmann::json& map = patient["elastogram"];
    choices.quantity =
        map.at("quantity").get<std::string>() == "youngs" ? StiffnessQuantity::Youngs : StiffnessQuantity::Shear;
    choices.unit = map.at("unit").get<std::string>();
  }
  choices.otherFrame = patient.value("other_frame", false);
  return choices;
}

inline nlohmann::json toJson(const MeasureSettings& m) {
  return {{"inner_roi", m.innerRoi}, {"erosion_pixels", m.erosion_pixels}, {"without_vessels", m.vessels}};
}

inline MeasureSettings measureFromJson(const nlohmann::json& j) {
  return {j.at("inner_roi").get<bool>(), std::clamp(j.at("erosion_pixels").get<int>(), 0, 50),
          j.value("without_vessels", false)};
}

}  // namespace glisson::session
