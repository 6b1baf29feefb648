// SPDX-License-Identifier: GPL-3.0-or-later
#include "cohort/detail/report_words.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/quantity.h"
#include "cohort/detail/summary.h"

namespace glisson::cohort::detail {

using report::number;

std::string orDash(double v, int digits) {
  return std::isfinite(v) ? number(v, digits) : "–";
}
std::string patients(std::size_t n) {
  return std::to_string(n) + (n == 1 ? " patient" : " patients");
}
std::string percent(double fraction) {
  return number(100.0 * fraction, 3) + " %";
}

std::string in95(const std::optional<SureShare>& share) {
  return share ? " (95 %: " + percent(share->low) + " to " + percent(share->high) + ")" : std::string();
}

std::string quantityOf(const StiffnessStudy& s) {
  return s.asPublished ? "Young's modulus E = 3µ (as published)" : "shear modulus µ";
}

std::string inWords(const Spread& s, const char* unit) {
  if (s.n == 1) return orDash(s.mean) + " " + unit + " (n = 1)";
  return orDash(s.mean) + " ± " + orDash(s.sd) + " " + unit + " (median " + orDash(s.median) + ", " + orDash(s.min) +
         " to " + orDash(s.max) + ", n = " + std::to_string(s.n) + ")";
}

namespace {

using Json = nlohmann::ordered_json;

/// One row per value; a list of plain values is one row.
void flatten(const Json& j, const std::string& path, std::vector<std::pair<std::string, std::string>>& rows) {
  const bool list = j.is_array() && std::none_of(j.begin(), j.end(), [](const Json& x) { return x.is_structured(); });
  if (!j.is_structured() || list) {
    rows.emplace_back(path, j.is_string() ? j.get<std::string>() : j.dump());
    return;
  }
  for (const auto& [key, value] : j.items()) {
    const std::string step = j.is_array() ? std::to_string(std::stoi(key) + 1) : key;
    if (key != "schema" && key != "outputs") flatten(value, path.empty() ? step : path + " " + step, rows);
  }
}

/// How many of the chosen patients are at 5 mm or more under one assumption.
std::size_t significantUnder(const Summary& s, const std::string& variation) {
  return static_cast<std::size_t>(
      std::count_if(s.sensitivity.begin(), s.sensitivity.end(), [&](const SensitivityRow& r) {
        return r.variation == variation && r.at_retractor_mm >= defaults::clinicallySignificant.mm();
      }));
}

}  // namespace

void inShort(report::Page& page, const Summary& s) {
  page.heading("In short");
  std::vector<std::string> items;
  if (!s.stiffness.values_kPa.empty())
    items.push_back("Stiffness (" + quantityOf(s.stiffness) + "): " + percent(s.stiffness.fractionOver1kPa) + " of " +
                    patients(s.stiffness.values_kPa.size()) + " are more than 1 kPa above " +
                    number(s.stiffness.atlas_kPa) + " kPa, " + percent(s.stiffness.fractionOverTwice) +
                    " are more than twice as stiff.");
  if (s.retraction.left > 0)
    items.push_back(
        "Retraction, measured against atlas stiffness: " + percent(s.retraction.fractionWithinVoxel) +
        in95(s.retraction.sureWithinVoxel) + " of " + patients(s.retraction.left) +
        " agree within one MRI voxel on average over the liver; at the retractor " +
        percent(s.retraction.fractionSignificant) + in95(s.retraction.sureSignificant) + " differ by 5 mm or more" +
        (s.retraction.travel.n > 0 ? ", in the travel of the bar " + percent(s.retraction.fractionTravelSignificant) +
                                         in95(s.retraction.sureTravelSignificant) + "."
                                   : "."));
  std::string changing;
  std::vector<std::string> seen;
  for (const SensitivityRow& r : s.sensitivity) {
    if (std::find(seen.begin(), seen.end(), r.variation) != seen.end()) continue;
    seen.push_back(r.variation);
    const std::size_t n = significantUnder(s, r.variation);
    if (seen.size() > 1 && n != significantUnder(s, seen.front()))
      changing += (changing.empty() ? "" : "; ") + r.variation + " (" + std::to_string(n) + ")";
  }
  if (seen.size() > 1)
    items.push_back(
        "Of the " + patients(s.chosen.size()) + " shown, " + std::to_string(significantUnder(s, seen.front())) +
        " are at 5 mm or more as simulated; " +
        (changing.empty() ? "no assumption changes that number." : "another number under: " + changing + "."));
  page.list(items);
  if (s.stiffness.asPublished)
    page.warning(
        "As published: Young's moduli are compared with 2.1 kPa, which is the shear modulus of healthy livers. As E = "
        "3µ, "
        "a liver with just the atlas' stiffness counts as three times as stiff here. Without this option like is "
        "compared "
        "with like.");
}

void methods(report::Page& page, const Summary& s) {
  page.heading("Methods");
  page.paragraph(
      "Every patient's region of interest was mapped onto the elastogram by patient geometry; voxels whose centre lies "
      "outside it, or whose confidence is below 0.95, were left out. The mean " +
      quantityOf(s.stiffness) + " of each patient is compared with the atlas value of " +
      number(s.stiffness.atlas_kPa) +
      " kPa. Each liver was then retracted twice under the same load, once with its measured stiffness and once with "
      "the "
      "atlas stiffness, and the two displacements were compared over the whole liver and at the retractor.");
  if (!s.sceneParameters.empty()) {
    page.paragraph("Parameters of the retraction (of the first patient that is left; files are not named):");
    std::vector<std::pair<std::string, std::string>> rows;
    flatten(Json::parse(s.sceneParameters), "", rows);
    page.table(rows);
  }
}

void howSure(report::Page& page, const Summary& s) {
  const RetractionStudy& b = s.retraction;
  if (!b.sureSignificant) return;
  std::vector<std::vector<std::string>> rows;
  const auto row = [&](const char* what, double counted, const std::optional<SureShare>& share) {
    if (share)
      rows.push_back(
          {what, percent(counted), percent(share->expected), percent(share->low) + " to " + percent(share->high)});
  };
  row("Within one voxel, mean over the liver", b.fractionWithinVoxel, b.sureWithinVoxel);
  row("5 mm or more at the retractor", b.fractionSignificant, b.sureSignificant);
  if (b.travel.n > 0)
    row("5 mm or more in the travel of the bar", b.fractionTravelSignificant, b.sureTravelSignificant);
  page.table({"Share of the patients", "counted", "sum of their probabilities", "95 %"}, rows);
  page.paragraph(
      "Intervals come from the probability of each of the " + patients(b.sureSignificant->n) +
      " whose run says how sure it is, the patients as independent of each other: they are about the patients "
      "of this cohort, not about all livers.");
}

void reservations(report::Page& page, const Summary& s) {
  std::size_t beyond = 0;
  std::vector<double> strain, rotation, error, ofDifference;
  std::size_t undecided = 0;
  for (const CaseRecord& r : s.records) {
    if (r.outcome.status != CaseOutcome::Status::Done) continue;
    if (!r.kinematics_valid) ++beyond;
    strain.push_back(r.p95_strain);
    rotation.push_back(r.rotation_deg);
    error.push_back(r.discretisation_mm);
    ofDifference.push_back(r.difference_error_mm);
    if (std::abs(r.at_retractor_mm - defaults::clinicallySignificant.mm()) <= r.difference_error_mm) ++undecided;
  }
  if (beyond > 0)
    page.warning("In " + std::to_string(beyond) + " of " + patients(s.retraction.left) +
                 " the theory that was used does not hold: strains or rotations are larger than it allows for, or the "
                 "bar folds cells of the surface (in the median patient 5 % of the liver strain by more than " +
                 percent(spreadOf(strain).median) + ", and the largest rotation is " +
                 orDash(spreadOf(rotation).median) + "°). The differences are those of the model that was asked for.");
  const Spread e = spreadOf(error);
  if (e.n > 0)
    page.paragraph("The largest discretisation error of a displacement, estimated from cells twice as large, is " +
                   inWords(e, "mm") + ". It is an error of each of the two displacements at its worst cell.");
  if (const Spread d = spreadOf(ofDifference); d.n > 0)
    page.paragraph("The difference at the retractor has a discretisation error of " + inWords(d, "mm") +
                   ", estimated in the same way. In " + std::to_string(undecided) + " of " +
                   patients(s.retraction.left) +
                   " it is as large as the distance from 5 mm: there the cells leave open on which side the difference "
                   "lies.");
}

void sensitivityTable(report::Page& page, const Summary& s) {
  std::vector<std::string> header = {"Assumption"};
  for (const Chosen& c : s.chosen) header.push_back(c.id + " (" + c.what + "), mm");
  header.push_back("beyond 5 mm");
  std::vector<std::vector<std::string>> rows;
  for (const SensitivityRow& r : s.sensitivity) {
    if (rows.empty() || rows.back().front() != r.variation) {
      const bool seen = std::any_of(rows.begin(), rows.end(), [&](const auto& x) { return x.front() == r.variation; });
      if (seen) continue;
      std::vector<std::string> row = {r.variation};
      int beyond = 0;
      for (const Chosen& c : s.chosen) {
        const auto at = std::find_if(s.sensitivity.begin(), s.sensitivity.end(), [&](const SensitivityRow& x) {
          return x.variation == r.variation && x.id == c.id;
        });
        const bool there = at != s.sensitivity.end() && std::isfinite(at->at_retractor_mm);
        row.push_back(there ? number(at->at_retractor_mm, 3) : "–");
        if (there && at->at_retractor_mm >= defaults::clinicallySignificant.mm()) ++beyond;
      }
      row.push_back(std::to_string(beyond) + " of " + std::to_string(s.chosen.size()));
      rows.push_back(std::move(row));
    }
  }
  page.table(header, rows);
}

}  // namespace glisson::cohort::detail
