// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/tradeoff.h"

#include "pipeline/scene.h"
#include "report/text.h"
#include "study_json.h"

namespace glisson::cli {
namespace {

int tradeoff(const std::filesystem::path& file, const study::TradeoffOptions& options, const Context& context) {
  pipeline::Scene scene = pipeline::readScene(file);
  if (context.seedGiven) scene.setup.seed = scene.setup.model.meshfree.seed = context.seed;
  const study::TradeoffStudy s = study::studyTradeoff(scene, options, context.progress());
  Json j;
  j["reference"] = {{"what", s.reference},
                    {"dofs", s.referenceDofs},
                    {"seconds", s.reference_s},
                    {"points", s.points},
                    {"largest_displacement_mm", s.largest_mm}};
  j["families"] = Json::array();
  for (const study::TradeoffStudy::Family& f : s.families)
    j["families"].push_back({{"name", f.name}, {"reference", f.reference}});
  j["rows"] = toJson(s.rows);
  j["skipped"] = s.skipped;
  std::string text = s.summary() + "\n" + study::table(s.rows);
  for (const std::string& line : s.skipped) text += "left out: " + line + "\n";
  j["files"] = Json::array();
  if (!context.output.empty()) {
    render::XyChart chart = study::chart(s.rows, s.reference, "Error against run time",
                                         "Error: largest distance from the " + s.summary() + ".");
    for (const study::Row& r : s.rows)
      if (r.online)
        chart.caption += " Condensed (not drawn): " + report::number(1e3 * r.solve_s, 2) +
                         " ms online for every node, " + report::number(r.build_s, 2) + " s once before, " +
                         report::number(r.max_error_mm, 3) + " mm.";
    chart.lines.push_back({.value = 1.64, .label = "1.64 mm voxel", .colour = {200, 0, 160}});
    std::vector<std::filesystem::path> files = study::write(context.output, "tradeoff", s.rows, chart);
    for (const study::TradeoffStudy::Family& f : s.families)
      for (auto& written : study::writeChart(context.output, "tradeoff-" + f.name,
                                             study::chart(s.rows, f.reference, "Error against run time",
                                                          "Error: largest distance from " + f.reference + ".")))
        files.push_back(std::move(written));
    for (const auto& written : files) {
      j["files"].push_back(written.string());
      text += "written " + written.string() + "\n";
    }
  }
  context.print(j, text);
  return Ok;
}

}  // namespace

void addTradeoff(CLI::App& app, Context& context) {
  CLI::App* verb = app.add_subcommand("tradeoff", "error against run time for a scene, against its own finest answer");
  auto scene = std::make_shared<std::filesystem::path>();
  auto options = std::make_shared<study::TradeoffOptions>();
  verb->add_option("scene", *scene, "scene.json, or case.json as the workstation saves it")
      ->type_name(value::file)
      ->required();
  verb->add_flag("--quick", options->quick, "fewer variants");
  verb->add_option("--budget", options->budget_s, "seconds after which no further variant is begun")
      ->check(CLI::Range(0.0, 86400.0));
  verb->add_option("--reference-cells", options->referenceCells, "largest number of cells of the reference")
      ->check(CLI::Range(1000, 4000000));
  verb->callback([&context, scene, options] {
    context.action = [&context, scene, options] { return tradeoff(*scene, *options, context); };
  });
}

}  // namespace glisson::cli
