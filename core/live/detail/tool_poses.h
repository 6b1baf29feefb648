// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <igtlSocket.h>

#include <Eigen/Core>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <utility>

namespace glisson::live::detail {

using Clock = std::chrono::steady_clock;

/// The last pose that came in, handed from the receiving thread to the sending one.
class Poses {
 public:
  struct Pose {
    Eigen::Vector3d at_mm;
    Clock::time_point received;
  };
  void put(const Eigen::Vector3d& at_mm) {
    const std::lock_guard lock(mutex_);
    pose_ = Pose{at_mm, Clock::now()};
    ++count_;
    changed_.notify_one();
  }
  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_one();
  }
  /// Waits until a pose comes, the client is gone, or the time is up.
  std::optional<Pose> takeUntil(Clock::time_point time) {
    std::unique_lock lock(mutex_);
    changed_.wait_until(lock, time, [&] { return pose_ || closed_; });
    return std::exchange(pose_, std::nullopt);
  }
  bool closed() {
    const std::lock_guard lock(mutex_);
    return closed_;
  }
  long count() {
    const std::lock_guard lock(mutex_);
    return count_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Pose> pose_;
  bool closed_ = false;
  long count_ = 0;
};

/// Between LPS and the messages' coordinates; its own inverse.
inline Eigen::Vector3d turned(const Eigen::Vector3d& p, bool ras) {
  return ras ? Eigen::Vector3d(-p.x(), -p.y(), p.z()) : p;
}

/// Reads a client's messages until `stop` is set or the client leaves, breaks the protocol or lies about a size; poses
/// of the tool are put into `poses`, which is closed at the end. rest_mm: poses further than 100 mm from it are
/// ignored.
void receive(igtl::Socket& socket, const Eigen::Vector3d& rest_mm, bool ras, Poses& poses,
             const std::atomic<bool>& stop);

}  // namespace glisson::live::detail
