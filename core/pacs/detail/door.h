// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstddef>
#include <list>
#include <string>

namespace glisson::pacs::detail {

/// The port that callers come to. A caller is let in when the whole of its first packet, which must be the request of
/// an association, has arrived; until then it holds nobody up, however slowly it speaks.
class Door {
 public:
  /// Listens on this IPv4 address and port. Throws NetworkError where that is not possible.
  Door(const std::string& address, int port);
  ~Door();
  Door(const Door&) = delete;
  Door& operator=(const Door&) = delete;

  /// A connected socket from which the whole request can be read at once, the caller's to close; -1 where there is
  /// none. Never waits. Closes connections whose request is not whole `wait` after they came, and those that speak no
  /// DICOM.
  int next(std::chrono::milliseconds wait);
  /// The socket that listens.
  int descriptor() const { return listening_; }

 private:
  struct Waiting {
    int socket;
    std::chrono::steady_clock::time_point since;
  };
  void letCallersIn();
  int listening_ = -1;
  std::list<Waiting> waiting_;  ///< in order of arrival
};

}  // namespace glisson::pacs::detail
