// SPDX-License-Identifier: GPL-3.0-or-later

// The files of a cohort that a program reads.
#include "cohort/detail/summary_files.h"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/quantity.h"
#include "base/version.h"
#include "report/text.h"

namespace glisson::cohort::detail {
namespace {

using Json = nlohmann::ordered_json;
using report::number;

Json orNull(double v) {
  return std::isfinite(v) ? Json(v) : Json(nullptr);
}
Json toJson(const Spread& s) {
  return {{"n", s.n},
          {"mean", orNull(s.mean)},
          {"sd", orNull(s.sd)},
          {"median", orNull(s.median)},
          {"min", orNull(s.min)},
          {"max", orNull(s.max)}};
}

Json stiffnessJson(const StiffnessStudy& a) {
  return {{"quantity", a.asPublished ? "youngs" : "shear"},
          {"as_published", a.asPublished},
          {"atlas_kPa", a.atlas_kPa},
          {"measured", a.values_kPa.size()},
          {"kPa", toJson(a.spread)},
          {"fraction_over_1kPa", a.fractionOver1kPa},
          {"fraction_over_twice", a.fractionOverTwice}};
}

/// Shares with their intervals, where runs say how sure they are.
void addHowSure(const RetractionStudy& b, Json& j) {
  const auto add = [&](const char* name, const std::optional<SureShare>& s) {
    if (!s) return;
    j["how_sure"]["patients"] = s->n;
    j["how_sure"][name] = {{"expected", s->expected}, {"interval95", {s->low, s->high}}};
  };
  add("fraction_within_voxel", b.sureWithinVoxel);
  add("fraction_clinically_significant", b.sureSignificant);
  add("fraction_travel_clinically_significant", b.sureTravelSignificant);
}

Json retractionJson(const RetractionStudy& b) {
  Json j = {{"tried", b.tried},
            {"rejected", b.rejected},
            {"failed", b.failed},
            {"left", b.left},
            {"mean_difference_mm", toJson(b.mean)},
            {"at_retractor_mm", toJson(b.atRetractor)},
            {"voxel_mm", defaults::mriVoxel.mm()},
            {"fraction_within_voxel", b.fractionWithinVoxel},
            {"significant_mm", defaults::clinicallySignificant.mm()},
            {"fraction_clinically_significant", b.fractionSignificant}};
  if (b.travel.n > 0) {
    j["travel_difference_mm"] = toJson(b.travel);
    j["fraction_travel_clinically_significant"] = b.fractionTravelSignificant;
  }
  addHowSure(b, j);
  return j;
}

const char* wordOf(CaseOutcome::Status status) {
  constexpr std::array<const char*, 3> words = {"done", "rejected", "failed"};
  return words[static_cast<std::size_t>(status)];
}

constexpr std::array patientColumns = {"case",
                                       "status",
                                       "shear_kPa",
                                       "youngs_kPa",
                                       "sd_kPa",
                                       "voxels",
                                       "volume_mL",
                                       "mean_mm",
                                       "p95_mm",
                                       "max_mm",
                                       "at_retractor_mm",
                                       "vessel_mean_mm",
                                       "vessel_beyond_5mm",
                                       "discretisation_mm",
                                       "difference_error_mm",
                                       "p95_strain",
                                       "rotation_deg",
                                       "linear_valid",
                                       "dofs",
                                       "travel_mm",
                                       "atlas_travel_mm",
                                       "travel_difference_mm",
                                       "pose_height_mm",
                                       "kinematics",
                                       "kinematics_valid",
                                       "at_retractor_low_mm",
                                       "at_retractor_high_mm",
                                       "probability_beyond_5mm",
                                       "probability_travel_beyond_5mm",
                                       "probability_within_voxel"};

}  // namespace

std::string patientsCsv(const Summary& s) {
  report::Csv csv({patientColumns.begin(), patientColumns.end()});
  const auto cell = [](double v) { return std::isfinite(v) ? number(v, 10) : std::string(); };
  for (const CaseRecord& r : s.records) {
    csv.row({r.outcome.id,
             wordOf(r.outcome.status),
             cell(r.shear_kPa),
             cell(r.youngs_kPa),
             cell(r.sd_kPa),
             std::to_string(r.voxels),
             cell(r.volume_mL),
             cell(r.mean_mm),
             cell(r.p95_mm),
             cell(r.max_mm),
             cell(r.at_retractor_mm),
             cell(r.vessel_mean_mm),
             cell(r.vessel_beyond_5mm),
             cell(r.discretisation_mm),
             cell(r.difference_error_mm),
             cell(r.p95_strain),
             cell(r.rotation_deg),
             r.linear_valid ? "yes" : "no",
             std::to_string(r.dofs),
             cell(r.travel_mm),
             cell(r.atlas_travel_mm),
             cell(r.travel_difference_mm),
             cell(r.pose_height_mm),
             r.kinematics,
             r.kinematics_valid ? "yes" : "no",
             cell(r.at_retractor_low_mm),
             cell(r.at_retractor_high_mm),
             cell(r.probability_beyond_5mm),
             cell(r.probability_travel_beyond_5mm),
             cell(r.probability_within_voxel)});
  }
  return csv.text();
}

std::string rejectedCsv(const Summary& s) {
  report::Csv csv({"case", "status", "reason"});
  for (const CaseRecord& r : s.records)
    if (r.outcome.status != CaseOutcome::Status::Done)
      csv.row({r.outcome.id, wordOf(r.outcome.status), r.outcome.reason});
  return csv.text();
}

std::string summaryJson(const Summary& s) {
  Json j;
  j["schema"] = "glisson/cohort/1";
  j["note"] = researchUseOnly;
  j["version"] = version();
  j["stiffness"] = stiffnessJson(s.stiffness);
  j["retraction"] = retractionJson(s.retraction);
  j["chosen"] = Json::array();
  for (const Chosen& c : s.chosen)
    j["chosen"].push_back(
        {{"what", c.what}, {"case", c.id}, {"at_retractor_mm", c.at_retractor_mm}, {"passed_over", c.passedOver}});
  j["sensitivity"] = Json::array();
  for (const SensitivityRow& r : s.sensitivity)
    j["sensitivity"].push_back({{"assumption", r.variation},
                                {"case", r.id},
                                {"mean_mm", orNull(r.mean_mm)},
                                {"at_retractor_mm", orNull(r.at_retractor_mm)}});
  j["cases"] = Json::array();
  for (const CaseRecord& r : s.records) j["cases"].push_back(Json::parse(cohort::toJson(r)));
  return j.dump(1) + "\n";
}

}  // namespace glisson::cohort::detail
