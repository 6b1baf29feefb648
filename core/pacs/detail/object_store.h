// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "pacs/detail/association.h"
#include "pacs/receive.h"

namespace glisson::pacs::detail {

/// The folder into which objects are received. A file appears under its name only when it is complete, on disk, and
/// laid out as DICOM; its name is made of the digest of the object's UID, never of text from the other side. What is
/// there is never overwritten. Safe from several threads.
class ObjectStore {
 public:
  /// Makes the folder. Throws BadInput where that fails.
  ObjectStore(std::filesystem::path folder, const Limits& limits);

  /// Receives the data set of a C-STORE request, and returns the status to answer. Throws NetworkError where the
  /// connection fails or the object is larger than allowed, Cancelled; nothing is left of the object then.
  std::uint16_t receive(Channel& channel, const Channel::Message& request, const Agreed& agreed);

  Received result() const;
  /// Objects now in the folder because of us, with those that were there before.
  std::size_t count() const;
  void addAssociation(bool accepted);

 private:
  std::uint16_t refuse(std::uint16_t status, const std::string& reason);
  void skipData(Channel& channel, const Channel::Message& request) const;

  std::filesystem::path folder_;
  Limits limits_;
  mutable std::mutex mutex_;
  Received result_;
  std::map<std::string, std::size_t> refused_;
  std::uint64_t serial_ = 0;
};

/// "<32 hexadecimal digits>.dcm" for a SOP Instance UID.
std::string fileNameFor(const std::string& sopInstanceUid);

/// Preamble, magic word and file meta information of an object that comes in this transfer syntax.
std::string fileHead(const std::string& sopClass, const std::string& sopInstance, const std::string& transferSyntax);

}  // namespace glisson::pacs::detail
