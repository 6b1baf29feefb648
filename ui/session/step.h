// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>
#include <array>

namespace glisson::session {

/// The five steps of the work.
enum class Step { Load, Segment, Model, Retract, Compare };
inline constexpr std::array<Step, 5> steps = {Step::Load, Step::Segment, Step::Model, Step::Retract, Step::Compare};

/// Empty: something upstream is missing. Ready: can be done now. Done: up to date. Stale: done before, but something
/// upstream has changed since.
enum class StepState { Empty, Ready, Running, Done, Stale, Failed };

struct StepStatus {
  StepState state = StepState::Empty;
  QString detail;  ///< one sentence: what is missing, what there is, what failed
  bool operator==(const StepStatus&) const = default;
};

}  // namespace glisson::session
