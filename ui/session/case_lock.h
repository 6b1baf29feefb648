// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace glisson::session {

/// Says that a case is open here, so that two windows do not write over each other. A lock whose program is gone is
/// stale and is taken over: on this machine by the lock of the operating system, which ends with the program; from
/// another machine where it has not been touched for staleAfter_s.
class CaseLock {
 public:
  static constexpr int staleAfter_s = 120;

  /// Throws BadInput where the case is open elsewhere (says where and since when it was last touched).
  explicit CaseLock(const std::filesystem::path& folder);
  ~CaseLock();
  CaseLock(const CaseLock&) = delete;
  CaseLock& operator=(const CaseLock&) = delete;

  /// False where the folder cannot be written to: the case can be looked at, not saved there.
  bool writable() const { return fd_ >= 0; }
  bool tookOverStale() const { return stale_; }
  void touch() const;  ///< says that it is still open; call every half minute

 private:
  std::filesystem::path file_;
  int fd_ = -1;
  bool stale_ = false;
};

}  // namespace glisson::session
