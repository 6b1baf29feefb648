// SPDX-License-Identifier: GPL-3.0-or-later
#include "await.h"

#include <locale.h>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <string>
#include <thread>

#include "base/error.h"
#include "bindings.h"

namespace glisson::python {
namespace py = pybind11;
namespace {

constexpr std::chrono::milliseconds signalsEvery{50};

struct Said {
  double fraction;
  std::string what;
};

/// What the worker has to tell the thread that waits for it.
class Mailbox {
 public:
  void put(double fraction, const std::string& what) {
    const std::lock_guard lock(mutex_);
    said_.push_back({fraction, what});
    news_.notify_one();
  }
  void end(std::exception_ptr failed) {
    const std::lock_guard lock(mutex_);
    failed_ = std::move(failed);
    ended_ = true;
    news_.notify_one();
  }
  /// Waits for news, at most signalsEvery; true once the work has ended.
  bool wait(std::deque<Said>& said) {
    std::unique_lock lock(mutex_);
    news_.wait_for(lock, signalsEvery, [this] { return ended_ || !said_.empty(); });
    said.swap(said_);
    return ended_;
  }
  /// After the work has ended.
  const std::exception_ptr& failed() const { return failed_; }

 private:
  std::mutex mutex_;
  std::condition_variable news_;
  std::deque<Said> said_;
  bool ended_ = false;
  std::exception_ptr failed_;
};

/// Numbers are read and written the same way in every country, whatever locale.setlocale has been told.
class PlainLocale {
 public:
  PlainLocale() : plain_(newlocale(LC_ALL_MASK, "C", nullptr)), before_(uselocale(plain_)) {}
  ~PlainLocale() {
    uselocale(before_);
    freelocale(plain_);
  }
  PlainLocale(const PlainLocale&) = delete;
  PlainLocale& operator=(const PlainLocale&) = delete;

 private:
  locale_t plain_, before_;
};

/// Passes news on until the work has ended. Throws what a signal's handler or the callback raises.
void listen(Mailbox& mailbox, const py::object& callback) {
  for (bool ended = false; !ended;) {
    std::deque<Said> said;
    {
      const py::gil_scoped_release others;
      ended = mailbox.wait(said);
    }
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    for (const Said& s : said) callback(s.fraction, s.what);
  }
}

}  // namespace

void await(const Watch& watch, const std::function<void(const Progress&)>& work) {
  if (!watch.progress.is_none() && !PyCallable_Check(watch.progress.ptr()))
    throw py::type_error("progress is called with (fraction, what): give a function, or None");
  std::stop_source stop;
  const auto stopNow = [&stop] { stop.request_stop(); };
  std::optional<std::stop_callback<std::function<void()>>> linked;
  if (watch.cancel) linked.emplace(watch.cancel->token(), stopNow);
  Mailbox mailbox;
  Progress::Sink sink;
  if (!watch.progress.is_none())
    sink = [&mailbox](double fraction, const std::string& what) { mailbox.put(fraction, what); };
  const Progress progress(std::move(sink), stop.get_token());
  std::thread worker([&] {
    const PlainLocale locale;
    std::exception_ptr failed;
    try {
      progress.check();
      work(progress);
    } catch (...) {
      failed = std::current_exception();
    }
    mailbox.end(failed);
  });
  std::exception_ptr raised;
  try {
    listen(mailbox, watch.progress);
  } catch (...) {
    raised = std::current_exception();
    stop.request_stop();
  }
  {
    const py::gil_scoped_release others;
    worker.join();
  }
  if (raised) std::rethrow_exception(raised);
  if (mailbox.failed()) std::rethrow_exception(mailbox.failed());
}

void bindCancel(py::module_& m) {
  py::class_<Cancel, std::shared_ptr<Cancel>>(
      m, "Cancel",
      "Stops a call from another thread: give it as cancel=, call cancel(). The "
      "call then raises Cancelled, within a tenth of a second as a rule. It stays "
      "cancelled; make a new one for the next call.")
      .def(py::init<>())
      .def("cancel", &Cancel::cancel, "Asks every call that was given this to stop.")
      .def_property_readonly("cancelled", &Cancel::cancelled, "Whether cancel() has been called.");
}

}  // namespace glisson::python
