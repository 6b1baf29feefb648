// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>

#include "dicom/file_layout.h"

namespace glisson::dicom::detail {

inline constexpr std::uint32_t undefinedLength = 0xFFFFFFFFU;

/// "(0008,0018)"
std::string hexTag(std::uint32_t tag);
/// " at offset 132"
std::string at(std::uint64_t offset);
bool isKnownVr(const std::array<std::uint8_t, 2>& vr);

struct Element {
  std::uint32_t tag = 0;
  std::array<std::uint8_t, 2> vr{};  ///< zero where implicit
  std::uint32_t length = 0;
  std::uint64_t begin = 0;  ///< of the tag
  std::uint64_t value = 0;
  bool is(const char* text) const { return vr[0] == text[0] && vr[1] == text[1]; }
};

/// Walks the elements of a file without allocating what the file asks for; finds the pixel element. Both outlive it.
/// Everything throws BadInput, with a reason that does not name the file.
class ElementWalker {
 public:
  ElementWalker(const ByteSource& source, FileLayout& layout) : source_(source), layout_(layout) {}

  /// Of something that plain files do not have.
  void warn(const std::string& text) {
    odd_ = true;
    note(text);
  }
  /// Of what is no reason to take a file for an odd one.
  void note(const std::string& text);

  std::uint32_t tagAt(std::uint64_t offset, bool big) const {
    return (static_cast<std::uint32_t>(number16(offset, big)) << 16) | number16(offset + 2, big);
  }

  Element elementAt(std::uint64_t offset, bool explicitVr, bool big);

  /// Walks the elements of [begin, end), or up to an item delimiter where the item's length is undefined. Returns where
  /// the walk ended.
  std::uint64_t walk(std::uint64_t begin, std::uint64_t end, bool untilItemEnd, int depth, bool explicitVr, bool big);

  /// Whether what was found is to be refused wherever it stands.
  bool fatal() const { return fatal_; }
  /// Whether a warning was given.
  bool odd() const { return odd_; }
  int deepest() const { return deepest_; }
  std::size_t elements() const { return elements_; }

 private:
  std::uint16_t number16(std::uint64_t offset, bool big) const;
  std::uint32_t number32(std::uint64_t offset, bool big) const;
  /// Checks that only the top level needs: image-size attributes, duplicates, the pixel element.
  void atTop(const Element& e, bool explicitVr, std::uint64_t end);
  std::uint64_t skipValue(const Element& e, std::uint64_t end, int depth, bool explicitVr, bool big);
  std::uint64_t items(std::uint64_t begin, std::uint64_t end, bool undefined, int depth, bool explicitVr, bool big);
  std::uint64_t fragments(const Element& e, std::uint64_t end, int depth, bool big);

  const ByteSource& source_;
  FileLayout& layout_;
  std::map<std::uint32_t, Element> top_;
  std::size_t elements_ = 0;
  int deepest_ = 0;
  bool fatal_ = false;
  bool odd_ = false;
};

}  // namespace glisson::dicom::detail
