// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <map>
#include <sstream>

#include "study/stability.h"
#include "verbs.h"

namespace glisson::cli {
namespace {

int sweep(const study::StabilityOptions& options, const Context& context) {
  const std::vector<study::StabilityCase> cases = study::stabilitySweep(options, context.progress());
  Json j;
  j["cases"] = Json::array();
  std::ostringstream text;
  std::map<std::string, int> count;
  for (const study::StabilityCase& c : cases) {
    j["cases"].push_back({{"name", c.name},
                          {"expectation", c.expectation},
                          {"verdict", c.verdict},
                          {"iterations", c.iterations},
                          {"residual", orNull(c.residual)},
                          {"detail", c.detail},
                          {"seconds", c.seconds}});
    ++count[c.verdict];
    text << std::left << std::setw(20) << c.verdict << c.name << "\n"
         << std::string(20, ' ') << "expected: " << c.expectation << "\n"
         << std::string(20, ' ') << "found:    " << c.detail << "\n";
  }
  for (const auto& [verdict, n] : count) text << n << " " << verdict << "\n";
  j["as_expected"] = study::allAsExpected(cases);
  context.print(j, text.str());
  return study::allAsExpected(cases) ? Ok : Failed;
}

}  // namespace

void addStability(CLI::App& app, Context& context) {
  CLI::App* verb =
      app.add_subcommand("stability", "stiff and extreme scenes, each with its verdict; 0 when all are as expected");
  auto options = std::make_shared<study::StabilityOptions>();
  verb->add_flag("--quick", options->quick, "smaller grids");
  verb->callback([&context, options] { context.action = [&context, options] { return sweep(*options, context); }; });
}

}  // namespace glisson::cli
