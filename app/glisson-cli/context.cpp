// SPDX-License-Identifier: GPL-3.0-or-later
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <mutex>
#include <thread>

#include "diagnostics_json.h"
#include "verbs.h"

namespace glisson::cli {
namespace {

std::stop_source& interrupt() {
  static std::stop_source source;
  return source;
}

/// Waits for SIGINT or SIGTERM in a thread of its own: request_stop is not safe inside a signal handler.
void listenForSignals() {
  static std::once_flag once;
  std::call_once(once, [] {
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, SIGINT);
    sigaddset(&set, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &set, nullptr);
    std::thread([set] {
      int signal = 0;
      sigwait(&set, &signal);
      interrupt().request_stop();
      // A second signal ends the process at once.
      sigwait(&set, &signal);
      std::_Exit(CancelledCode);
    }).detach();
  });
}

class Bar {
 public:
  void operator()(double fraction, const std::string& what) {
    const auto now = std::chrono::steady_clock::now();
    if (isatty(STDERR_FILENO)) {
      if (fraction < 1.0 && now - last_ < std::chrono::milliseconds(100)) return;
      last_ = now;
      const int filled = static_cast<int>(30.0 * fraction);
      std::cerr << "\r[" << std::string(static_cast<std::size_t>(filled), '#')
                << std::string(static_cast<std::size_t>(30 - filled), ' ') << "] " << static_cast<int>(100.0 * fraction)
                << " %  " << what << "\033[K";
      if (fraction >= 1.0) std::cerr << "\n";
      std::cerr.flush();
    } else if (what != lastWhat_) {
      std::cerr << static_cast<int>(100.0 * fraction) << " %  " << what << "\n";
    }
    lastWhat_ = what;
  }

 private:
  std::chrono::steady_clock::time_point last_;
  std::string lastWhat_;
};

}  // namespace

Progress Context::progress() const {
  listenForSignals();
  if (quiet) return Progress({}, interrupt().get_token());
  return Progress([bar = std::make_shared<Bar>()](double f, const std::string& what) { (*bar)(f, what); },
                  interrupt().get_token());
}

void Context::print(const Json& object, const std::string& text) const {
  Json whole = object;
  if (whole.contains("warnings") && !whole.contains("diagnostics")) {
    const auto warnings = whole["warnings"].get<std::vector<std::string>>();
    refuseIfStrict(*this, {}, warnings);
    whole["diagnostics"] = diagnosticsJson({}, warnings);
  }
  if (!whole.contains("diagnostics")) whole["diagnostics"] = Json::array();
  if (json)
    // Words of damaged files may be no text.
    std::cout << whole.dump(1, ' ', false, Json::error_handler_t::replace) << std::endl;
  else
    std::cout << text << std::flush;
}

void Context::note(const std::string& line) const {
  if (!quiet) std::cerr << line << "\n";
}

}  // namespace glisson::cli
