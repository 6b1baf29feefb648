// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QElapsedTimer>
#include <QObject>
#include <QTimer>
#include <cstdint>
#include <vector>

namespace glisson::session {

/// How long the window's thread does not answer: the time between two looks at the event queue, less the time the
/// machine gave to other programs (Linux: run delay of the thread), so that a busy machine is no fault of the window.
/// Lives on the thread it watches.
class StallMonitor : public QObject {
 public:
  explicit StallMonitor(QObject* parent = nullptr);
  struct Report {
    double p99_ms = 0.0, max_ms = 0.0;
    std::size_t looks = 0;
  };
  Report report() const;
  void restart();

 private:
  void look();
  QTimer timer_;
  std::vector<float> gaps_ms_;
  std::int64_t last_ns_ = 0, lastWaiting_ns_ = 0;
  QElapsedTimer clock_;
};

}  // namespace glisson::session
