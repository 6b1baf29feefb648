#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/quantity.h"
#include "base/version.h"
#include "cohort/detail/report_words.h"
#include "cohort/detail/sensitivity_chart.h"
#include "cohort/detail/summary.h"
#include "render/charts.h"
#include "render/picture.h"
#include "render/svg_painter.h"

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
Json toJson(const Spread& s) {
  return {{"n", s.n},
          {"mean", orNull(s.mean)},
          {"sd", orNull(s.sd)},
          {"median", orNull(s.median)},
          {"min", orNull(s.min)},
          {"max", orNull(s.max)}};
}

render::Histogram histogram(const StiffnessStudy& s) {
  render::Histogram h;
  h.title = "Mean liver stiffness of " + patients(s.values_kPa.size());
  h.x.title = std::string("Mean ") + (s.asPublished ? "Young's modulus E = 3µ (kPa)" : "shear modulus µ (kPa)");
  h.y.title = "Number of patients";
  h.values = s.values_kPa;
  h.binWidth = s.asPublished ? 1.5 : 0.5;
  h.lines = {{s.atlas_kPa, "atlas " + number(s.atlas_kPa) + " kPa", orange}};
  h.caption = percent(s.fractionOver1kPa) + " more than 1 kPa stiffer than the atlas, " + percent(s.fractionOverTwice) +
              " more than twice as stiff.";
  return h;
}

render::BoxPlot box(const char* title, const std::vector<double>& values, const render::ReferenceLine& line,
                    const std::string& caption) {
  render::BoxPlot b;
  b.title = title;
  b.y.title = "Displacement difference, MRE − atlas (mm)";
  b.y.low = 0.0;
  b.boxes = {{patients(values.size()), values}};
  b.lines = {line};
  b.caption = caption;
  return b;
}

SensitivityChart sensitivityChart(const Summary& s) {
  SensitivityChart c;
  c.title = "Which assumption changes the conclusion?";
  c.axis = "Difference at the retractor, MRE against atlas (mm)";
  c.line = {defaults::clinicallySignificant.mm(), "clinically significant, 5 mm", orange};
  c.caption =
      "The chosen patients under one changed assumption at a time. Rows on 10 mm cells are to be compared with each "
      "other only.";
  for (const Chosen& chosen : s.chosen) c.patients.push_back(chosen.what + " (" + chosen.id + ")");
  for (const SensitivityRow& r : s.sensitivity) {
    auto at = std::find_if(c.rows.begin(), c.rows.end(), [&](const auto& x) { return x.assumption == r.variation; });
    if (at == c.rows.end()) at = c.rows.insert(at, {r.variation, std::vector<double>(s.chosen.size(), std::nan(""))});
    for (std::size_t p = 0; p < s.chosen.size(); ++p)
      if (s.chosen[p].id == r.id) at->values[p] = r.at_retractor_mm;
  }
  return c;
}

template <typename Chart>
void addChart(report::Page& page, const Chart& chart, const std::string& name, const std::string& caption,
              const fs::path& folder, std::vector<fs::path>& files) {
  fs::create_directories(folder);
  const render::ChartSize size;
  const fs::path png = folder / (name + ".png"), vector = folder / (name + ".svg");
  render::Picture picture = render::blankPicture(size.width, size.height, {255, 255, 255});
  render::RasterPainter pixels(picture);
  render::SvgPainter lines(size.width, size.height);
  for (render::Painter* painter : {static_cast<render::Painter*>(&pixels), static_cast<render::Painter*>(&lines)})
    paint(*painter, chart, size);
  render::writePng(png, picture);
  writeWhole(vector, lines.document());
  files.insert(files.end(), {png, vector});
  page.drawing(
      png, [chart, size](render::Painter& painter) { paint(painter, chart, size); }, size, caption);
}

std::string patientsCsv(const Summary& s) {
  report::Csv csv({"case", "status", "shear_kPa", "youngs_kPa", "sd_kPa", "voxels", "volume_mL", "mean_mm", "p95_mm",
                   "max_mm", "at_retractor_mm", "vessel_mean_mm", "vessel_beyond_5mm", "discretisation_mm",
                   "difference_error_mm", "p95_strain", "rotation_deg", "linear_valid", "dofs", "travel_mm",
                   "atlas_travel_mm", "travel_difference_mm", "pose_height_mm", "kinematics", "kinematics_valid"});
  const auto cell = [](double v) { return std::isfinite(v) ? number(v, 10) : std::string(); };
  for (const CaseRecord& r : s.records) {
    constexpr std::array<const char*, 3> status = {"done", "rejected", "failed"};
    csv.row({r.outcome.id, status[static_cast<std::size_t>(r.outcome.status)], cell(r.shear_kPa), cell(r.youngs_kPa),
             cell(r.sd_kPa), std::to_string(r.voxels), cell(r.volume_mL), cell(r.mean_mm), cell(r.p95_mm),
             cell(r.max_mm), cell(r.at_retractor_mm), cell(r.vessel_mean_mm), cell(r.vessel_beyond_5mm),
             cell(r.discretisation_mm), cell(r.difference_error_mm), cell(r.p95_strain), cell(r.rotation_deg),
             r.linear_valid ? "yes" : "no", std::to_string(r.dofs), cell(r.travel_mm), cell(r.atlas_travel_mm),
             cell(r.travel_difference_mm), cell(r.pose_height_mm), r.kinematics, r.kinematics_valid ? "yes" : "no"});
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
  if (b.travel.n > 0) {
    j["retraction"]["travel_difference_mm"] = toJson(b.travel);
    j["retraction"]["fraction_travel_clinically_significant"] = b.fractionTravelSignificant;
  }
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

  report::Page page("Cohort of " + patients(s.records.size()));
  const RetractionStudy& b = s.retraction;
  page.table({{"Patients tried", std::to_string(b.tried)},
              {"Rejected", std::to_string(b.rejected)},
              {"Failed", std::to_string(b.failed)},
              {"Left in the retraction study", std::to_string(b.left)},
              {"Software", "Glisson " + version()}});
  inShort(page, s);
  methods(page, s);

  page.heading("Stiffness over the cohort");
  if (!s.stiffness.values_kPa.empty()) {
    const render::Histogram h = histogram(s.stiffness);
    addChart(page, h, "stiffness-histogram",
             "Mean " + quantityOf(s.stiffness) + ": " + inWords(s.stiffness.spread, "kPa") + ". " +
                 percent(s.stiffness.fractionOver1kPa) + " of the patients are more than 1 kPa stiffer than the " +
                 number(s.stiffness.atlas_kPa) + " kPa atlas, " + percent(s.stiffness.fractionOverTwice) +
                 " more than twice as stiff.",
             figures, files);
  } else {
    page.warning("No patient's stiffness could be measured.");
  }
  for (const CaseRecord& r : s.records)
    for (const std::string& w : r.warnings)
      if (w.rfind(notMeasured, 0) == 0) page.warning(r.outcome.id + ": " + w);

  page.heading("Retraction: measured against atlas stiffness");
  if (b.left > 0) {
    addChart(page,
             box("Mean over the whole liver", b.mean_mm, {defaults::mriVoxel.mm(), "one MRI voxel, 1.64 mm", magenta},
                 percent(b.fractionWithinVoxel) + " of the patients within one voxel."),
             "difference-mean", "Mean displacement difference over the liver: " + inWords(b.mean, "mm") + ".", figures,
             files);
    addChart(page,
             box("At the retractor", b.at_retractor_mm,
                 {defaults::clinicallySignificant.mm(), "clinically significant, 5 mm", orange},
                 percent(b.fractionSignificant) + " of the patients at 5 mm or more."),
             "difference-retractor", "Displacement difference at the retractor: " + inWords(b.atRetractor, "mm") + ".",
             figures, files);
    if (b.travel.n > 0)
      addChart(page,
               box("Travel of the bar", b.travel_mm,
                   {defaults::clinicallySignificant.mm(), "clinically significant, 5 mm", orange},
                   percent(b.fractionTravelSignificant) + " of the patients at 5 mm or more."),
               "difference-travel",
               "How far the bar goes with measured and with atlas stiffness, amount of the difference: " +
                   inWords(b.travel, "mm") + ".",
               figures, files);
    reservations(page, s);
  } else {
    page.warning("No retraction came to an end; the reasons are listed below.");
  }

  const bool shown = !s.pictures.empty() || !s.pictureNotes.empty();
  if (shown) page.heading("Four patients chosen by the difference at the retractor");
  for (const Chosen& c : s.chosen) {
    if (!shown) break;
    const auto pictures = s.pictures.find(c.id);
    const auto note = s.pictureNotes.find(c.id);
    const std::string who =
        c.what + ", " + c.id + ": " + number(c.at_retractor_mm, 3) + " mm at the retractor" +
        (c.passedOver == 0 ? "" : " (" + std::to_string(c.passedOver) + " nearer to it cannot be drawn)") + ". ";
    if (pictures != s.pictures.end())
      for (const fs::path& p : pictures->second) {
        page.picture(p, who +
                            "Blue: measured stiffness; red: atlas; purple where they agree; the green grid shows "
                            "millimetres.");
        files.push_back(p);
      }
    if (note != s.pictureNotes.end())
      page.warning(who + note->second);
    else if (pictures == s.pictures.end() || pictures->second.size() < shownPictures)
      page.warning(who +
                   "Not every picture could be drawn on this machine; where it can be, the same command adds it.");
  }

  if (std::any_of(s.sensitivity.begin(), s.sensitivity.end(),
                  [&](const SensitivityRow& r) { return r.variation != s.sensitivity.front().variation; })) {
    page.heading("Sensitivity to what the study leaves open");
    addChart(page, sensitivityChart(s), "sensitivity",
             "Difference at the retractor of the chosen patients, one assumption changed at a time.", figures, files);
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
                    orDash(r.at_retractor_mm), orDash(r.difference_error_mm, 2), orDash(r.discretisation_mm, 2),
                    orDash(r.p95_strain, 2),
                    orDash(r.travel_mm), orDash(r.atlas_travel_mm), r.kinematics.empty() ? "–" : r.kinematics,
                    r.outcome.status != CaseOutcome::Status::Done ? "–"
                    : r.kinematics_valid                          ? "valid"
                                                                  : "beyond its range"});
  page.heading("Every patient");
  page.table({"Patient", "µ, kPa", "E = 3µ, kPa", "Volume, mL", "Mean difference, mm", "At the retractor, mm",
              "Its discretisation error, mm", "That of the worst place, mm", "Strain (95 %)", "Travel of the bar, mm",
              "With atlas, mm", "Kinematics", "Theory"},
             rows);
  text("report.html", report::html(page));
  text("report.pdf", report::pdf(page));
  return files;
}

}  // namespace glisson::cohort::detail
