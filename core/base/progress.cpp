// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/progress.h"

#include <algorithm>
#include <mutex>

#include "base/error.h"

namespace glisson {

void Progress::report(double fraction, const std::string& what) const {
  check();
  static std::mutex oneAtATime;  // two solves may report at once, and no sink has to know
  const std::lock_guard guard(oneAtATime);
  if (sink_) sink_(from_ + (to_ - from_) * std::clamp(fraction, 0.0, 1.0), what);
}

void Progress::check() const {
  if (stop_.stop_requested()) throw Cancelled();
}

Progress Progress::part(double from, double to) const {
  Progress p = *this;
  p.from_ = from_ + (to_ - from_) * from;
  p.to_ = from_ + (to_ - from_) * to;
  return p;
}

}  // namespace glisson
