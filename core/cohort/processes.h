// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/progress.h"

namespace glisson::cohort {

/// One command to run in a process of its own.
struct Job {
  std::string name;  ///< for the status line
  std::vector<std::string> arguments;
};

/// How a process ended.
struct JobOutcome {
  int exitCode = -1;  ///< −1 where a signal ended it
  int signal = 0;     ///< that ended it, 0 = none
  std::string standardOutput;
  std::string message;  ///< last line on its standard error
  double seconds = 0.0;
  double peak_MB = 0.0;
};

/// Runs jobs, `parallel` at a time, in order; `done` is called in this thread as each one ends. Children die with this
/// process, however it ends. Where a stop is requested they are asked to end, given a second, then killed, and
/// Cancelled is thrown. Throws BadInput where the executable cannot be started.
void runJobs(const std::filesystem::path& executable, const std::vector<Job>& jobs, int parallel,
             const std::function<void(std::size_t, const JobOutcome&)>& done, const Progress& progress = {});

/// Memory to reckon with for one patient, MB: a 1.6 L liver in two-pixel cells with its MRI, vessels and pictures.
inline constexpr double expectedPeak_MB = 1000.0;

/// Threads for each of so many processes at a time; at least 1.
int threadsEach(int parallel);

/// Cores, or fewer where the free memory would not hold as many patients of `peak_MB`; at least 1.
int jobsThatFit(double peak_MB);

}  // namespace glisson::cohort
