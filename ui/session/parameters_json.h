#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "base/error.h"
#include "session/parameters.h"

namespace glisson::session {

inline constexpr std::array<std::pair<retraction::ModelKind, const char*>, 3> modelNames = {
    {{retraction::ModelKind::FemHex, "fem-hex"},
     {retraction::ModelKind::FemTet, "fem-tet"},
     {retraction::ModelKind::Meshfree, "meshfree"}}};

inline std::string nameOf(retraction::ModelKind kind) {
  for (const auto& [k, name] : modelNames)
    if (k == kind) return name;
  return modelNames.front().second;
}

inline retraction::ModelKind modelNamed(const std::string& name) {
  for (const auto& [kind, n] : modelNames)
    if (n == name) return kind;
  throw BadInput("the case asks for the model '" + name.substr(0, 40) + "', which this version does not know");
}

/// Every parameter with its unit in its key.
inline nlohmann::json toJson(const Parameters& p) {
  return {{"poisson", p.poisson},
          {"density_kg_m3", p.density_kg_m3},
          {"model", nameOf(p.model)},
          {"cell_mm", p.cell_mm},
          {"frames", p.frames},
          {"use_mre", p.useMre},
          {"atlas_shear_kPa", p.atlasShear_kPa},
          {"retractor_diameter_mm", p.retractorDiameter_mm},
          {"retractor_length_mm", p.retractorLength_mm},
          {"retractor_spread_mm", p.retractorSpread_mm},
          {"force_is_weight", p.forceIsWeight},
          {"force_N", p.force_N},
          {"abdomen_kPa_per_mm", p.abdomen_kPa_per_mm}};
}

/// The reverse. Throws nlohmann's exceptions for a missing key or another type.
inline Parameters parametersFromJson(const nlohmann::json& j) {
  Parameters p;
  p.poisson = j.at("poisson").get<double>();
  p.density_kg_m3 = j.at("density_kg_m3").get<double>();
  p.model = modelNamed(j.at("model").get<std::string>());
  p.cell_mm = j.at("cell_mm").get<double>();
  p.frames = j.at("frames").get<int>();
  p.useMre = j.at("use_mre").get<bool>();
  p.atlasShear_kPa = j.at("atlas_shear_kPa").get<double>();
  p.retractorDiameter_mm = j.at("retractor_diameter_mm").get<double>();
  p.retractorLength_mm = j.at("retractor_length_mm").get<double>();
  p.retractorSpread_mm = j.at("retractor_spread_mm").get<double>();
  p.forceIsWeight = j.at("force_is_weight").get<bool>();
  p.force_N = j.at("force_N").get<double>();
  p.abdomen_kPa_per_mm = j.at("abdomen_kPa_per_mm").get<double>();
  return p;
}

}  // namespace glisson::session
