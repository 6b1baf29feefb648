// SPDX-License-Identifier: GPL-3.0-or-later

// The command line: parses, calls one verb, turns exceptions into one line and an exit code.
#include <algorithm>
#include <array>
#include <clocale>
#include <cstdio>
#include <exception>
#include <iostream>
#include <locale>

#include "base/error.h"
#include "base/parallel.h"
#include "base/version.h"
#include "verbs.h"

namespace glisson::cli {
namespace {

int report(int code, const std::string& message) {
  std::string line = message;
  for (char& c : line)
    if (c == '\n' || c == '\r') c = ' ';
  // Words of damaged files may be no text: what is no UTF-8 is replaced, as JSON does.
  const std::string quoted = nlohmann::json(line).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  line = nlohmann::json::parse(quoted).get<std::string>();
  std::cerr << "glisson-cli: " << line << std::endl;
  return code;
}

/// Options may be written with '_' for '-': 3D Slicer passes no other names. Values are left as they are.
std::vector<std::string> withDashes(int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  for (std::string& word : words)
    if (word.size() > 2 && word.starts_with("--"))
      std::replace(word.begin(), word.begin() + static_cast<std::ptrdiff_t>(std::min(word.find('='), word.size())), '_',
                   '-');
  // The parser takes them from the end.
  std::reverse(words.begin(), words.end());
  return words;
}

/// Options that every verb takes. Returns that of the seed.
CLI::Option* addCommonOptions(CLI::App& app, Context& context) {
  app.add_flag("--json", context.json, "print one JSON object to stdout and nothing else there");
  app.add_flag("--quiet,-q", context.quiet, "no progress, no notes");
  app.add_flag("--verbose,-v", context.verbose, "say more on stderr");
  app.add_flag("--strict", context.strict, "refuse what would give a warning (exit code 3)");
  app.add_option("--threads", context.threads, "threads to use, 0 = one per core")->check(CLI::Range(0, 1024));
  CLI::Option* seed = app.add_option("--seed", context.seed, "seed of everything random");
  app.add_option("--output,-o", context.output, "folder or file to write to")->type_name(value::folderOrFile);
  app.add_option("--render-backend", context.renderBackend, "how pictures are drawn")
      ->check(CLI::IsMember({"auto", "egl", "x11"}));
  app.set_config("--config", "", "read options from an INI or TOML file");
  return seed;
}

/// In the order in which --help lists them.
constexpr std::array addVerbs = {addPhantom,   addScan,       addConvert, addMeasure, addInvert, addAgree,
                                 addPropose,   addPlan,       addRun,     addDemo,    addCohort, addLive,
                                 addExport,    addDeidentify, addPacs,    addRender,  addReplay, addValidate,
                                 addStability, addTradeoff,   addDocument};

/// More threads than cores gain nothing, and the thread library would complain in its own words.
void setThreads(const Context& context) {
  if (context.threads <= 0) return;
  const int cores = threadCount();
  if (context.threads > cores)
    context.note("note: " + std::to_string(context.threads) + " threads were asked for, " + std::to_string(cores) +
                 (cores == 1 ? " is" : " are") + " used: one per core");
  setThreadCount(std::min(context.threads, cores));
}

/// Calls the verb that was parsed; exceptions become one line and an exit code.
int act(const Context& context) {
  try {
    setThreads(context);
    return context.action();
  } catch (const BadInput& e) {
    return report(BadInputCode, e.what());
  } catch (const SolverFailed& e) {
    return report(NotConverged, e.what());
  } catch (const Cancelled&) {
    return report(CancelledCode, "cancelled");
  } catch (const std::bad_alloc&) {
    return report(Failed, "out of memory; use larger cells (cell_mm) or fewer frames");
  } catch (const std::exception& e) {
    return report(Failed, e.what());
  }
}

}  // namespace
}  // namespace glisson::cli

int main(int argc, char** argv) {
  using namespace glisson::cli;
  // Numbers are written the same way in every country.
  std::setlocale(LC_ALL, "C");
  std::locale::global(std::locale::classic());

  CLI::App app{
      "Glisson: patient-specific biomechanics for image-guided liver surgery.\nResearch use only, not for clinical "
      "use.",
      programName};
  app.set_version_flag("--version", std::string("glisson-cli ") + glisson::version());
  app.require_subcommand(1);
  app.fallthrough();
  Context context;
  const CLI::Option* seed = addCommonOptions(app, context);
  for (const auto add : addVerbs) add(app, context);
  try {
    app.parse(withDashes(argc, argv));
  } catch (const CLI::Success& e) {
    return app.exit(e);
  } catch (const CLI::Error& e) {
    // One line; CLI11 would write a second one.
    return report(Usage, std::string(e.what()) + " (glisson-cli --help tells what there is)");
  }
  context.seedGiven = seed->count() > 0;
  return act(context);
}
