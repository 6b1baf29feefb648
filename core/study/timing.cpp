// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/detail/timing.h"

namespace glisson::study {

double stepTime_ms(mechanics::DynamicSystem& system, const Eigen::VectorXd& f, int steps, const Progress& progress) {
  mechanics::DynamicOptions o;
  o.h_s = 1e-3;
  o.end_s = o.h_s * (steps + 1);
  double first = 0.0, last = 0.0;
  const Stopwatch watch;
  o.onStep = [&](const mechanics::DynamicState& s) {
    if (s.step <= 1) first = watch.seconds();
    last = watch.seconds();
    return true;
  };
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(system.size());
  const mechanics::Trajectory t = mechanics::integrate(system, f, rest, rest, o, progress);
  return t.steps > 1 ? 1e3 * (last - first) / (t.steps - 1) : 1e3 * last;
}

}  // namespace glisson::study
