// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/rows.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "base/atomic_file.h"
#include "base/error.h"
#include "render/picture.h"
#include "report/text.h"

namespace glisson::study {
namespace {

std::string cell(double value) {
  return std::isfinite(value) ? report::number(value, 10) : std::string();
}

}  // namespace

void markPareto(std::vector<Row>& rows) {
  std::map<std::string, std::vector<std::size_t>> byReference;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].pareto = false;
    if (std::isfinite(rows[i].max_error_mm)) byReference[rows[i].reference].push_back(i);
  }
  for (const auto& [reference, group] : byReference) {
    std::vector<double> time, error;
    for (const std::size_t i : group) {
      time.push_back(rows[i].total_s());
      error.push_back(rows[i].max_error_mm);
    }
    for (const std::size_t best : render::paretoFront(time, error)) rows[group[best]].pareto = true;
  }
}

std::string csv(const std::vector<Row>& rows) {
  report::Csv out({"method", "resolution", "dofs", "build_s", "solve_s", "step_ms", "max_error_mm", "mean_error_mm",
                   "tip_error_mm", "reference", "pareto", "converged", "note"});
  for (const Row& r : rows)
    out.row({r.method, r.resolution, std::to_string(r.dofs), cell(r.build_s), cell(r.solve_s), cell(r.step_ms),
             cell(r.max_error_mm), cell(r.mean_error_mm), cell(r.tip_error_mm), r.reference, r.pareto ? "1" : "0",
             r.converged ? "1" : "0", r.note});
  return out.text();
}

std::string table(const std::vector<Row>& rows) {
  std::ostringstream t;
  const auto put = [&](const std::string& text, std::size_t width) {
    t << text << std::string(text.size() < width ? width - text.size() : 1, ' ');
  };
  const auto number = [&](double v, std::size_t width) { put(std::isfinite(v) ? report::number(v, 3) : "-", width); };
  std::string reference;
  for (const Row& r : rows) {
    if (r.reference != reference) {
      reference = r.reference;
      t << "\nagainst " << reference << "\n";
      put("  method", 34);
      put("resolution", 28);
      put("dofs", 9);
      put("build s", 10);
      put("solve s", 10);
      put("step ms", 10);
      put("max mm", 11);
      put("tip mm", 11);
      t << "\n";
    }
    put((r.pareto ? "* " : "  ") + r.method, 34);
    put(r.resolution, 28);
    put(std::to_string(r.dofs), 9);
    number(r.build_s, 10);
    number(r.solve_s, 10);
    number(r.step_ms, 10);
    number(r.max_error_mm, 11);
    number(r.tip_error_mm, 11);
    t << r.note << "\n";
  }
  t << "* on the Pareto front: nothing else is both faster and closer\n";
  return t.str();
}

render::XyChart chart(const std::vector<Row>& rows, const std::string& reference, const std::string& title,
                      const std::string& caption) {
  render::XyChart c;
  c.title = title;
  c.x = {.title = "Run time, model and solve (s)", .logarithmic = true};
  c.y = {.title = "Largest displacement error (mm)", .logarithmic = true};
  c.paretoFront = true;
  c.caption = caption;
  for (const Row& r : rows) {
    // A logarithmic axis has no place for an error of exactly zero.
    if (r.reference != reference || r.online || !std::isfinite(r.max_error_mm) || r.max_error_mm <= 0 ||
        r.total_s() <= 0)
      continue;
    auto s = std::find_if(c.series.begin(), c.series.end(), [&](const auto& one) { return one.name == r.method; });
    if (s == c.series.end()) {
      // Dashed: mesh-free. With twelve series a colour alone does not tell them apart.
      const bool meshfree =
          r.method.rfind("Voronoi", 0) == 0 || r.method.rfind("Wendland", 0) == 0 || r.method.rfind("MLS", 0) == 0;
      c.series.push_back({.name = r.method, .dashed = meshfree});
      s = std::prev(c.series.end());
    }
    s->x.push_back(r.total_s());
    s->y.push_back(r.max_error_mm);
  }
  return c;
}

std::vector<std::filesystem::path> writeChart(const std::filesystem::path& folder, const std::string& name,
                                              const render::XyChart& chart) {
  std::vector<std::filesystem::path> files;
  if (chart.series.empty()) return files;
  files.push_back(folder / (name + ".png"));
  render::writePng(files.back(), render::draw(chart));
  files.push_back(folder / (name + ".svg"));
  writeAtomically(files.back(), render::svg(chart));
  return files;
}

std::vector<std::filesystem::path> write(const std::filesystem::path& folder, const std::string& name,
                                         const std::vector<Row>& rows, const render::XyChart& chart) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) throw BadInput("cannot make the folder " + folder.string() + ": " + failed.message());
  std::vector<std::filesystem::path> files = {folder / (name + ".csv")};
  writeAtomically(files.back(), csv(rows));
  for (const auto& drawn : writeChart(folder, name, chart)) files.push_back(drawn);
  return files;
}

}  // namespace glisson::study
