#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/quantity.h"
#include "base/version.h"
#include "cohort/detail/summary.h"
#include "render/charts.h"
#include "render/picture.h"
#include "report/page.h"
#include "report/text.h"

namespace glisson::cohort::detail {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using report::number;

constexpr render::Rgb magenta{200, 0, 160};
constexpr render::Rgb orange{230, 126, 0};

Json orNull(double v) {
  return std::isfinite(v) ? Json(v) : Json(nullptr);
}
std::string orDash(double v, int digits = 3) {
  return std::isfinite(v) ? number(v, digits) : "–";
}
std::string percent(double fraction) {
  return number(100.0 * fraction, 3) + " %";
}

Json toJson(const Spread& s) {
  return {{"n", s.n},
          {"mean", orNull(s.mean)},
          {"sd", orNull(s.sd)},
          {"median", orNull(s.median)},
          {"min", orNull(s.min)},
          {"max", orNull(s.max)}};
}

std::string quantityOf(const StiffnessStudy& s) {
  return s.asPublished ? "Young's modulus E = 3µ (as published)" : "shear modulus µ";
}

std::string inWords(const Spread& s, const char* unit) {
  return orDash(s.mean) + " ± " + orDash(s.sd) + " " + unit + " (median " + orDash(s.median) + ", " + orDash(s.min) +
         " to " + orDash(s.max) + ", n = " + std::to_string(s.n) + ")";
}

render::Histogram histogram(const StiffnessStudy& s) {
  render::Histogram h;
  h.title = "Mean liver stiffness of " + std::to_string(s.values_kPa.size()) + " patients";
  h.x.title = std::string("Mean ") + (s.asPublished ? "Young's modulus E = 3µ (kPa)" : "shear modulus µ (kPa)");
  h.y.title = "Number of patients";
  h.values = s.values_kPa;
  h.binWidth = s.asPublished ? 1.5 : 0.5;
  h.lines = {{s.atlas_kPa, "atlas " + number(s.atlas_kPa) + " kPa", orange}};
  h.caption = percent(s.fractionOver1kPa) + " more than 1 kPa stiffer than the atlas, " + percent(s.fractionOverTwice) +
              " more than twice as stiff. " + researchUseOnly + ".";
  return h;
}

render::BoxPlot box(const char* title, const std::vector<double>& values, const render::ReferenceLine& line,
                    const std::string& caption) {
  render::BoxPlot b;
  b.title = title;
  b.y.title = "Displacement difference, MRE − atlas (mm)";
  b.y.low = 0.0;
  b.boxes = {{std::to_string(values.size()) + " patients", values}};
  b.lines = {line};
  b.caption = caption + " " + researchUseOnly + ".";
  return b;
}

render::BoxPlot sensitivityChart(const std::vector<SensitivityRow>& rows, double significant_mm) {
  render::BoxPlot b;
  b.title = "Which assumption changes the conclusion?";
  b.y.title = "Difference at the retractor (mm)";
  b.y.low = 0.0;
  for (const SensitivityRow& r : rows) {
    auto at = std::find_if(b.boxes.begin(), b.boxes.end(), [&](const auto& x) { return x.label == r.variation; });
    if (at == b.boxes.end()) {
      b.boxes.push_back({r.variation, {}});
      at = std::prev(b.boxes.end());
    }
    if (std::isfinite(r.at_retractor_mm)) at->values.push_back(r.at_retractor_mm);
  }
  b.boxes.erase(std::remove_if(b.boxes.begin(), b.boxes.end(), [](const auto& x) { return x.values.empty(); }),
                b.boxes.end());
  b.lines = {{significant_mm, "clinically significant", orange}};
  b.caption = std::string("The chosen patients under one changed assumption at a time. ") + researchUseOnly + ".";
  return b;
}

template <typename Chart>
fs::path writeChart(const Chart& chart, const fs::path& folder, const std::string& name, std::vector<fs::path>& files) {
  fs::create_directories(folder);
  const fs::path png = folder / (name + ".png");
  render::writePng(png, render::draw(chart));
  files.push_back(png);
  writeWhole(folder / (name + ".svg"), render::svg(chart));
  files.push_back(folder / (name + ".svg"));
  return png;
}

std::string patientsCsv(const Summary& s) {
  report::Csv csv({"case", "status", "shear_kPa", "youngs_kPa", "sd_kPa", "voxels", "volume_mL", "mean_mm", "p95_mm",
                   "max_mm", "at_retractor_mm", "vessel_mean_mm", "vessel_beyond_5mm", "discretisation_mm",
                   "p95_strain", "rotation_deg", "linear_valid", "dofs"});
  const auto cell = [](double v) { return std::isfinite(v) ? number(v, 10) : std::string(); };
  for (const CaseRecord& r : s.records) {
    constexpr std::array<const char*, 3> status = {"done", "rejected", "failed"};
    csv.row({r.outcome.id, status[static_cast<std::size_t>(r.outcome.status)], cell(r.shear_kPa), cell(r.youngs_kPa),
             cell(r.sd_kPa), std::to_string(r.voxels), cell(r.volume_mL), cell(r.mean_mm), cell(r.p95_mm),
             cell(r.max_mm), cell(r.at_retractor_mm), cell(r.vessel_mean_mm), cell(r.vessel_beyond_5mm),
             cell(r.discretisation_mm), cell(r.p95_strain), cell(r.rotation_deg), r.linear_valid ? "yes" : "no",
             std::to_string(r.dofs)});
  }
  return csv.text();
}

std::string rejectedCsv(const Summary& s) {
  report::Csv csv({"case", "status", "reason"});
  for (const CaseRecord& r : s.records)
    if (r.outcome.status != CaseOutcome::Status::Done)
      csv.row(
          {r.outcome.id, r.outcome.status == CaseOutcome::Status::Rejected ? "rejected" : "failed", r.outcome.reason});
  return csv.text();
}

std::string summaryJson(const Summary& s) {
  Json j;
  j["schema"] = "glisson/cohort/1";
  j["note"] = researchUseOnly;
  j["version"] = version();
  const StiffnessStudy& a = s.stiffness;
  j["stiffness"] = {{"quantity", a.asPublished ? "youngs" : "shear"},
                    {"as_published", a.asPublished},
                    {"atlas_kPa", a.atlas_kPa},
                    {"measured", a.values_kPa.size()},
                    {"kPa", toJson(a.spread)},
                    {"fraction_over_1kPa", a.fractionOver1kPa},
                    {"fraction_over_twice", a.fractionOverTwice}};
  const RetractionStudy& b = s.retraction;
  j["retraction"] = {{"tried", b.tried},
                     {"rejected", b.rejected},
                     {"failed", b.failed},
                     {"left", b.left},
                     {"mean_difference_mm", toJson(b.mean)},
                     {"at_retractor_mm", toJson(b.atRetractor)},
                     {"voxel_mm", defaults::mriVoxel.mm()},
                     {"fraction_within_voxel", b.fractionWithinVoxel},
                     {"significant_mm", defaults::clinicallySignificant.mm()},
                     {"fraction_clinically_significant", b.fractionSignificant}};
  j["chosen"] = Json::array();
  for (const Chosen& c : s.chosen)
    j["chosen"].push_back({{"what", c.what}, {"case", c.id}, {"at_retractor_mm", c.at_retractor_mm}});
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

}  // namespace

std::vector<fs::path> writeSummary(const Summary& s, const CohortOptions& options, std::string& json) {
  std::vector<fs::path> files;
  const fs::path figures = options.output / "figures";
  const auto text = [&](const char* name, const std::string& content) {
    writeWhole(options.output / name, content);
    files.push_back(options.output / name);
  };
  json = summaryJson(s);
  text("cohort.json", json);
  text("patients.csv", patientsCsv(s));
  text("rejected.csv", rejectedCsv(s));

  report::Page page("Cohort of " + std::to_string(s.records.size()) + " patients");
  const RetractionStudy& b = s.retraction;
  page.table({{"Patients tried", std::to_string(b.tried)},
              {"Rejected", std::to_string(b.rejected)},
              {"Failed", std::to_string(b.failed)},
              {"Left in the retraction study", std::to_string(b.left)},
              {"Software", "Glisson " + version()}});
  methods(page, s);

  page.heading("Stiffness over the cohort");
  if (!s.stiffness.values_kPa.empty()) {
    const render::Histogram h = histogram(s.stiffness);
    page.picture(writeChart(h, figures, "stiffness-histogram", files),
                 "Mean " + quantityOf(s.stiffness) + ": " + inWords(s.stiffness.spread, "kPa") + ". " +
                     percent(s.stiffness.fractionOver1kPa) + " of the patients are more than 1 kPa stiffer than the " +
                     number(s.stiffness.atlas_kPa) + " kPa atlas, " + percent(s.stiffness.fractionOverTwice) +
                     " more than twice as stiff.");
  } else {
    page.warning("No patient's stiffness could be measured.");
  }

  page.heading("Retraction: measured against atlas stiffness");
  if (b.left > 0) {
    page.picture(writeChart(box("Mean over the whole liver", b.mean_mm,
                                {defaults::mriVoxel.mm(), "one MRI voxel, 1.64 mm", magenta},
                                percent(b.fractionWithinVoxel) + " of the patients within one voxel."),
                            figures, "difference-mean", files),
                 "Mean displacement difference over the liver: " + inWords(b.mean, "mm") + ".");
    page.picture(writeChart(box("At the retractor", b.at_retractor_mm,
                                {defaults::clinicallySignificant.mm(), "clinically significant, 5 mm", orange},
                                percent(b.fractionSignificant) + " of the patients at 5 mm or more."),
                            figures, "difference-retractor", files),
                 "Displacement difference at the retractor: " + inWords(b.atRetractor, "mm") + ".");
  } else {
    page.warning("No retraction came to an end; the reasons are listed below.");
  }

  if (!s.pictures.empty()) page.heading("Four patients chosen by the difference at the retractor");
  for (const Chosen& c : s.chosen) {
    const auto pictures = s.pictures.find(c.id);
    if (pictures == s.pictures.end()) continue;
    for (const fs::path& p : pictures->second) {
      page.picture(p,
                   c.what + ", " + c.id + ": " + number(c.at_retractor_mm, 3) +
                       " mm at the retractor. Blue: measured stiffness; red: atlas; purple where they agree; the green "
                       "grid shows millimetres.");
      files.push_back(p);
    }
  }

  if (std::any_of(s.sensitivity.begin(), s.sensitivity.end(),
                  [&](const SensitivityRow& r) { return r.variation != s.sensitivity.front().variation; })) {
    page.heading("Sensitivity to what the study leaves open");
    const render::BoxPlot chart = sensitivityChart(s.sensitivity, defaults::clinicallySignificant.mm());
    if (!chart.boxes.empty())
      page.picture(writeChart(chart, figures, "sensitivity", files),
                   "Difference at the retractor of the chosen patients, one assumption changed at a time.");
    sensitivityTable(page, s);
  }

  std::vector<std::vector<std::string>> rows;
  for (const CaseRecord& r : s.records)
    if (r.outcome.status != CaseOutcome::Status::Done)
      rows.push_back(
          {r.outcome.id, r.outcome.status == CaseOutcome::Status::Rejected ? "rejected" : "failed", r.outcome.reason});
  if (!rows.empty()) {
    page.heading("Patients that were left out");
    page.table({"Patient", "What", "Why"}, rows);
  }
  rows.clear();
  for (const CaseRecord& r : s.records)
    rows.push_back({r.outcome.id, orDash(r.shear_kPa), orDash(r.youngs_kPa), orDash(r.volume_mL, 4), orDash(r.mean_mm),
                    orDash(r.at_retractor_mm), orDash(r.discretisation_mm, 2), orDash(r.p95_strain, 2),
                    r.outcome.status != CaseOutcome::Status::Done ? "–"
                    : r.linear_valid                              ? "valid"
                                                                  : "beyond its range"});
  page.heading("Every patient");
  page.table({"Patient", "µ, kPa", "E = 3µ, kPa", "Volume, mL", "Mean difference, mm", "At the retractor, mm",
              "Discretisation error, mm", "Strain (95 %)", "Linear theory"},
             rows);
  text("report.html", report::html(page));
  text("report.pdf", report::pdf(page));
  return files;
}

}  // namespace glisson::cohort::detail
