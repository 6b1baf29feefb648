// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/run.h"

#include <fstream>
#include <optional>
#include <sstream>

#include "base/error.h"
#include "pipeline/detail/record.h"
#include "pipeline/detail/run_state.h"
#include "pipeline/detail/step_table.h"

namespace glisson::pipeline {
namespace {

/// Memory that is free on this machine, MB; nothing where it cannot be told.
std::optional<double> freeMemory_MB() {
  std::ifstream in("/proc/meminfo");
  for (std::string line; std::getline(in, line);)
    if (line.rfind("MemAvailable:", 0) == 0) return std::stod(line.substr(13)) / 1024.0;
  return {};
}

/// Refuses a scene whose largest step would not fit into the memory, before it is begun.
void requireMemory(const std::vector<PlanStep>& plan) {
  const std::optional<double> free_MB = freeMemory_MB();
  if (!free_MB) return;
  for (const PlanStep& s : plan)
    if (s.needed && s.peak_MB > 0.9 * *free_MB) {
      std::ostringstream text;
      text.precision(3);
      text << "this scene needs about " << s.peak_MB / 1024.0 << " GB for \"" << s.step << "\", and "
           << *free_MB / 1024.0 << " GB are free: use larger cells (cell_mm; twice the edge takes an eighth)";
      throw BadInput(text.str());
    }
}

/// What the scene's files hold, where it has any.
Inputs readInputs(const Scene& scene, const Progress& progress) {
  if (scene.geometry.kind == GeometrySpec::Kind::Box && !detail::Needs(scene).map) return {};
  return loadInputs(scene, progress.part(0.0, 0.05));
}

/// The record, and where there is a folder, the scene beside it.
void writeRecord(detail::RunState& state) {
  RunResult& r = state.result;
  r.json = detail::runRecord(state.scene, r, state.options.palette, state.options.language);
  if (!state.writer) return;
  r.files.insert(r.files.begin(), state.options.output / "run.json");
  state.writer->text("scene.json", detail::sceneSeenFrom(state.scene, state.options.output));
  state.writer->text("run.json", r.json + "\n");
}

}  // namespace

RunResult run(const Scene& scene, const RunOptions& options, const Progress& progress, const Inputs* given) {
  if (scene.setup.loads.empty() && scene.setup.supports.empty())
    throw BadInput("the scene has neither supports nor loads; give at least one support and one load");
  RunResult r;
  r.diagnostics.add(toldOf(scene));
  r.plan = plan(scene);
  requireMemory(r.plan);
  std::optional<Inputs> loaded;
  if (!given) loaded = readInputs(scene, progress);
  const Inputs& inputs = given ? *given : *loaded;
  r.warnings = inputs.warnings;

  detail::RunState state(scene, options, inputs, r, progress);
  state.log.noteReading(given ? std::vector<std::pair<std::string, double>>{} : inputs.seconds);
  for (const detail::Step& step : detail::stepTable()) {
    if (step.writes && options.output.empty()) continue;
    // What is written is made of what the steps before have left: the images themselves, which are large, may go.
    if (step.writes && loaded) {
      loaded->mri.reset();
      loaded->liver.reset();
    }
    if (step.before) step.before(state);
    state.log.run(step, state);
    if (step.after) step.after(state);
  }
  writeRecord(state);
  if (state.pictures) r.picture = std::move(state.pictures->scene);
  progress.report(1.0, "done");
  return r;
}

}  // namespace glisson::pipeline
