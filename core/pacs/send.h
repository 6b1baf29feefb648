// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "pacs/node.h"

namespace glisson::pacs {

/// A file that was not stored there, and why.
struct NotSent {
  std::filesystem::path file;
  std::string reason;
};

/// What was sent to a server, and what it did not take.
struct Sent {
  std::size_t objects = 0;
  std::uint64_t bytes = 0;
  std::vector<NotSent> failed;  ///< in the order of the files
};

/// C-STORE of DICOM files, and of the files below folders (in order of path). The bytes of a data set go out as they
/// are in the file; only where the server takes none but implicit little endian are they written anew. Files that are
/// no DICOM files are in Sent::failed. Throws BadInput where a path does not exist or there is nothing to send;
/// NetworkError where the server cannot be talked to or the connection breaks (the number that had been stored is in
/// the message); Cancelled.
Sent send(const Node& node, const std::vector<std::filesystem::path>& paths, const Progress& progress = {});

}  // namespace glisson::pacs
