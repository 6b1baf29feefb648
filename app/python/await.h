// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <type_traits>
#include <utility>

#include "base/progress.h"

namespace glisson::python {

/// What stops work from another thread of Python; may be given to several calls, and stays cancelled.
class Cancel {
 public:
  void cancel() { source_.request_stop(); }
  bool cancelled() const { return source_.stop_requested(); }
  std::stop_token token() const { return source_.get_token(); }

 private:
  std::stop_source source_;
};

/// The last two arguments of every function that takes long.
struct Watch {
  pybind11::object progress;  ///< callable (fraction, what), or None
  std::shared_ptr<Cancel> cancel;
};

/// Runs work in a thread of its own while the calling one, with the GIL released, waits for it: other threads of Python
/// go on. The calling thread calls watch.progress, and looks for signals every 50 ms. An exception of progress, or of a
/// signal's handler (KeyboardInterrupt), stops the work, waits for its end and is thrown here; so is what the work
/// throws, Cancelled where watch.cancel asked for it. The work sees the "C" locale.
void await(const Watch& watch, const std::function<void(const Progress&)>& work);

/// The same with a result.
template <typename F>
auto awaited(const Watch& watch, F&& work) {
  using Result = std::invoke_result_t<F, const Progress&>;
  std::optional<Result> result;
  await(watch, [&](const Progress& progress) { result.emplace(work(progress)); });
  return std::move(*result);
}

}  // namespace glisson::python
