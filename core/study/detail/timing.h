// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>

#include "base/progress.h"
#include "mechanics/dynamics.h"

namespace glisson::study {

/// Seconds since it was made.
class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Milliseconds that one implicit Euler step of 1 ms takes, from rest under the load f; mean over `steps` steps after
/// the first, factors and hierarchies being made already.
double stepTime_ms(mechanics::DynamicSystem& system, const Eigen::VectorXd& f, int steps, const Progress& progress);

}  // namespace glisson::study
