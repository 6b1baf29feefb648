// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/beam_report.h"

#include <cmath>

#include "base/atomic_file.h"
#include "base/version.h"
#include "render/charts.h"
#include "report/page.h"
#include "report/text.h"

namespace glisson::study {
namespace {

namespace fs = std::filesystem;
using report::number;

constexpr render::Rgb magenta{200, 0, 160}, green{0, 120, 80};

struct Against {
  const char* reference;
  const char* name;  ///< of the files
  std::string title, caption;
  double gap_mm;  ///< what a method without any error would show; 0: nothing
};

std::vector<Against> references(const BeamStudy& s) {
  return {
      {converged3d, "validate-beam", "Cantilever: error against run time, converged 3-D solution", s.caption(), 0.0},
      {timoshenko, "validate-beam-timoshenko", "Cantilever: error against run time, Timoshenko's theory",
       "Each method with a root that is free to contract, as the theory assumes; converged 3-D lies " +
           number(std::abs(s.gapTimoshenkoTip_mm), 3) + " mm from the theory at the tip.",
       std::abs(s.gapTimoshenkoTip_mm)},
      {eulerBernoulli, "validate-beam-euler-bernoulli",
       "Cantilever: error against run time, Euler-Bernoulli's theory (as published)",
       "The theory leaves shear out, and this beam is short: converged 3-D lies " +
           number(s.gapEulerBernoulliAxis_mm, 3) +
           " mm from it. A method near that line is right; one below it errs towards the theory.",
       s.gapEulerBernoulliAxis_mm}};
}

render::XyChart chartOf(const BeamStudy& s, const Against& a) {
  render::XyChart c = chart(s.rows, a.reference, a.title, a.caption);
  c.lines.push_back({.value = s.allowed_mm, .label = "1 % of a 1.64 mm voxel", .colour = magenta});
  if (a.gap_mm > 0.0) c.lines.push_back({.value = a.gap_mm, .label = "converged 3-D", .colour = green});
  return c;
}

std::string mm(double v) {
  return number(v, 3) + " mm";
}

void words(report::Page& page, const BeamStudy& s) {
  page.heading("Methods");
  page.paragraph(
      "A cantilever of 50 × 10 × 10 mm, Young's modulus 12 kPa, Poisson's ratio " + number(s.options.poisson, 3) +
      ", under a distributed load of " + number(1e3 * s.load_N_m, 4) +
      " mN/m along its height, which bends the tip by " + number(s.options.tip_mm, 3) +
      " mm in Euler-Bernoulli's theory. The deflection of the central axis is compared at 31 stations; an "
      "error is the largest of them. Run time is building the model and solving once; a step is one implicit "
      "Euler step of 1 ms. Run times are of this machine and differ from run to run; errors do not.");
  page.table({"Reference", "Tip", "What it is"},
             {{"Converged 3-D", mm(s.clamped.axis_mm.back()),
               "clamped root, grid " + s.clamped.grid + " and two coarser ones, extrapolated at the observed order " +
                   number(s.clamped.order, 3) + "; uncertain by " + mm(s.clamped.uncertainty_mm)},
              {"Timoshenko", mm(s.timoshenkoTip_mm),
               "with shear; converged 3-D with a root free to contract lies " + mm(s.gapTimoshenkoTip_mm) + " from it"},
              {"Euler-Bernoulli", mm(s.eulerBernoulliTip_mm),
               "without shear, as published; converged 3-D, clamped, lies " + mm(s.gapEulerBernoulliTip_mm) +
                   " from it at the tip: a difference of theories, whatever the method"}});
  page.heading("Goals");
  std::vector<std::vector<std::string>> goals;
  for (const BeamGoal& g : s.goals)
    goals.push_back({g.met() ? "met" : "missed", g.what, number(g.poisson, 3),
                     number(g.value, 3) + (g.quantity == "mm" ? " mm" : " times"),
                     (g.quantity == "mm" ? "at most " : "at least ") + number(g.limit, 3), g.beside});
  page.table({"", "What", "Poisson's ratio", "Measured", "Wanted", "Beside"}, goals);
}

void rowsOf(report::Page& page, const BeamStudy& s, const char* reference) {
  std::vector<std::vector<std::string>> rows;
  const auto cell = [](double v) { return std::isfinite(v) ? number(v, 3) : std::string("–"); };
  for (const Row& r : s.rows)
    if (r.reference == reference)
      rows.push_back({(r.pareto ? "* " : "") + r.method, r.resolution, std::to_string(r.dofs), cell(r.build_s),
                      cell(r.solve_s), cell(r.step_ms), cell(r.max_error_mm), cell(r.tip_error_mm), r.note});
  page.table({"Method", "Resolution", "Unknowns", "Build, s", "Solve, s", "Step, ms", "Largest error, mm",
              "Error at the tip, mm", "Note"},
             rows);
}

}  // namespace

std::vector<fs::path> writeBeamStudy(const fs::path& folder, const BeamStudy& s) {
  std::vector<fs::path> files;
  report::Page page("Validation: cantilever under a distributed load");
  words(page, s);
  for (const Against& a : references(s)) {
    const render::XyChart chart = chartOf(s, a);
    // The table of all rows goes with the first chart.
    const std::vector<fs::path> drawn =
        files.empty() ? write(folder, a.name, s.rows, chart) : writeChart(folder, a.name, chart);
    files.insert(files.end(), drawn.begin(), drawn.end());
    page.heading(std::string("Against ") + a.reference);
    if (!chart.series.empty()) page.chart(folder / (std::string(a.name) + ".png"), chart, a.caption);
    rowsOf(page, s, a.reference);
  }
  page.paragraph("* on the Pareto front: nothing else is both faster and closer. Glisson " + version() + ", commit " +
                 buildCommit() + ".");
  for (const auto& [name, text] : {std::pair{"report.html", report::html(page)}, {"report.pdf", report::pdf(page)}}) {
    files.push_back(folder / name);
    writeAtomically(files.back(), text);
  }
  return files;
}

}  // namespace glisson::study
