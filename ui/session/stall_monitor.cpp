// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/stall_monitor.h"

#include <algorithm>
#include <cmath>
#include <fstream>

namespace glisson::session {

namespace {

constexpr int every_ms = 4;

/// Nanoseconds this thread was ready and the machine did other things.
std::int64_t waiting_ns() {
  std::ifstream in("/proc/thread-self/schedstat");
  std::int64_t running = 0, waiting = 0;
  return in >> running >> waiting ? waiting : 0;
}

}  // namespace

StallMonitor::StallMonitor(QObject* parent) : QObject(parent) {
  timer_.setTimerType(Qt::PreciseTimer);
  connect(&timer_, &QTimer::timeout, this, &StallMonitor::look);
  clock_.start();
  restart();
  timer_.start(every_ms);
}

void StallMonitor::restart() {
  gaps_ms_.clear();
  last_ns_ = clock_.nsecsElapsed();
  lastWaiting_ns_ = waiting_ns();
}

void StallMonitor::look() {
  const std::int64_t now = clock_.nsecsElapsed(), waiting = waiting_ns();
  const std::int64_t gap = now - last_ns_ - (waiting - lastWaiting_ns_);
  gaps_ms_.push_back(static_cast<float>(std::max<std::int64_t>(gap, 0)) * 1e-6F);
  last_ns_ = now;
  lastWaiting_ns_ = waiting;
}

StallMonitor::Report StallMonitor::report() const {
  Report r;
  r.looks = gaps_ms_.size();
  if (gaps_ms_.empty()) return r;
  std::vector<float> sorted = gaps_ms_;
  std::sort(sorted.begin(), sorted.end());
  const auto at = static_cast<std::size_t>(std::ceil(0.99 * static_cast<double>(sorted.size()))) - 1;
  r.p99_ms = static_cast<double>(sorted[at]);
  r.max_ms = static_cast<double>(sorted.back());
  return r;
}

}  // namespace glisson::session
