// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <stop_token>
#include <string>

namespace glisson {

/// Progress and cancellation for work that may take over a second. Cheap to copy; the default one is silent.
class Progress {
 public:
  /// fraction in [0, 1] of the whole job; what: a few words for the status line.
  using Sink = std::function<void(double fraction, const std::string& what)>;

  Progress() = default;
  explicit Progress(Sink sink, std::stop_token stop = {}) : sink_(std::move(sink)), stop_(std::move(stop)) {}

  /// Tells the sink and throws Cancelled where a stop was requested.
  void report(double fraction, const std::string& what) const;

  /// Throws Cancelled where a stop was requested. Call inside long loops (at least every 100 ms).
  void check() const;

  /// A view of [from, to] of this progress, for a step of a larger job.
  Progress part(double from, double to) const;

 private:
  Sink sink_;
  std::stop_token stop_;
  double from_ = 0.0;
  double to_ = 1.0;
};

}  // namespace glisson
