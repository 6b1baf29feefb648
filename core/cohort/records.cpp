// SPDX-License-Identifier: GPL-3.0-or-later
#include "cohort/records.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/atomic_file.h"
#include "base/error.h"

namespace glisson::cohort {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr const char* schema = "glisson/cohort-case/1";

constexpr std::array<const char*, 3> statusNames = {"done", "rejected", "failed"};

Json orNull(double v) {
  return std::isfinite(v) ? Json(v) : Json(nullptr);
}

/// Value at a path of keys, NaN where any is missing or null.
double numberAt(const Json& j, std::initializer_list<const char*> keys) {
  const Json* at = &j;
  for (const char* k : keys) {
    if (!at->is_object() || !at->contains(k)) return none;
    at = &(*at)[k];
  }
  return at->is_number() ? at->get<double>() : none;
}

void readHowSure(const Json& run, CaseRecord& r) {
  r.probability_beyond_5mm = numberAt(run, {"difference", "probability_beyond_5mm"});
  r.probability_travel_beyond_5mm = numberAt(run, {"difference", "probability_travel_beyond_5mm"});
  r.probability_within_voxel = numberAt(run, {"difference", "probability_mean_within_voxel"});
  const Json::json_pointer interval("/difference/interval95/at_retractor_mm");
  if (!run.contains(interval)) return;
  r.at_retractor_low_mm = run[interval].at(0).get<double>();
  r.at_retractor_high_mm = run[interval].at(1).get<double>();
}

template <typename Visit>
void eachNumber(CaseRecord& r, Visit&& visit) {
  visit("shear_kPa", r.shear_kPa);
  visit("youngs_kPa", r.youngs_kPa);
  visit("sd_kPa", r.sd_kPa);
  visit("mean_mm", r.mean_mm);
  visit("p95_mm", r.p95_mm);
  visit("max_mm", r.max_mm);
  visit("at_retractor_mm", r.at_retractor_mm);
  visit("vessel_mean_mm", r.vessel_mean_mm);
  visit("vessel_beyond_5mm", r.vessel_beyond_5mm);
  visit("travel_mm", r.travel_mm);
  visit("atlas_travel_mm", r.atlas_travel_mm);
  visit("travel_difference_mm", r.travel_difference_mm);
  visit("pose_height_mm", r.pose_height_mm);
  visit("discretisation_mm", r.discretisation_mm);
  visit("difference_error_mm", r.difference_error_mm);
  visit("at_retractor_low_mm", r.at_retractor_low_mm);
  visit("at_retractor_high_mm", r.at_retractor_high_mm);
  visit("probability_beyond_5mm", r.probability_beyond_5mm);
  visit("probability_travel_beyond_5mm", r.probability_travel_beyond_5mm);
  visit("probability_within_voxel", r.probability_within_voxel);
  visit("volume_mL", r.volume_mL);
  visit("p95_strain", r.p95_strain);
  visit("rotation_deg", r.rotation_deg);
}

}  // namespace

bool CaseRecord::measured() const {
  return std::isfinite(shear_kPa);
}

CaseRecord recordOf(const std::string& id, const std::string& key, const std::string& measureJson,
                    const std::string& runJson) {
  CaseRecord r;
  r.outcome.id = id;
  r.key = key;
  eachNumber(r, [](const char*, double& v) { v = none; });
  const Json m = measureJson.empty() ? Json::object() : Json::parse(measureJson);
  const double mean = numberAt(m, {"pooled", "mean_kPa"}), sd = numberAt(m, {"pooled", "sd_kPa"});
  r.youngs_kPa = numberAt(m, {"youngs_mean_kPa"});
  const bool shear = m.value("quantity", "shear") == "shear";
  r.shear_kPa = shear ? mean : r.youngs_kPa / 3.0;
  r.sd_kPa = shear ? sd : sd * r.shear_kPa / mean;
  if (m.contains("pooled")) r.voxels = m["pooled"].value("n", 0LL);
  const Json j = runJson.empty() ? Json::object() : Json::parse(runJson);
  r.mean_mm = numberAt(j, {"difference", "mean_mm"});
  r.p95_mm = numberAt(j, {"difference", "p95_mm"});
  r.max_mm = numberAt(j, {"difference", "max_mm"});
  r.at_retractor_mm = numberAt(j, {"difference", "at_retractor_mm"});
  r.vessel_mean_mm = numberAt(j, {"difference", "vessels", "mean_mm"});
  r.vessel_beyond_5mm = numberAt(j, {"difference", "vessels", "fraction_beyond_5mm"});
  r.travel_mm = numberAt(j, {"contact", "travel_mm"});
  r.atlas_travel_mm = numberAt(j, {"atlas", "contact", "travel_mm"});
  r.travel_difference_mm = numberAt(j, {"difference", "travel_mm"});
  r.pose_height_mm = numberAt(j, {"pose", "height_mm"});
  r.discretisation_mm = numberAt(j, {"discretisation_error", "max_mm"});
  r.difference_error_mm = numberAt(j, {"discretisation_error", "difference", "at_retractor_mm"});
  readHowSure(j, r);
  r.volume_mL = numberAt(j, {"model", "volume_mL"});
  r.p95_strain = numberAt(j, {"p95_strain"});
  r.rotation_deg = numberAt(j, {"max_rotation_deg"});
  const double dofs = numberAt(j, {"model", "dofs"});
  r.dofs = std::isfinite(dofs) ? static_cast<long long>(dofs) : 0;
  r.linear_valid = j.value("linear_valid", false);
  r.kinematics_valid = j.value("kinematics_valid", r.linear_valid);
  if (j.contains("kinematics") && j["kinematics"].is_object()) r.kinematics = j["kinematics"].value("used", "");
  r.drawable = j.value("drawable", true) && (!j.contains("atlas") || j["atlas"].value("drawable", true));
  for (const Json* source : {&m, &j})
    if (source->contains("warnings"))
      for (const Json& w : (*source)["warnings"])
        if (std::find(r.warnings.begin(), r.warnings.end(), w.get<std::string>()) == r.warnings.end())
          r.warnings.push_back(w.get<std::string>());
  return r;
}

std::string toJson(const CaseRecord& record) {
  CaseRecord r = record;
  Json j;
  j["schema"] = schema;
  j["id"] = r.outcome.id;
  j["status"] = statusNames[static_cast<std::size_t>(r.outcome.status)];
  j["reason"] = r.outcome.reason;
  j["key"] = r.key;
  eachNumber(r, [&](const char* name, double& v) { j[name] = orNull(v); });
  j["voxels"] = r.voxels;
  j["dofs"] = r.dofs;
  j["linear_valid"] = r.linear_valid;
  j["kinematics_valid"] = r.kinematics_valid;
  j["kinematics"] = r.kinematics;
  j["drawable"] = r.drawable;
  j["warnings"] = r.warnings;
  return j.dump(1) + "\n";
}

std::optional<CaseRecord> parseRecord(const std::string& text) {
  const Json j = Json::parse(text, nullptr, false);
  if (!j.is_object() || j.value("schema", "") != schema) return {};
  CaseRecord r;
  r.outcome.id = j.value("id", "");
  const std::string status = j.value("status", "");
  const auto known = std::find(statusNames.begin(), statusNames.end(), status);
  if (r.outcome.id.empty() || known == statusNames.end()) return {};
  r.outcome.status = static_cast<CaseOutcome::Status>(known - statusNames.begin());
  r.outcome.reason = j.value("reason", "");
  r.key = j.value("key", "");
  eachNumber(r, [&](const char* name, double& v) { v = numberAt(j, {name}); });
  r.voxels = j.value("voxels", 0LL);
  r.dofs = j.value("dofs", 0LL);
  r.linear_valid = j.value("linear_valid", false);
  r.kinematics_valid = j.value("kinematics_valid", r.linear_valid);
  r.kinematics = j.value("kinematics", "");
  r.drawable = j.value("drawable", true);
  r.warnings = j.value("warnings", std::vector<std::string>{});
  return r;
}

std::vector<CaseRecord> readRecords(const fs::path& output) {
  std::vector<CaseRecord> records;
  if (!fs::is_directory(output / "cases")) return records;
  for (const auto& entry : fs::directory_iterator(output / "cases"))
    if (fs::is_regular_file(entry.path() / "result.json"))
      if (const auto r = parseRecord(readWhole(entry.path() / "result.json"))) records.push_back(*r);
  std::sort(records.begin(), records.end(),
            [](const CaseRecord& a, const CaseRecord& b) { return a.outcome.id < b.outcome.id; });
  return records;
}

void writeWhole(const fs::path& file, const std::string& text) {
  std::error_code ec;
  fs::create_directories(file.parent_path(), ec);
  writeAtomically(file, text);
}

std::string readWhole(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

}  // namespace glisson::cohort
