// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/detail/result_json.h"

#include <cmath>

#include "mechanics/measures.h"
#include "mechanics/static_solve.h"
#include "retraction/contact_path.h"
#include "retraction/ligaments.h"

namespace glisson::pipeline::detail {

using Json = nlohmann::ordered_json;

Json vectorToJson(const Eigen::Vector3d& v) {
  Json j = Json::array();
  for (int c = 0; c < 3; ++c) j.push_back(std::isfinite(v[c]) ? Json(v[c]) : Json(nullptr));
  return j;
}

Json diagnosticToJson(const Diagnostic& d) {
  Json arguments = Json::object();
  for (const auto& [key, value] : d.arguments) std::visit([&, k = key](const auto& v) { arguments[k] = v; }, value);
  return {{"code", nameOf(d.code)},
          {"severity", nameOf(d.severity())},
          {"text", d.text()},
          {"arguments", std::move(arguments)}};
}

namespace {

Json solverToJson(const mechanics::SolveReport& s) {
  return {{"kind", s.kind},
          {"why", s.why},
          {"iterations", s.iterations},
          {"residual", s.residual},
          {"tolerance", s.tolerance},
          {"converged", s.converged()},
          {"status", mechanics::describe(s.status)},
          {"seconds", s.seconds}};
}

Json contactToJson(const retraction::RigidContact& c) {
  Json path = Json::array();
  for (const auto& step : c.path) path.push_back({step[0], step[1]});
  return {{"travel_mm", c.travel_mm},
          {"capacity_N", c.capacityExceeded ? Json(c.capacity_N) : Json(nullptr)},
          {"capacity_travel_mm", c.capacityExceeded ? Json(c.capacityAt_mm) : Json(nullptr)},
          {"slipped", c.slipped()},
          {"force_N", vectorToJson(c.force_N)},
          {"force_along_hoist_N", c.force_N.dot(c.hoist)},
          {"resultant_N", c.force_N.norm()},
          {"moment_Nm", vectorToJson(c.moment_Nm)},
          {"area_mm2", c.area_mm2},
          {"footprint_mm2", c.footprint_mm2},
          {"pressure_max_kPa", c.pressureMax_kPa},
          {"penetration_max_mm", c.penetrationMax_mm},
          {"least_volume_ratio", c.smallestJ},
          {"path", path}};
}

/// Null: no retractor, no landmarks.
Json gapToJson(const std::optional<retraction::LinearGap>& found, bool converged) {
  retraction::LinearGap gap;
  gap.why = converged ? "a study that measures errors itself left it out"
                      : "there is no answer to compare linear theory with";
  if (found) gap = *found;
  Json j;
  j["known"] = gap.known;
  j["stable"] = gap.stability == mechanics::Stability::Unknown ? Json(nullptr)
                                                               : Json(gap.stability == mechanics::Stability::Stable);
  if (!gap.known) {
    j["why"] = gap.why;
    return j;
  }
  j["mean"] = gap.mean_mm;
  j["max"] = gap.max_mm;
  j["at_retractor"] = gap.at_retractor_mm ? Json(*gap.at_retractor_mm) : Json(nullptr);
  j["landmarks_max"] = gap.landmarks_max_mm ? Json(*gap.landmarks_max_mm) : Json(nullptr);
  return j;
}

}  // namespace

Json resultToJson(const retraction::Result& r, const Scene& scene) {
  Json j;
  j["solver"] = solverToJson(r.solver);
  j["steps"] = r.steps;
  j["probes"] = Json::array();
  for (std::size_t i = 0; i < r.probe_u_mm.size(); ++i)
    j["probes"].push_back(
        {{"p_mm", vectorToJson(scene.outputs.probes_mm[i])}, {"u_mm", vectorToJson(r.probe_u_mm[i])}});
  j["reaction_N"] = vectorToJson(r.reaction_N);
  j["load_N"] = vectorToJson(r.load_N);
  j["energy_J"] = r.energy_J;
  j["max_strain"] = r.max_strain;
  j["p95_strain"] = r.p95_strain;
  j["p99_strain"] = r.p99_strain;
  j["fraction_over_10pct_strain"] = r.fraction_over_10pct;
  j["max_rotation_deg"] = r.max_rotation_deg;
  j["max_displacement_mm"] = r.max_displacement_mm;
  if (r.contact)
    j["strain_measured"] = {{"least_covered_fraction", mechanics::leastCovered}, {"cells_left_out", r.cellsLeftOut}};
  j["linear_valid"] = retraction::linearValid(r);
  j["kinematics_valid"] = retraction::kinematicsValid(r);
  j["linear_gap_mm"] = gapToJson(r.linearGap, r.solver.converged());
  j["drawable"] = r.drawable;
  j["validity"] = r.validity;
  j["validity_diagnostics"] = Json::array();
  for (const Diagnostic& d : r.doubts) j["validity_diagnostics"].push_back(diagnosticToJson(d));
  if (r.retractorPoint_mm) {
    j["retractor_point_mm"] = vectorToJson(*r.retractorPoint_mm);
    j["contact_area_mm2"] = r.contactArea_mm2;
  }
  if (r.contact) j["contact"] = contactToJson(*r.contact);
  for (const retraction::LigamentPull& l : r.ligaments)
    j["ligaments"].push_back({{"name", retraction::nameOf(l.name)},
                              {"stiffness_N_per_mm", l.stiffness_N_per_mm},
                              {"force_N", vectorToJson(l.force_N)}});
  return j;
}

}  // namespace glisson::pipeline::detail
