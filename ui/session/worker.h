// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QElapsedTimer>
#include <QObject>
#include <QString>
#include <exception>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>

#include "base/progress.h"

namespace glisson::session {

/// Does one job at a time on a thread of its own and reports on the thread that owns the worker.
class Worker : public QObject {
  Q_OBJECT
 public:
  using Job = std::function<void(const Progress& progress)>;
  /// failure: null where the job ended well. Called on the owner's thread, after busy() has become false.
  using Done = std::function<void(std::exception_ptr failure)>;

  explicit Worker(QObject* parent = nullptr);
  ~Worker() override;  ///< asks the job to stop and waits for it

  bool busy() const { return busy_; }
  /// Starts the job. Throws BadArgument where one is at work.
  void start(Job job, Done done);
  /// Asks the job to stop; it ends as Cancelled at its next check.
  void cancel();
  bool cancelling() const { return busy_ && thread_.get_stop_token().stop_requested(); }

 signals:
  /// At most twenty times a second. fraction of the whole; secondsLeft < 0 while it is not known.
  void progressed(double fraction, const QString& what, double secondsLeft);

 private:
  void forward();
  std::jthread thread_;
  bool busy_ = false;
  QElapsedTimer clock_;
  std::mutex mutex_;  // guards the three below
  double fraction_ = 0.0;
  QString what_;
  bool posted_ = false;
};

/// ", 12 s left" to stand behind what is done; empty where it is not known.
QString timeLeft(double seconds);

/// What went wrong, in the words of the exception. Empty for Cancelled and for no failure.
QString reasonOf(std::exception_ptr failure);
bool wasCancelled(std::exception_ptr failure);

}  // namespace glisson::session
