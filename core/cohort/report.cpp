// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "base/quantity.h"
#include "base/version.h"
#include "cohort/detail/report_words.h"
#include "cohort/detail/sensitivity_chart.h"
#include "cohort/detail/summary.h"
#include "cohort/detail/summary_files.h"
#include "render/charts.h"
#include "render/picture.h"
#include "render/svg_painter.h"

namespace glisson::cohort::detail {
namespace {

namespace fs = std::filesystem;
using report::number;

constexpr render::Rgb magenta{200, 0, 160};
constexpr render::Rgb orange{230, 126, 0};

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

std::string wordOf(CaseOutcome::Status status) {
  return status == CaseOutcome::Status::Rejected ? "rejected" : "failed";
}

/// 95 % of the difference at the retractor and the probability of 5 mm, where the run says how sure it is.
std::string intervalOf(const CaseRecord& r) {
  if (!std::isfinite(r.probability_beyond_5mm)) return "";
  return " (" + number(r.at_retractor_low_mm, 3) + " to " + number(r.at_retractor_high_mm, 3) + "; " +
         number(100.0 * r.probability_beyond_5mm, 2) + " %)";
}

/// The report of a cohort, section by section; its figures are written on the way.
class SummaryPage {
 public:
  SummaryPage(const Summary& summary, const fs::path& figures, std::vector<fs::path>& files)
      : s_(summary), figures_(figures), files_(files), page_("Cohort of " + patients(summary.records.size())) {}

  /// Everything, in the order in which it is read.
  const report::Page& write() {
    counts();
    inShort(page_, s_);
    methods(page_, s_);
    stiffness();
    retraction();
    chosen();
    sensitivity();
    leftOut();
    everyPatient();
    return page_;
  }

 private:
  template <typename Chart>
  void chart(const Chart& chart, const std::string& name, const std::string& caption) {
    addChart(page_, chart, name, caption, figures_, files_);
  }
  void counts();
  void stiffness();
  void retraction();
  void chosen();
  void sensitivity();
  void leftOut();
  void everyPatient();

  const Summary& s_;
  const fs::path& figures_;
  std::vector<fs::path>& files_;
  report::Page page_;
};

void SummaryPage::counts() {
  const RetractionStudy& b = s_.retraction;
  page_.table({{"Patients tried", std::to_string(b.tried)},
               {"Rejected", std::to_string(b.rejected)},
               {"Failed", std::to_string(b.failed)},
               {"Left in the retraction study", std::to_string(b.left)},
               {"Software", "Glisson " + version()}});
}

void SummaryPage::stiffness() {
  const StiffnessStudy& a = s_.stiffness;
  page_.heading("Stiffness over the cohort");
  if (!a.values_kPa.empty())
    chart(histogram(a), "stiffness-histogram",
          "Mean " + quantityOf(a) + ": " + inWords(a.spread, "kPa") + ". " + percent(a.fractionOver1kPa) +
              " of the patients are more than 1 kPa stiffer than the " + number(a.atlas_kPa) + " kPa atlas, " +
              percent(a.fractionOverTwice) + " more than twice as stiff.");
  else
    page_.warning("No patient's stiffness could be measured.");
  for (const CaseRecord& r : s_.records)
    for (const std::string& w : r.warnings)
      if (w.rfind(notMeasured, 0) == 0) page_.warning(r.outcome.id + ": " + w);
}

void SummaryPage::retraction() {
  const RetractionStudy& b = s_.retraction;
  const render::ReferenceLine significant{defaults::clinicallySignificant.mm(), "clinically significant, 5 mm", orange};
  page_.heading("Retraction: measured against atlas stiffness");
  if (b.left == 0) {
    page_.warning("No retraction came to an end; the reasons are listed below.");
    return;
  }
  chart(box("Mean over the whole liver", b.mean_mm, {defaults::mriVoxel.mm(), "one MRI voxel, 1.64 mm", magenta},
            percent(b.fractionWithinVoxel) + in95(b.sureWithinVoxel) + " of the patients within one voxel."),
        "difference-mean", "Mean displacement difference over the liver: " + inWords(b.mean, "mm") + ".");
  chart(box("At the retractor", b.at_retractor_mm, significant,
            percent(b.fractionSignificant) + in95(b.sureSignificant) + " of the patients at 5 mm or more."),
        "difference-retractor", "Displacement difference at the retractor: " + inWords(b.atRetractor, "mm") + ".");
  if (b.travel.n > 0)
    chart(
        box("Travel of the bar", b.travel_mm, significant,
            percent(b.fractionTravelSignificant) + in95(b.sureTravelSignificant) + " of the patients at 5 mm or more."),
        "difference-travel",
        "How far the bar goes with measured and with atlas stiffness, amount of the difference: " +
            inWords(b.travel, "mm") + ".");
  howSure(page_, s_);
  reservations(page_, s_);
}

void SummaryPage::chosen() {
  if (s_.pictures.empty() && s_.pictureNotes.empty()) return;
  page_.heading("Four patients chosen by the difference at the retractor");
  for (const Chosen& c : s_.chosen) {
    const auto pictures = s_.pictures.find(c.id);
    const auto note = s_.pictureNotes.find(c.id);
    const std::string who =
        c.what + ", " + c.id + ": " + number(c.at_retractor_mm, 3) + " mm at the retractor" +
        (c.passedOver == 0 ? "" : " (" + std::to_string(c.passedOver) + " nearer to it cannot be drawn)") + ". ";
    if (pictures != s_.pictures.end())
      for (const fs::path& p : pictures->second) {
        page_.picture(p, who +
                             "Blue: measured stiffness; red: atlas; purple where they agree; the green grid shows "
                             "millimetres.");
        files_.push_back(p);
      }
    if (note != s_.pictureNotes.end())
      page_.warning(who + note->second);
    else if (pictures == s_.pictures.end() || pictures->second.size() < shownPictures)
      page_.warning(who +
                    "Not every picture could be drawn on this machine; where it can be, the same command adds it.");
  }
}

void SummaryPage::sensitivity() {
  if (std::all_of(s_.sensitivity.begin(), s_.sensitivity.end(),
                  [&](const SensitivityRow& r) { return r.variation == s_.sensitivity.front().variation; }))
    return;
  page_.heading("Sensitivity to what the study leaves open");
  chart(sensitivityChart(s_), "sensitivity",
        "Difference at the retractor of the chosen patients, one assumption changed at a time.");
  sensitivityTable(page_, s_);
}

void SummaryPage::leftOut() {
  std::vector<std::vector<std::string>> rows;
  for (const CaseRecord& r : s_.records)
    if (r.outcome.status != CaseOutcome::Status::Done)
      rows.push_back({r.outcome.id, wordOf(r.outcome.status), r.outcome.reason});
  if (rows.empty()) return;
  page_.heading("Patients that were left out");
  page_.table({"Patient", "What", "Why"}, rows);
}

void SummaryPage::everyPatient() {
  std::vector<std::vector<std::string>> rows;
  for (const CaseRecord& r : s_.records)
    rows.push_back({r.outcome.id, orDash(r.shear_kPa), orDash(r.youngs_kPa), orDash(r.volume_mL, 4), orDash(r.mean_mm),
                    orDash(r.at_retractor_mm) + intervalOf(r), orDash(r.difference_error_mm, 2),
                    orDash(r.discretisation_mm, 2), orDash(r.p95_strain, 2), orDash(r.travel_mm),
                    orDash(r.atlas_travel_mm), r.kinematics.empty() ? "–" : r.kinematics,
                    r.outcome.status != CaseOutcome::Status::Done ? "–"
                    : r.kinematics_valid                          ? "valid"
                                                                  : "beyond its range"});
  page_.heading("Every patient");
  page_.table(
      {"Patient", "µ, kPa", "E = 3µ, kPa", "Volume, mL", "Mean difference, mm",
       s_.retraction.sureSignificant ? "At the retractor, mm (95 %; probability of 5 mm)" : "At the retractor, mm",
       "Its discretisation error, mm", "That of the worst place, mm", "Strain (95 %)", "Travel of the bar, mm",
       "With atlas, mm", "Kinematics", "Theory"},
      rows);
}

}  // namespace

std::vector<fs::path> writeSummary(const Summary& s, const CohortOptions& options, std::string& json) {
  std::vector<fs::path> files;
  const auto text = [&](const char* name, const std::string& content) {
    writeWhole(options.output / name, content);
    files.push_back(options.output / name);
  };
  json = summaryJson(s);
  text("cohort.json", json);
  text("patients.csv", patientsCsv(s));
  text("rejected.csv", rejectedCsv(s));
  const fs::path figures = options.output / "figures";
  SummaryPage summary(s, figures, files);
  const report::Page& page = summary.write();
  text("report.html", report::html(page));
  text("report.pdf", report::pdf(page));
  return files;
}

}  // namespace glisson::cohort::detail
