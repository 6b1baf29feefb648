// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace glisson::pacs::detail {

/// Elements of group 0000 that are used [PS3.7 annex E].
enum Element : std::uint16_t {
  AffectedClass = 0x0002,
  Field = 0x0100,
  MessageId = 0x0110,
  RespondedTo = 0x0120,
  Destination = 0x0600,
  Priority = 0x0700,
  DataSetType = 0x0800,
  Status = 0x0900,
  AffectedInstance = 0x1000,
  Remaining = 0x1020,
  Completed = 0x1021,
  FailedCount = 0x1022,
  Warned = 0x1023,
  Originator = 0x1030,
  OriginatorMessage = 0x1031
};

enum CommandField : std::uint16_t {
  StoreRequest = 0x0001,
  StoreResponse = 0x8001,
  GetRequest = 0x0010,
  GetResponse = 0x8010,
  FindRequest = 0x0020,
  FindResponse = 0x8020,
  MoveRequest = 0x0021,
  MoveResponse = 0x8021,
  EchoRequest = 0x0030,
  EchoResponse = 0x8030
};

/// DataSetType of a message that no data set follows.
inline constexpr std::uint16_t noDataSet = 0x0101;

/// Bytes of the largest command that is read; real ones have a few hundred.
inline constexpr std::size_t largestCommand = 16 * 1024;

/// A command set, read and written without a DICOM library: what a stranger sends is a flat list of short elements, and
/// anything else (nesting, another group, a length beyond the end) is refused before memory is taken for it.
class Command {
 public:
  static Command of(CommandField field, std::uint16_t messageId, const std::string& sopClass);
  /// The answer to a request, with the class (and the instance) that it named.
  static Command answerTo(const Command& request, std::uint16_t status);

  Command& word(Element element, std::uint16_t value);
  Command& uid(Element element, const std::string& value);
  Command& title(Element element, const std::string& value);

  std::optional<std::uint16_t> word(Element element) const;
  std::uint16_t wordOr(Element element, std::uint16_t otherwise) const { return word(element).value_or(otherwise); }
  /// Without padding; empty where absent.
  std::string text(Element element) const;
  bool hasData() const { return wordOr(DataSetType, noDataSet) != noDataSet; }

  /// Implicit VR little endian, with the group's length.
  std::string encoded() const;
  /// Throws NetworkError where the bytes are no command set.
  static Command decoded(const std::string& bytes);

 private:
  std::map<std::uint16_t, std::string> elements_;
};

}  // namespace glisson::pacs::detail
