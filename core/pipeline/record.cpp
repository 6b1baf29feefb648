#include "pipeline/detail/record.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "base/sha256.h"
#include "base/version.h"
#include "mechanics/static_solve.h"

namespace glisson::pipeline::detail {
namespace {

using Json = nlohmann::ordered_json;

Json toJson(const Eigen::Vector3d& v) {
  Json j = Json::array();
  for (int c = 0; c < 3; ++c) j.push_back(std::isfinite(v[c]) ? Json(v[c]) : Json(nullptr));
  return j;
}

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

Json resultToJson(const retraction::Result& r, const Scene& scene) {
  Json j;
  j["solver"] = solverToJson(r.solver);
  j["steps"] = r.steps;
  j["probes"] = Json::array();
  for (std::size_t i = 0; i < r.probe_u_mm.size(); ++i)
    j["probes"].push_back({{"p_mm", toJson(scene.outputs.probes_mm[i])}, {"u_mm", toJson(r.probe_u_mm[i])}});
  j["reaction_N"] = toJson(r.reaction_N);
  j["load_N"] = toJson(r.load_N);
  j["energy_J"] = r.energy_J;
  j["max_strain"] = r.max_strain;
  j["p95_strain"] = r.p95_strain;
  j["p99_strain"] = r.p99_strain;
  j["fraction_over_10pct_strain"] = r.fraction_over_10pct;
  j["max_rotation_deg"] = r.max_rotation_deg;
  j["max_displacement_mm"] = r.max_displacement_mm;
  j["linear_valid"] = r.linearTrusted;
  j["validity"] = r.validity;
  if (r.retractorPoint_mm) {
    j["retractor_point_mm"] = toJson(*r.retractorPoint_mm);
    j["contact_area_mm2"] = r.contactArea_mm2;
  }
  return j;
}

/// Digest of a file, or of all files of a folder in the order of their names' digests.
std::string digestOf(const std::filesystem::path& path) {
  if (std::filesystem::is_regular_file(path)) return sha256OfFile(path);
  std::vector<std::string> digests;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(path))
    if (entry.is_regular_file()) digests.push_back(sha256OfFile(entry.path()));
  std::sort(digests.begin(), digests.end());
  std::string all;
  for (const std::string& d : digests) all += d;
  return sha256(all.data(), all.size());
}

Json inputsToJson(const Scene& scene) {
  Json j = Json::object();
  auto add = [&](const char* what, const std::filesystem::path& p) {
    if (!p.empty()) j[what] = {{"sha256", digestOf(p)}};
  };
  add("mask", scene.geometry.file);
  add("mri", scene.geometry.kind == GeometrySpec::Kind::Mask ? scene.geometry.background : scene.geometry.mri);
  add("mre", scene.geometry.mre);
  add("roi", scene.geometry.roi);
  add("map", scene.material.map);
  return j;
}

/// The scene with every default written out, and no path: inputs are known by their digest.
Json parametersToJson(const Scene& scene) {
  Json j = Json::parse(pipeline::toJson(scene));
  for (const char* key : {"file", "mri", "mre", "roi"}) j["geometry"].erase(key);
  j["material"].erase("map");
  for (Json& s : j["supports"])
    if (s["region"].contains("mask")) s["region"]["mask"] = "(file)";
  for (Json& l : j["loads"])
    if (l.contains("region") && l["region"].contains("mask")) l["region"]["mask"] = "(file)";
  return j;
}

}  // namespace

std::string runRecord(const Scene& scene, const RunResult& r) {
  Json j;
  j["schema"] = "glisson/run/1";
  j["note"] = researchUseOnly;
  j["version"] = version();
  j["commit"] = buildCommit();
  j["plan"] = Json::array();
  for (const PlanStep& s : r.plan)
    j["plan"].push_back(
        {{"step", s.step}, {"needed", s.needed}, {"why", s.why}, {"seconds", s.seconds}, {"peak_MB", s.peak_MB}});
  j["model"] = {{"dofs", r.primary.dofs},
                {"cells", r.model.cells},
                {"volume_mL", r.model.volume_mL},
                {"mass_kg", r.model.mass_kg}};
  if (scene.setup.model.kind == retraction::ModelKind::Meshfree) {
    j["model"]["frames"] = r.primary.frames;
    j["model"]["frames_asked"] = scene.setup.model.meshfree.frames;
    j["model"]["notes"] = r.primary.notes;
  }
  j.update(resultToJson(r.primary, scene));
  if (r.discretisation) {
    const retraction::DiscretisationError& e = *r.discretisation;
    j["discretisation_error"] = {{"known", e.known}, {"note", e.note}};
    if (e.known) {
      j["discretisation_error"]["mean_mm"] = e.mean_mm;
      j["discretisation_error"]["p95_mm"] = e.p95_mm;
      j["discretisation_error"]["max_mm"] = e.max_mm;
    }
  }
  if (r.atlas) j["atlas"] = resultToJson(*r.atlas, scene);
  if (r.difference) {
    const comparison::Difference& d = *r.difference;
    j["difference"] = {{"mean_mm", d.mean_mm},
                       {"p95_mm", d.p95_mm},
                       {"max_mm", d.max_mm},
                       {"at_retractor_mm", d.at_retractor_mm},
                       {"clinically_significant", d.clinically_significant}};
    if (!d.vessel_mm.empty())
      j["difference"]["vessels"] = {{"landmarks", d.vessel_mm.size()},
                                    {"mean_mm", d.vesselMean_mm},
                                    {"p95_mm", d.vesselP95_mm},
                                    {"max_mm", d.vesselMax_mm},
                                    {"fraction_beyond_5mm", d.vesselFractionBeyond}};
  }
  if (r.stiffness) {
    const elastography::Statistics& s = r.stiffness->pooled;
    j["stiffness"] = {{"quantity", r.stiffness->quantity == StiffnessQuantity::Shear ? "shear" : "youngs"},
                      {"n", s.n},
                      {"n_before_mask", s.n_before_mask},
                      {"mean_kPa", s.mean_kPa},
                      {"median_kPa", s.median_kPa},
                      {"sd_kPa", s.sd_kPa}};
  }
  j["warnings"] = r.warnings;
  j["parameters"] = parametersToJson(scene);
  j["constants"] = {{"gravity_m_s2", defaults::gravity_m_s2},
                    {"clinically_significant_mm", defaults::clinicallySignificant.mm()},
                    {"confidence_threshold", defaults::confidenceThreshold}};
  j["inputs"] = inputsToJson(scene);
  j["seed"] = scene.setup.seed;
  j["threads"] = threadCount();
  Json files = Json::array();
  for (const auto& f : r.files) files.push_back(f.filename().string());
  j["files"] = files;
  return j.dump(1);
}

}  // namespace glisson::pipeline::detail
