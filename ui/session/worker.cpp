// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/worker.h"

#include "session/said.h"

#include <QMetaObject>
#include <QTimer>
#include <cmath>

#include "base/error.h"

#ifdef __linux__
#include <sys/resource.h>
#include <unistd.h>
#endif

namespace glisson::session {

namespace {

/// The window and what paints it come first. On Linux niceness belongs to a thread, and those it starts take it over.
void standBackForTheWindow() {
#ifdef __linux__
  ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), 5);
#endif
}

}  // namespace

Worker::Worker(QObject* parent) : QObject(parent) {}

Worker::~Worker() {
  if (!thread_.joinable()) return;
  thread_.request_stop();
  thread_.join();
}

void Worker::start(Job job, Done done) {
  if (busy_) throw BadArgument("Worker::start: a job is at work already");
  if (thread_.joinable()) thread_.join();
  busy_ = true;
  clock_.start();
  thread_ = std::jthread([this, job = std::move(job), done = std::move(done)](std::stop_token stop) {
    standBackForTheWindow();
    const Progress progress(
        [this](double fraction, const std::string& what) {
          const std::lock_guard lock(mutex_);
          fraction_ = fraction;
          what_ = QString::fromStdString(what);
          if (posted_) return;
          posted_ = true;
          QMetaObject::invokeMethod(
              this, [this] { QTimer::singleShot(50, this, [this] { forward(); }); }, Qt::QueuedConnection);
        },
        stop);
    std::exception_ptr failure;
    try {
      job(progress);
      progress.check();
    } catch (...) {
      failure = std::current_exception();
    }
    QMetaObject::invokeMethod(
        this,
        [this, done, failure] {
          busy_ = false;
          done(failure);
        },
        Qt::QueuedConnection);
  });
}

void Worker::cancel() {
  if (busy_) thread_.request_stop();
}

void Worker::forward() {
  double fraction = 0.0;
  QString what;
  {
    const std::lock_guard lock(mutex_);
    fraction = fraction_;
    what = what_;
    posted_ = false;
  }
  if (!busy_) return;
  const double elapsed = static_cast<double>(clock_.elapsed()) * 1e-3;
  // A forecast from less than a second or a tenth of the work would only jump about.
  const double left = elapsed > 1.0 && fraction > 0.1 ? elapsed * (1.0 - fraction) / fraction : -1.0;
  emit progressed(fraction, stepInWords(what), left);
}

QString timeLeft(double seconds) {
  if (seconds < 0.0) return {};
  if (seconds < 60.0) return Worker::tr(", %1 s left").arg(std::ceil(seconds), 0, 'f', 0);
  return Worker::tr(", %1 min left").arg(std::ceil(seconds / 60.0), 0, 'f', 0);
}

QString reasonOf(std::exception_ptr failure) {
  if (!failure) return {};
  try {
    std::rethrow_exception(failure);
  } catch (const Cancelled&) {
    return {};
  } catch (const std::bad_alloc&) {
    return QStringLiteral("There is not enough memory for this. Choose larger cells or close other programs.");
  } catch (const std::exception& e) {
    return QString::fromUtf8(e.what());
  } catch (...) {
    return QStringLiteral("An unknown error occurred.");
  }
}

bool wasCancelled(std::exception_ptr failure) {
  if (!failure) return false;
  try {
    std::rethrow_exception(failure);
  } catch (const Cancelled&) {
    return true;
  } catch (...) {
    return false;
  }
}

}  // namespace glisson::session
