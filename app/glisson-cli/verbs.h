// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "base/progress.h"
#include "option_table.h"

namespace glisson::cli {

using Json = nlohmann::ordered_json;

/// A number, or null where it does not exist.
inline Json orNull(double v) {
  return std::isfinite(v) ? Json(v) : Json(nullptr);
}

/// Exit codes of the command line.
enum ExitCode {
  Ok = 0,
  Failed = 1,
  Usage = 2,
  BadInputCode = 3,
  NotConverged = 4,
  CancelledCode = 5,
  PartialBatch = 6
};

/// What every verb shares: the common options and where output goes.
struct Context {
  bool json = false;
  bool quiet = false;
  bool verbose = false;
  bool strict = false;  ///< warnings are refusals
  int threads = 0;
  std::uint64_t seed = 1;
  bool seedGiven = false;
  std::filesystem::path output;
  std::string renderBackend = "auto";
  /// The verb that was asked for, ready to run; returns an exit code.
  std::function<int()> action;

  /// Progress on stderr: a bar on a terminal, lines in a log, nothing when quiet. Ctrl+C cancels.
  Progress progress() const;
  /// Prints the object to stdout when --json, else the human text. An object with warnings and no diagnostics gets
  /// them; with --strict it is refused (BadInput).
  void print(const Json& object, const std::string& text) const;
  /// One line on stderr, unless quiet.
  void note(const std::string& line) const;
};

void addPhantom(CLI::App& app, Context& context);
void addScan(CLI::App& app, Context& context);
void addConvert(CLI::App& app, Context& context);
void addMeasure(CLI::App& app, Context& context);
void addInvert(CLI::App& app, Context& context);
void addAgree(CLI::App& app, Context& context);
void addPropose(CLI::App& app, Context& context);
void addPacs(CLI::App& app, Context& context);
void addPlan(CLI::App& app, Context& context);
void addRender(CLI::App& app, Context& context);
void addReplay(CLI::App& app, Context& context);
void addRun(CLI::App& app, Context& context);
void addDemo(CLI::App& app, Context& context);
void addCohort(CLI::App& app, Context& context);
void addLive(CLI::App& app, Context& context);
void addExport(CLI::App& app, Context& context);
void addDeidentify(CLI::App& app, Context& context);
void addValidate(CLI::App& app, Context& context);
void addStability(CLI::App& app, Context& context);
void addTradeoff(CLI::App& app, Context& context);
void addDocument(CLI::App& app, Context& context);

}  // namespace glisson::cli
