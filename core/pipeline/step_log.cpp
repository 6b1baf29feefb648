// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/detail/step_log.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>

namespace glisson::pipeline::detail {
namespace {

/// A step that was predicted to take no time moves the progress too.
constexpr double least_s = 0.01;

double peak_MB() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

}  // namespace

StepLog::StepLog(std::vector<PlanStep>& plan, const Progress& progress) : plan_(plan), progress_(progress) {
  for (PlanStep& s : plan_) {
    expected_s_ += s.needed ? s.seconds + least_s : 0.0;
    s.peak_MB = 0.0;
  }
}

void StepLog::run(const Step& step, RunState& state) {
  PlanStep& planned = of(step.id);
  if (!planned.needed || step.work == nullptr) return;
  const double to = std::min(1.0, done_ + (planned.seconds + least_s) / expected_s_);
  const Progress part = progress_.part(done_, to);
  part.report(0.0, step.name);
  const auto start = std::chrono::steady_clock::now();
  step.work(state, part);
  done_ = to;
  if (!planned.needed) return;
  planned.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  planned.peak_MB = peak_MB();
}

void StepLog::noteReading(const std::vector<std::pair<std::string, double>>& seconds) {
  for (const StepId step : {StepId::ReadMri, StepId::ReadRoi, StepId::ReadMre, StepId::ReadMap}) {
    of(step).seconds = 0.0;
    for (const auto& [name, time_s] : seconds)
      if (name == nameOf(step)) {
        of(step).seconds = time_s;
        of(step).peak_MB = peak_MB();
      }
  }
}

void StepLog::explain(StepId step, const std::string& why) {
  of(step).why = why;
}

void StepLog::leaveOut(StepId step, const std::string& why) {
  of(step).needed = false;
  of(step).why = why;
  of(step).seconds = 0.0;
}

}  // namespace glisson::pipeline::detail
