// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "session/parameters.h"
#include "session/placement_json.h"

namespace glisson::session {

/// Every parameter with its unit in its key.
inline nlohmann::json toJson(const Parameters& p) {
  return {{"poisson", p.poisson},
          {"density_kg_m3", p.density_kg_m3},
          {"model", nameIn(methodNames, p.method)},
          {"cell_mm", p.cell_mm},
          {"frames", p.frames},
          {"tet_edge_mm", p.tetEdge_mm},
          {"tet_tool_edge_mm", p.tetToolEdge_mm},
          {"kinematics", nameIn(kinematicsNames, p.kinematics)},
          {"solver", nameIn(solverNames, p.solver)},
          {"dynamic", p.dynamic},
          {"step_ms", p.step_ms},
          {"end_s", p.end_s},
          {"register_rigidly", p.registerRigidly},
          {"how_sure", p.howSure},
          {"use_mre", p.useMre},
          {"atlas_shear_kPa", p.atlasShear_kPa},
          {"retractor_diameter_mm", p.retractorDiameter_mm},
          {"retractor_length_mm", p.retractorLength_mm},
          {"retractor_spread_mm", p.retractorSpread_mm},
          {"contact", nameIn(contactNames, p.contact)},
          {"shape", nameIn(shapeNames, p.shape)},
          {"drive", nameIn(driveNames, p.drive)},
          {"force_N", p.force_N},
          {"travel_mm", p.travel_mm},
          {"capsule", p.capsule},
          {"capsule_N_per_mm", p.capsule_N_per_mm},
          {"abdomen_kPa_per_mm", p.abdomen_kPa_per_mm},
          {"placement", toJson(p.placement)}};
}

/// How the bar meets the liver. A case of before this could be set has the linear patch of its time, without a capsule.
inline void readContact(const nlohmann::json& j, Parameters& p) {
  p.contact = named(contactNames, j.value("contact", nameIn(contactNames, retraction::ContactKind::Patch)), "contact");
  p.shape = named(shapeNames, j.value("shape", nameIn(shapeNames, p.shape)), "shape");
  const Drive before = j.value("force_is_weight", true) ? Drive::LiverWeight : Drive::Force;
  p.drive = named(driveNames, j.value("drive", nameIn(driveNames, before)), "drive");
  p.travel_mm = j.value("travel_mm", p.travel_mm);
  p.capsule = j.value("capsule", false);
  p.capsule_N_per_mm = j.value("capsule_N_per_mm", p.capsule_N_per_mm);
}

/// The reverse. Throws BadInput for a choice that is not known, nlohmann's exceptions for a missing key or another
/// type.
inline Parameters parametersFromJson(const nlohmann::json& j) {
  Parameters p;
  p.poisson = j.at("poisson").get<double>();
  p.density_kg_m3 = j.at("density_kg_m3").get<double>();
  p.method = named(methodNames, j.at("model").get<std::string>(), "model");
  p.cell_mm = j.at("cell_mm").get<double>();
  p.frames = j.at("frames").get<int>();
  // Cases of before these could be set have the defaults.
  p.tetEdge_mm = j.value("tet_edge_mm", p.tetEdge_mm);
  p.tetToolEdge_mm = j.value("tet_tool_edge_mm", p.tetToolEdge_mm);
  p.kinematics = named(kinematicsNames, j.value("kinematics", nameIn(kinematicsNames, retraction::Kinematics::Linear)),
                       "kinematics");
  p.solver = named(solverNames, j.value("solver", nameIn(solverNames, p.solver)), "solver");
  p.dynamic = j.value("dynamic", p.dynamic);
  p.step_ms = j.value("step_ms", p.step_ms);
  p.end_s = j.value("end_s", p.end_s);
  p.registerRigidly = j.value("register_rigidly", p.registerRigidly);
  p.howSure = j.value("how_sure", p.howSure);
  p.useMre = j.at("use_mre").get<bool>();
  p.atlasShear_kPa = j.at("atlas_shear_kPa").get<double>();
  p.retractorDiameter_mm = j.at("retractor_diameter_mm").get<double>();
  p.retractorLength_mm = j.at("retractor_length_mm").get<double>();
  p.retractorSpread_mm = j.at("retractor_spread_mm").get<double>();
  p.force_N = j.at("force_N").get<double>();
  readContact(j, p);
  p.abdomen_kPa_per_mm = j.at("abdomen_kPa_per_mm").get<double>();
  if (j.contains("placement")) p.placement = placementFromJson(j["placement"]);
  return p;
}

}  // namespace glisson::session
