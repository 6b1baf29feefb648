// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "pacs/receive.h"

namespace glisson::pacs {

/// What to fetch from a server, how, and where to.
struct RetrieveOptions {
  std::string uid;       ///< of a study or a series; which one is found out
  std::string studyUid;  ///< of the series' study, for servers that cannot find it by themselves; may be empty
  std::filesystem::path folder;
  /// C-MOVE to a receiver of our own, instead of C-GET: for servers without C-GET. They must know callingTitle, this
  /// computer's address and receivePort.
  bool move = false;
  int receivePort = 0;
  std::string sender;  ///< AE title that may send to us; empty: Node::calledTitle
  Limits limits;
};

/// What a server has sent.
struct Retrieved {
  Received received;
  std::string level;  ///< "study" or "series"
  int expected = -1;  ///< objects, as the server said; -1: it did not
  int failed = 0;     ///< objects that the server could not send, as it said
  /// Whether everything that the server said it has is in the folder.
  bool complete = false;
};

/// Fetches a study or a series into a folder (see Received for names of files). Throws BadInput (options, nothing with
/// this UID on the server), NetworkError, Cancelled; complete files that have arrived by then stay, and are not fetched
/// into other names when it is done again.
Retrieved retrieve(const Node& node, const RetrieveOptions& options, const Progress& progress = {});

}  // namespace glisson::pacs
