// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/progress.h"
#include "pipeline/detail/step_table.h"
#include "pipeline/plan.h"

namespace glisson::pipeline::detail {

/// The plan of a run while it is done: what each step took, and what turned out to be needless.
class StepLog {
 public:
  /// plan: as plan() gives it, one entry per StepId; its predicted memory is taken out. Both outlive the log.
  StepLog(std::vector<PlanStep>& plan, const Progress& progress);

  /// Does the work of a step where it is needed, notes its time and memory, and moves the progress on by its share of
  /// the predicted time.
  void run(const Step& step, RunState& state);

  /// What was done before the steps began: reading, seconds by name. A reading step that is not named took no time: the
  /// inputs were there already.
  void noteReading(const std::vector<std::pair<std::string, double>>& seconds);

  void explain(StepId step, const std::string& why);
  void leaveOut(StepId step, const std::string& why);

  /// Progress that stays where it is: for what is done between two steps.
  Progress here() const { return progress_.part(done_, done_); }

 private:
  PlanStep& of(StepId step) { return plan_[static_cast<std::size_t>(step)]; }

  std::vector<PlanStep>& plan_;
  const Progress& progress_;
  double expected_s_ = 0.0;
  double done_ = 0.0;  ///< share of the whole, in [0, 1]
};

}  // namespace glisson::pipeline::detail
