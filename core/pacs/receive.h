// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pacs/node.h"

namespace glisson::pacs {

/// Objects that were not kept, by reason. Reasons name no patient.
struct Refusal {
  std::string reason;
  std::size_t count = 0;
};

/// What has arrived.
struct Received {
  std::vector<std::filesystem::path> files;  ///< new, in the order of arrival
  std::size_t alreadyThere = 0;              ///< objects that the folder had: kept as they were
  std::uint64_t bytes = 0;                   ///< of the new ones
  std::vector<Refusal> refused;
  std::size_t associations = 0, rejected = 0;
};

/// Where to listen, whom to let in, and when to stop.
struct ReceiveOptions {
  int port = 0;                      ///< 1 ... 65535
  std::string bind = "127.0.0.1";    ///< IPv4 address to listen on: this computer alone; "0.0.0.0" for every network
  std::string title = "GLISSON";     ///< ours; who calls another one is rejected
  std::vector<std::string> callers;  ///< AE titles that may call; empty: any
  std::filesystem::path folder;      ///< made where missing
  int timeout_s = 30;                ///< longest silence inside an association
  std::optional<std::size_t> count;  ///< ends after so many objects; further ones are refused
  std::optional<int> idle_s;         ///< ends after so long without an association
  Limits limits;
};

/// A C-STORE provider (and C-ECHO). Listens from construction on; nothing is received before run().
class Receiver {
 public:
  /// Throws BadInput (options, folder), NetworkError where address or port are taken or not allowed.
  explicit Receiver(const ReceiveOptions& options);
  ~Receiver();
  Receiver(const Receiver&) = delete;
  Receiver& operator=(const Receiver&) = delete;

  /// Receives until count or idle_s is reached, or progress is cancelled: then running associations are aborted, and
  /// objects that were incomplete leave no file. Never throws Cancelled.
  void run(const Progress& progress);

  /// What has arrived up to now; from any thread.
  Received result() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace glisson::pacs
