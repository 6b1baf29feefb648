// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "base/error.h"
#include "base/progress.h"

namespace glisson::pacs {

/// The network or the other side failed: refused, rejected, out of time, out of resources. The message says which, in
/// one line, and never repeats text that the other side sent. Exit code 1.
class NetworkError : public Error {
 public:
  using Error::Error;
};

/// A DICOM server and how we speak to it. The connection is not encrypted: it belongs on a trusted network.
struct Node {
  std::string host = "127.0.0.1";        ///< name or IPv4 address
  int port = 104;                        ///< 1 ... 65535
  std::string calledTitle = "ANY-SCP";   ///< its AE title
  std::string callingTitle = "GLISSON";  ///< ours
  int timeout_s = 30;                    ///< longest silence: to connect, to associate, and between two packets
};

/// What may be received at most, whatever the other side wants to send.
struct Limits {
  std::uint64_t objectBytes = std::uint64_t{2} << 30;  ///< of one object; a larger one ends the association
  std::uint64_t totalBytes = std::uint64_t{64} << 30;  ///< of all together; further ones are refused
  std::size_t objects = 200000;                        ///< further ones are refused
  std::size_t associations = 4;                        ///< at the same time; further ones are rejected until one ends
  int association_s = 4 * 3600;                        ///< longest association
};

/// Throws BadInput, naming the option, where a title is empty, longer than 16 characters, only spaces, or holds a
/// backslash, a control character or one outside of ASCII [PS3.5, value representation AE].
void checkTitle(const std::string& title, const std::string& option);

/// Throws BadInput where port, titles or time are out of range.
void check(const Node& node);

/// Throws BadInput where text is no UID: digits and dots, at most 64 characters, no empty part [PS3.5 §9].
void checkUid(const std::string& uid, const std::string& option);
bool isUid(const std::string& uid);

/// C-ECHO: whether the server answers and knows us. Returns the seconds that it took. Throws NetworkError.
double echo(const Node& node, const Progress& progress = {});

}  // namespace glisson::pacs
