// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/plan.h"

#include "pipeline/detail/forecast.h"
#include "pipeline/detail/step_table.h"

namespace glisson::pipeline {

std::vector<PlanStep> plan(const Scene& scene) {
  const detail::Forecast forecast(scene);
  std::vector<PlanStep> steps(detail::stepCount);
  for (const detail::Step& step : detail::stepTable()) {
    detail::Estimate e = step.estimate(forecast);
    steps[static_cast<std::size_t>(step.id)] = {step.name, e.needed, std::move(e.why), e.needed ? e.seconds : 0.0,
                                                e.needed ? e.peak_MB : 0.0};
  }
  return steps;
}

}  // namespace glisson::pipeline
