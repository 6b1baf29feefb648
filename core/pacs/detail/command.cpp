// SPDX-License-Identifier: GPL-3.0-or-later
#include "pacs/detail/command.h"

#include "pacs/node.h"

namespace glisson::pacs::detail {
namespace {

void put(std::string& to, std::uint64_t value, int bytes) {
  for (int n = 0; n < bytes; ++n) to += static_cast<char>((value >> (8 * n)) & 0xff);
}

std::uint32_t take(const std::string& from, std::size_t at, int bytes) {
  std::uint32_t value = 0;
  for (int n = 0; n < bytes; ++n)
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(from[at + static_cast<std::size_t>(n)])) << (8 * n);
  return value;
}

[[noreturn]] void senseless() {
  throw NetworkError("the other side sent a DICOM command that makes no sense; the association was ended");
}

}  // namespace

Command Command::of(CommandField field, std::uint16_t messageId, const std::string& sopClass) {
  Command c;
  c.uid(AffectedClass, sopClass).word(Field, field).word(MessageId, messageId).word(DataSetType, noDataSet);
  return c;
}

Command Command::answerTo(const Command& request, std::uint16_t status) {
  Command c;
  c.uid(AffectedClass, request.text(AffectedClass));
  c.word(Field, static_cast<std::uint16_t>(request.wordOr(Field, 0) | 0x8000));
  c.word(RespondedTo, request.wordOr(MessageId, 0)).word(DataSetType, noDataSet).word(Status, status);
  if (const std::string instance = request.text(AffectedInstance); !instance.empty()) c.uid(AffectedInstance, instance);
  return c;
}

Command& Command::word(Element element, std::uint16_t value) {
  std::string bytes;
  put(bytes, value, 2);
  elements_[element] = bytes;
  return *this;
}

Command& Command::uid(Element element, const std::string& value) {
  elements_[element] = value.size() % 2 == 0 ? value : value + '\0';
  return *this;
}

Command& Command::title(Element element, const std::string& value) {
  elements_[element] = value.size() % 2 == 0 ? value : value + ' ';
  return *this;
}

std::optional<std::uint16_t> Command::word(Element element) const {
  const auto found = elements_.find(element);
  if (found == elements_.end() || found->second.size() != 2) return std::nullopt;
  return static_cast<std::uint16_t>(take(found->second, 0, 2));
}

std::string Command::text(Element element) const {
  const auto found = elements_.find(element);
  if (found == elements_.end()) return {};
  const std::string& all = found->second;
  const std::size_t first = all.find_first_not_of(' ');
  const std::size_t last = all.find_last_not_of(std::string(" \0", 2));
  return first == std::string::npos || last == std::string::npos || last < first ? std::string()
                                                                                 : all.substr(first, last - first + 1);
}

std::string Command::encoded() const {
  std::string body;
  for (const auto& [element, value] : elements_) {
    put(body, 0x0000, 2);
    put(body, element, 2);
    put(body, value.size(), 4);
    body += value;
  }
  std::string all;
  put(all, 0, 4);
  put(all, 4, 4);
  put(all, body.size(), 4);
  return all + body;
}

Command Command::decoded(const std::string& bytes) {
  if (bytes.size() > largestCommand) senseless();
  Command c;
  std::size_t at = 0;
  while (at < bytes.size()) {
    if (bytes.size() - at < 8 || take(bytes, at, 2) != 0) senseless();
    const auto element = static_cast<std::uint16_t>(take(bytes, at + 2, 2));
    const std::size_t length = take(bytes, at + 4, 4);
    at += 8;
    if (length > bytes.size() - at) senseless();
    if (element != 0) c.elements_[element] = bytes.substr(at, length);
    at += length;
  }
  if (!c.word(Field)) senseless();
  return c;
}

}  // namespace glisson::pacs::detail
