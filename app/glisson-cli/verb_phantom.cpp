// SPDX-License-Identifier: GPL-3.0-or-later
#include <sstream>

#include "base/error.h"
#include "phantom/phantom.h"
#include "verbs.h"

namespace glisson::cli {

void addPhantom(CLI::App& app, Context& context) {
  CLI::App* verb = app.add_subcommand("phantom", "synthetic patients as DICOM, each with scene.json and truth.json");
  auto options = std::make_shared<phantom::PhantomOptions>();
  auto cohort = std::make_shared<std::string>();
  verb->add_option("--cases", options->cases, "number of patients")->check(CLI::Range(1, 9999));
  verb->add_option("--cohort", *cohort, "paper: stiffness drawn as in the published cohort")
      ->check(CLI::IsMember({"paper"}));
  auto shape = std::make_shared<std::string>();
  std::vector<std::string> shapes;
  for (const auto& [s, name] : phantom::liverShapes) shapes.emplace_back(name);
  verb->add_option("--shape", *shape, "how the livers are built: usual, or odd in one way (default: usual)")
      ->check(CLI::IsMember(shapes));
  verb->callback([&context, options, cohort, shape] {
    context.action = [&context, options, cohort, shape] {
      if (context.output.empty()) throw BadInput("phantom needs a folder to write to: give --output");
      options->seed = context.seed;
      options->paperCohort = *cohort == "paper";
      options->shape = phantom::liverShapeNamed(*shape).value_or(phantom::LiverShape::Usual);
      const auto folders = phantom::writeCohort(*options, context.output, context.progress());
      Json j;
      j["seed"] = context.seed;
      j["patients"] = Json::array();
      std::ostringstream text;
      for (const auto& f : folders) {
        j["patients"].push_back(f.string());
        text << "written " << f.string() << "\n";
      }
      context.print(j, text.str());
      return Ok;
    };
  });
}

}  // namespace glisson::cli
