// SPDX-License-Identifier: GPL-3.0-or-later
#include <sstream>

#include "diagnostics_json.h"
#include "pipeline/plan.h"
#include "verbs.h"

namespace glisson::cli {

void addPlan(CLI::App& app, Context& context) {
  CLI::App* verb =
      app.add_subcommand("plan", "what a scene needs and what it leaves out, with reasons and predicted size");
  auto scene = std::make_shared<std::filesystem::path>();
  verb->add_option("scene", *scene, "scene.json, or case.json as the workstation saves it")
      ->type_name(value::file)
      ->required();
  verb->callback([&context, scene] {
    context.action = [&context, scene] {
      const pipeline::Scene read = pipeline::readScene(*scene);
      const Diagnostics said = pipeline::toldOf(read);
      refuseIfStrict(context, said);
      Json j;
      j["plan"] = Json::array();
      std::ostringstream text;
      for (const pipeline::PlanStep& s : pipeline::plan(read)) {
        j["plan"].push_back(
            {{"step", s.step}, {"needed", s.needed}, {"why", s.why}, {"seconds", s.seconds}, {"peak_MB", s.peak_MB}});
        text << (s.needed ? "  do    " : "  leave ") << s.step << ": " << s.why << "\n";
      }
      j["diagnostics"] = diagnosticsJson(said);
      for (const std::string& d : said.texts()) text << "  note  " << d << "\n";
      context.print(j, text.str());
      return Ok;
    };
  });
}

}  // namespace glisson::cli
