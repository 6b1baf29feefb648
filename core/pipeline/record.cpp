// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/detail/record.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "base/quantity_names.h"
#include "base/sha256.h"
#include "base/version.h"
#include "pipeline/detail/result_json.h"
#include "pipeline/detail/told.h"
#include "pipeline/detail/uncertainty_record.h"

namespace glisson::pipeline::detail {
namespace {

using Json = nlohmann::ordered_json;

Json poseToJson(const retraction::PlacedBar& placed) {
  Json j = {{"centre_mm", vectorToJson(*placed.bar.at_mm)},
            {"axis", vectorToJson(*placed.bar.axis)},
            {"bears", placed.tried.empty() ? Json(nullptr) : Json(placed.bears)}};
  if (placed.pose) {
    j["height_mm"] = placed.pose->height_mm;
    j["covered_mm"] = placed.pose->covered_mm;
    j["thickness_mm"] = placed.pose->thickness_mm;
    j["slope"] = placed.pose->slope;
  }
  j["tried"] = Json::array();
  for (const auto& t : placed.tried) j["tried"].push_back({{"height_mm", t.height_mm}, {"borne", t.borne}});
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

/// Everything of the record that depends on the folder the run was written into.
void nameFiles(Json& j, const std::vector<std::filesystem::path>& files, render::Palette palette) {
  j["palette"] = palette == render::Palette::RedBlue ? "red-blue" : "colour-blind";
  j["outputs"] = Json::array();
  j["files"] = Json::array({"run.json"});
  for (const auto& f : files) {
    j["outputs"].push_back({{"file", f.filename().string()}, {"sha256", sha256OfFile(f)}});
    j["files"].push_back(f.filename().string());
  }
}

/// The means at the retractor and at the vessels, of an estimate of errors.
template <class Errors>
void addPlaces(const Errors& e, Json& j) {
  if (e.at_retractor_mm) j["at_retractor_mm"] = *e.at_retractor_mm;
  if (e.vessels_mm) j["vessels_mm"] = *e.vessels_mm;
  if (e.vesselsMax_mm) j["vessels_max_mm"] = *e.vesselsMax_mm;
}

const char* wordOf(Significance s) {
  return s == Significance::Open ? "open" : s == Significance::Beyond ? "beyond" : "below";
}

Json differenceToJson(const comparison::Difference& d) {
  Json j = {{"mean_mm", d.mean_mm},
            {"p95_mm", d.p95_mm},
            {"max_mm", d.max_mm},
            {"at_retractor_mm", d.at_retractor_mm},
            {"clinically_significant", d.clinically_significant}};
  if (d.travel_mm) {
    j["travel_mm"] = *d.travel_mm;
    j["window_at_rest_mm"] = *d.window_at_rest_mm;
    j["contact_mean_mm"] = *d.contact_mean_mm;
    j["equal_lift"] = {{"travel_mm", d.equal_lift->travel_mm},
                       {"force_N", d.equal_lift->force_N},
                       {"atlas_force_N", d.equal_lift->other_force_N},
                       {"along", d.equal_lift->alongPath ? "path on coarse cells" : "the answers"}};
  }
  return j;
}

Json motionToJson(const retraction::Model& model, const retraction::Result& r) {
  const Motion m = motionOf(model, r);
  return {
      {"mean_displacement_mm", m.mean_mm}, {"max_displacement_mm", m.max_mm}, {"at_retractor_mm", m.at_retractor_mm},
      {"max_strain", r.max_strain},        {"p95_strain", r.p95_strain},      {"max_rotation_deg", r.max_rotation_deg},
      {"converged", r.solver.converged()}, {"valid", r.linearTrusted},        {"validity", r.validity}};
}

/// Linear theory and the scene's own kinematics side by side.
Json kinematicsToJson(const RunResult& r) {
  Json j;
  j["linear"] = motionToJson(r.model, r.linear->primary);
  if (r.linear->difference) j["linear"]["difference"] = differenceToJson(*r.linear->difference);
  const std::string own = nameOf(r.primary.kinematics);
  j[own] = motionToJson(r.model, r.primary);
  if (r.difference) j[own]["difference"] = differenceToJson(*r.difference);
  j["between"] = differenceToJson(r.linear->between);
  j["between"].erase("clinically_significant");
  return j;
}

/// Calls fn(JSON object, key, path) for every path of a scene.
template <typename Fn>
void forEachPath(const Scene& scene, Json& j, Fn&& fn) {
  const GeometrySpec& g = scene.geometry;
  const auto one = [&](Json& object, const char* key, const std::filesystem::path& path) {
    if (!path.empty()) fn(object, key, path);
  };
  if (g.kind == GeometrySpec::Kind::Mask) {
    one(j["geometry"], "file", g.file);
    one(j["geometry"], "mri", g.background);
  } else if (g.kind == GeometrySpec::Kind::Patient) {
    one(j["geometry"], "mri", g.mri);
    one(j["geometry"], "mre", g.mre);
    one(j["geometry"], "roi", g.roi);
  }
  if (scene.material.kind == MaterialSpec::Kind::Map) one(j["material"], "map", scene.material.map);
  const auto region = [&](Json& holder, const retraction::Region& r) {
    if (const auto* mask = std::get_if<retraction::MaskRegion>(&r)) one(holder["region"], "mask", mask->file);
  };
  for (std::size_t i = 0; i < scene.setup.supports.size(); ++i)
    region(j["supports"][i], scene.setup.supports[i].region);
  for (std::size_t i = 0; i < scene.setup.loads.size(); ++i) {
    if (const auto* t = std::get_if<retraction::Traction>(&scene.setup.loads[i])) region(j["loads"][i], t->region);
    if (const auto* q = std::get_if<retraction::Pressure>(&scene.setup.loads[i])) region(j["loads"][i], q->region);
  }
}

Json parametersToJson(const Scene& scene) {
  Json j = Json::parse(pipeline::toJson(scene));
  forEachPath(scene, j, [](Json& object, const char* key, const std::filesystem::path&) { object[key] = "(file)"; });
  return j;
}

Json planToJson(const std::vector<PlanStep>& plan) {
  Json j = Json::array();
  for (const PlanStep& s : plan)
    j.push_back(
        {{"step", s.step}, {"needed", s.needed}, {"why", s.why}, {"seconds", s.seconds}, {"peak_MB", s.peak_MB}});
  return j;
}

Json modelToJson(const Scene& scene, const RunResult& r) {
  Json j = {{"dofs", r.primary.dofs},
            {"cells", r.model.cells},
            {"volume_mL", r.model.volume_mL},
            {"mass_kg", r.model.mass_kg}};
  if (scene.setup.model.kind == retraction::ModelKind::Meshfree) {
    j["frames"] = r.primary.frames;
    j["frames_asked"] = scene.setup.model.meshfree.frames;
    j["notes"] = r.primary.notes;
  }
  return j;
}

Json discretisationToJson(const retraction::DiscretisationError& e) {
  Json j = {{"known", e.known}, {"note", e.note}};
  if (!e.known) return j;
  j["mean_mm"] = e.mean_mm;
  j["p95_mm"] = e.p95_mm;
  j["max_mm"] = e.max_mm;
  addPlaces(e, j);
  if (e.difference) {
    j["difference"] = {{"mean_mm", e.difference->mean_mm}};
    addPlaces(*e.difference, j["difference"]);
  }
  return j;
}

/// The one answer, how far its cells let it be believed, where the bar lies, and the other answers.
void addAnswers(const Scene& scene, const RunResult& r, Json& j) {
  j.update(resultToJson(r.primary, scene));
  if (r.discretisation) j["discretisation_error"] = discretisationToJson(*r.discretisation);
  if (r.placed) j["pose"] = poseToJson(*r.placed);
  if (r.atlas) j["atlas"] = resultToJson(*r.atlas, scene);
  if (const std::string advice = adviceOn(scene, r); !advice.empty()) j["advice"] = advice;
  if (r.linear) j["kinematics_compared"] = kinematicsToJson(r);
}

/// The difference of the two answers; null where the scene asks for one and there is none.
void addComparison(const Scene& scene, const RunResult& r, Json& j) {
  if (!r.difference) {
    if (scene.compare) j["difference"] = nullptr;
    return;
  }
  const comparison::Difference& d = *r.difference;
  Json& out = j["difference"] = differenceToJson(d);
  out["significance"] = wordOf(significanceOf(r));
  if (!d.vessel_mm.empty())
    out["vessels"] = {{"landmarks", d.vessel_mm.size()},
                      {"mean_mm", d.vesselMean_mm},
                      {"p95_mm", d.vesselP95_mm},
                      {"max_mm", d.vesselMax_mm},
                      {"fraction_beyond_5mm", d.vesselFractionBeyond}};
  if (r.uncertainty) addIntervals(*r.uncertainty, out);
}

Json stiffnessToJson(const elastography::Measurement& m) {
  const elastography::Statistics& s = m.pooled;
  return {{"quantity", stiffnessQuantityNames.nameOf(m.quantity)},
          {"n", s.n},
          {"n_before_mask", s.n_before_mask},
          {"mean_kPa", s.mean_kPa},
          {"median_kPa", s.median_kPa},
          {"sd_kPa", s.sd_kPa}};
}

void addMessages(const RunResult& r, Json& j) {
  j["warnings"] = r.warnings;
  for (const std::string& text : r.diagnostics.texts(Severity::Warning)) j["warnings"].push_back(text);
  j["diagnostics"] = Json::array();
  for (const Diagnostic& d : r.diagnostics) j["diagnostics"].push_back(diagnosticToJson(d));
}

/// What the answers were made from and with.
void addProvenance(const Scene& scene, const RunResult& r, Json& j) {
  j["kinematics"] = {
      {"asked", nameOf(scene.setup.kinematics)}, {"used", nameOf(r.primary.kinematics)}, {"why", r.kinematicsWhy}};
  j["parameters"] = parametersToJson(scene);
  j["constants"] = {{"gravity_m_s2", defaults::gravity_m_s2},
                    {"clinically_significant_mm", defaults::clinicallySignificant.mm()},
                    {"confidence_threshold", defaults::confidenceThreshold}};
  j["inputs"] = Json::object();
  for (const auto& [name, digest] : inputDigests(scene)) j["inputs"][name] = {{"sha256", digest}};
  j["seed"] = scene.setup.seed;
}

/// A record without what differs from run to run of one program: times, memory and what was written.
Json lasting(Json j) {
  for (const char* key : {"plan", "version", "commit"}) j.erase(key);
  const auto forgetSeconds = [](Json& of) {
    if (of.contains("solver")) of["solver"].erase("seconds");
  };
  forgetSeconds(j);
  if (j.contains("atlas")) forgetSeconds(j["atlas"]);
  return j;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> inputDigests(const Scene& scene) {
  std::vector<std::pair<std::string, std::string>> digests;
  Json j = Json::parse(pipeline::toJson(scene));
  forEachPath(scene, j, [&](Json&, const std::string& key, const std::filesystem::path& path) {
    // Several regions may each have a mask: all are told apart by their number.
    std::string name = scene.geometry.kind == GeometrySpec::Kind::Mask && key == "file" ? "mask" : key;
    if (name == "mask" && key == "mask") name = "region mask";
    int n = 1;
    for (const auto& [other, digest] : digests)
      if (other == name || other.rfind(name + " ", 0) == 0) ++n;
    digests.emplace_back(n == 1 ? name : name + " " + std::to_string(n), digestOf(path));
  });
  return digests;
}

std::vector<std::pair<std::string, std::string>> inputDigestsOf(const std::string& record) {
  std::vector<std::pair<std::string, std::string>> digests;
  const Json j = Json::parse(record);  // outlives the loop over what it holds
  for (const auto& [name, input] : j.at("inputs").items())
    digests.emplace_back(name, input.at("sha256").get<std::string>());
  return digests;
}

std::string parameters(const Scene& scene) {
  return parametersToJson(scene).dump(1);
}

std::string sceneSeenFrom(const Scene& scene, const std::filesystem::path& folder) {
  Json j = Json::parse(pipeline::toJson(scene));
  forEachPath(scene, j, [&](Json& object, const char* key, const std::filesystem::path& path) {
    std::error_code ec;
    const std::filesystem::path seen = std::filesystem::relative(path, folder, ec);
    object[key] = ec || seen.empty() ? std::filesystem::absolute(path).generic_string() : seen.generic_string();
  });
  return j.dump(2) + "\n";
}

Motion motionOf(const retraction::Model& model, const retraction::Result& result) {
  Motion m;
  m.max_mm = result.max_displacement_mm;
  std::size_t cells = 0;
  for (std::size_t i = 0; i < model.youngs_kPa.values.size(); ++i) {
    if (!(model.youngs_kPa.values[i] > 0.0f)) continue;
    m.mean_mm += static_cast<double>(result.u_mm.values[i].norm());
    ++cells;
  }
  if (cells > 0) m.mean_mm /= static_cast<double>(cells);
  if (result.contact) {
    double area = 0.0;
    for (std::size_t i = 0; i < result.contact->sample_mm.size(); ++i) {
      if (!(result.contact->pressure_kPa[i] > 0.0)) continue;
      m.at_retractor_mm += result.contact->sample_mm2[i] * result.contact->sample_u_mm[i].norm();
      area += result.contact->sample_mm2[i];
    }
    if (area > 0.0) m.at_retractor_mm /= area;
  }
  for (const int node : result.contactNodes)
    m.at_retractor_mm += 1e3 * result.nodal_u_m.col(node).norm() / static_cast<double>(result.contactNodes.size());
  return m;
}

std::string runRecord(const Scene& scene, const RunResult& r, render::Palette palette, Language language) {
  Json j;
  j["schema"] = "glisson/run/1";
  j["note"] = researchUseOnly;
  j["version"] = version();
  j["commit"] = buildCommit();
  j["plan"] = planToJson(r.plan);
  j["model"] = modelToJson(scene, r);
  addAnswers(scene, r, j);
  addComparison(scene, r, j);
  if (r.uncertainty) j["uncertainty"] = uncertaintyToJson(*r.uncertainty);
  if (r.stiffness) j["stiffness"] = stiffnessToJson(*r.stiffness);
  addMessages(r, j);
  addProvenance(scene, r, j);
  const std::string text = lasting(j).dump();
  j["results_sha256"] = sha256(text.data(), text.size());
  j["threads"] = threadCount();
  nameFiles(j, r.files, palette);
  j["language"] = nameOf(language);
  return j.dump(1);
}

Language languageOf(const std::string& record) {
  return languageNamed(Json::parse(record).value("language", ""));
}

std::string recordOfFiles(const std::string& record, const std::vector<std::filesystem::path>& files,
                          const std::vector<std::filesystem::path>& beside, render::Palette palette) {
  Json j = Json::parse(record);
  nameFiles(j, files, palette);
  for (const auto& f : beside) {
    j["charts"].push_back({{"file", f.filename().string()}, {"sha256", sha256OfFile(f)}});
    j["files"].push_back(f.filename().string());
  }
  return j.dump(1);
}

}  // namespace glisson::pipeline::detail
