// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "dicom/detail/reader_protocol.h"

namespace glisson::dicom::detail {

/// Why a reader process gave no answer.
struct ReaderFailure {
  std::string why;
  bool tookTooLong = false;  ///< another attempt would take as long
};

/// A running glisson-reader and the socket to it. Ends with this object.
class ReaderChild {
 public:
  /// Throws RefusedFile where the program cannot be started.
  explicit ReaderChild(const std::filesystem::path& program);
  ~ReaderChild();
  ReaderChild(const ReaderChild&) = delete;
  ReaderChild& operator=(const ReaderChild&) = delete;

  const std::filesystem::path& program() const { return program_; }
  int files = 0;  ///< that it was given

  bool send(Ask kind, const std::string& payload);

  /// Next message, or the reason why there is none. The process is dead after such a reason.
  std::optional<ReaderFailure> receive(double wait_s, std::uint64_t largest, Answer& kind, std::string& payload);

 private:
  std::optional<ReaderFailure> take(void* to, std::size_t count, std::chrono::steady_clock::time_point deadline,
                                    double wait_s);
  /// Waits for the process to be gone and says of what it died.
  ReaderFailure end(bool force);

  std::filesystem::path program_;
  int socket_ = -1;
  pid_t pid_ = -1;
};

/// Reader processes that are running and have no work; ended with the program.
class ReaderPool {
 public:
  static ReaderPool& get();
  /// One that runs this program; null where none is idle.
  std::unique_ptr<ReaderChild> take(const std::filesystem::path& program);
  void giveBack(std::unique_ptr<ReaderChild> child);

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<ReaderChild>> idle_;
};

}  // namespace glisson::dicom::detail
