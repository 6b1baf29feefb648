// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/detail/element_walker.h"

#include <algorithm>
#include <cstdio>

#include "base/error.h"

namespace glisson::dicom::detail {
namespace {

constexpr int maxDepth = 64;
constexpr std::size_t maxElements = 2'000'000;
constexpr std::uint32_t itemTag = 0xFFFEE000U;
constexpr std::uint32_t itemEnd = 0xFFFEE00DU;
constexpr std::uint32_t sequenceEnd = 0xFFFEE0DDU;

bool isUpper(std::uint8_t c) {
  return c >= 'A' && c <= 'Z';
}

bool hasShortLength(const std::array<std::uint8_t, 2>& vr) {
  static constexpr const char* longer[] = {"OB", "OD", "OF", "OL", "OV", "OW", "SQ",
                                           "SV", "UC", "UN", "UR", "UT", "UV"};
  return isKnownVr(vr) && std::none_of(std::begin(longer), std::end(longer),
                                       [&vr](const char* k) { return vr[0] == k[0] && vr[1] == k[1]; });
}

}  // namespace

std::string hexTag(std::uint32_t tag) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "(%04X,%04X)", tag >> 16, tag & 0xFFFFU);
  return text.data();
}

std::string at(std::uint64_t offset) {
  return " at offset " + std::to_string(offset);
}

bool isKnownVr(const std::array<std::uint8_t, 2>& vr) {
  static constexpr const char* known[] = {"AE", "AS", "AT", "CS", "DA", "DS", "DT", "FL", "FD", "IS", "LO", "LT",
                                          "OB", "OD", "OF", "OL", "OV", "OW", "PN", "SH", "SL", "SQ", "SS", "ST",
                                          "SV", "TM", "UC", "UI", "UL", "UN", "UR", "US", "UT", "UV"};
  return std::any_of(std::begin(known), std::end(known),
                     [&vr](const char* k) { return vr[0] == k[0] && vr[1] == k[1]; });
}

void ElementWalker::note(const std::string& text) {
  if (std::find(layout_.warnings.begin(), layout_.warnings.end(), text) == layout_.warnings.end())
    layout_.warnings.push_back(text);
}

Element ElementWalker::elementAt(std::uint64_t offset, bool explicitVr, bool big) {
  if (++elements_ > maxElements) throw BadInput("holds more than two million data elements; it is refused");
  Element e;
  e.begin = offset;
  e.tag = tagAt(offset, big);
  if ((e.tag >> 16) == 0xFFFE || !explicitVr) {
    e.length = number32(offset + 4, big);
    e.value = offset + 8;
    return e;
  }
  source_.read(offset + 4, e.vr.data(), 2);
  if (!isUpper(e.vr[0]) || !isUpper(e.vr[1]))
    throw BadInput("element " + hexTag(e.tag) + at(offset) +
                   " has no valid value representation: the file is damaged, or its transfer syntax is not the one it "
                   "declares");
  if (hasShortLength(e.vr)) {
    e.length = number16(offset + 6, big);
    e.value = offset + 8;
  } else {
    if (!isKnownVr(e.vr)) warn("element " + hexTag(e.tag) + " has an unknown value representation");
    e.length = number32(offset + 8, big);
    e.value = offset + 12;
  }
  return e;
}

std::uint64_t ElementWalker::walk(std::uint64_t begin, std::uint64_t end, bool untilItemEnd, int depth, bool explicitVr,
                                  bool big) {
  if (depth > maxDepth) {
    fatal_ = true;
    throw BadInput("nests sequences more than 64 deep" + at(begin) + "; it is refused");
  }
  deepest_ = std::max(deepest_, depth);
  std::uint64_t here = begin;
  std::uint32_t last = 0;
  while (here < end) {
    if (depth == 0 && end - here < 8) {
      for (const std::uint8_t byte : source_.bytes(here, end - here))
        if (byte != 0 && !layout_.pixels) throw BadInput("ends within a data element (truncated header)" + at(here));
      warn("has " + std::to_string(end - here) + " stray bytes at its end");
      break;
    }
    const Element e = elementAt(here, explicitVr, big);
    if (e.tag == itemEnd && untilItemEnd) return e.value;
    if ((e.tag >> 16) == 0xFFFE)
      throw BadInput("has an item or delimiter " + hexTag(e.tag) + " outside of any sequence" + at(here));
    if (depth == 0 && layout_.pixels && e.tag == 0) {
      warn("is padded after its pixel data");
      break;
    }
    if (e.tag < last) warn("has elements out of order, first " + hexTag(e.tag));
    last = e.tag;
    if (depth == 0) atTop(e, explicitVr, end);
    here = skipValue(e, end, depth, explicitVr, big);
  }
  if (untilItemEnd) throw BadInput("has a sequence item without an end" + at(begin));
  return here;
}

std::uint16_t ElementWalker::number16(std::uint64_t offset, bool big) const {
  std::array<std::uint8_t, 2> b{};
  source_.read(offset, b.data(), 2);
  return static_cast<std::uint16_t>(big ? (b[0] << 8) | b[1] : (b[1] << 8) | b[0]);
}

std::uint32_t ElementWalker::number32(std::uint64_t offset, bool big) const {
  const std::uint32_t first = number16(offset, big);
  const std::uint32_t second = number16(offset + 2, big);
  return big ? (first << 16) | second : (second << 16) | first;
}

void ElementWalker::atTop(const Element& e, bool explicitVr, std::uint64_t end) {
  static constexpr std::uint32_t mustBeUs[] = {0x00280002, 0x00280006, 0x00280010, 0x00280011,
                                               0x00280100, 0x00280101, 0x00280102, 0x00280103};
  if (std::find(std::begin(mustBeUs), std::end(mustBeUs), e.tag) != std::end(mustBeUs) &&
      ((explicitVr && !e.is("US")) || e.length != 2))
    throw BadInput("image attribute " + hexTag(e.tag) + at(e.begin) +
                   " must be one 16-bit unsigned number (US, 2 bytes); it has " + std::to_string(e.length) +
                   " bytes or another value representation");
  const bool pixelElement = e.tag == 0x7FE00008 || e.tag == 0x7FE00009 || e.tag == 0x7FE00010;
  const auto [seen, fresh] = top_.try_emplace(e.tag, e);
  if (!fresh) {
    const Element& other = seen->second;
    const bool same = other.length == e.length && e.length != undefinedLength && e.length < (1U << 20) &&
                      e.value + e.length <= end &&
                      source_.bytes(other.value, other.length) == source_.bytes(e.value, e.length);
    if (!same || pixelElement) {
      fatal_ = true;
      throw BadInput("element " + hexTag(e.tag) + " occurs twice with different values" + at(e.begin));
    }
    warn("element " + hexTag(e.tag) + " occurs twice");
  }
  if (!pixelElement) return;
  if (layout_.pixels) throw BadInput("has two pixel data elements" + at(e.begin));
  PixelElement pixels;
  pixels.element = static_cast<std::uint16_t>(e.tag & 0xFFFFU);
  pixels.offset = e.value;
  pixels.encapsulated = e.length == undefinedLength;
  pixels.words = !e.is("OB");
  if (!pixels.encapsulated) {
    pixels.length = e.length;
    if (e.value > end || e.length > end - e.value)
      throw BadInput("is truncated: its pixel data announce " + std::to_string(e.length) + " bytes" + at(e.value) +
                     ", but only " + std::to_string(end - std::min(e.value, end)) + " are there");
  }
  layout_.pixels = pixels;
  layout_.headerEnd = e.begin;
}

std::uint64_t ElementWalker::skipValue(const Element& e, std::uint64_t end, int depth, bool explicitVr, bool big) {
  const bool pixelLike = e.tag == 0x7FE00010 || e.is("OB") || e.is("OW");
  if (e.length == undefinedLength) {
    if (pixelLike) return fragments(e, end, depth, big);
    if (explicitVr && !e.is("SQ") && !e.is("UN"))
      throw BadInput("element " + hexTag(e.tag) + at(e.begin) +
                     " has an undefined length, which its kind may not have");
    const bool unknown = explicitVr && e.is("UN");  // implicit little endian inside, by the standard
    return items(e.value, end, true, depth, explicitVr && !unknown, big && !unknown);
  }
  if (e.value > end || e.length > end - e.value)
    throw BadInput("element " + hexTag(e.tag) + at(e.begin) +
                   (explicitVr && !isKnownVr(e.vr) ? " has an unknown value representation and" : "") + " announces " +
                   std::to_string(e.length) + " bytes, beyond the end of " +
                   (depth == 0 ? "the file" : "its sequence item"));
  if (e.length % 2 != 0) warn("element " + hexTag(e.tag) + " has an odd length");
  if (explicitVr && e.is("SQ")) {
    items(e.value, e.value + e.length, false, depth, explicitVr, big);
  } else if (!explicitVr && e.length >= 8 && tagAt(e.value, big) == itemTag && !pixelLike) {
    // Without value representations a sequence is known by its look only; what fails to parse was no sequence.
    try {
      items(e.value, e.value + e.length, false, depth, explicitVr, big);
    } catch (const BadInput&) {
      if (fatal_ || elements_ > maxElements) throw;
    }
  }
  return e.value + e.length;
}

std::uint64_t ElementWalker::items(std::uint64_t begin, std::uint64_t end, bool undefined, int depth, bool explicitVr,
                                   bool big) {
  std::uint64_t here = begin;
  while (here < end) {
    const Element item = elementAt(here, explicitVr, big);
    if (item.tag == sequenceEnd) {
      if (!undefined) warn("has a delimiter in a sequence of known length");
      return item.value;
    }
    if (item.tag != itemTag)
      throw BadInput("has " + hexTag(item.tag) + " where a sequence item was expected" + at(here));
    if (item.length == undefinedLength) {
      here = walk(item.value, end, true, depth + 1, explicitVr, big);
    } else {
      if (item.value > end || item.length > end - item.value)
        throw BadInput("has a sequence item" + at(here) + " of " + std::to_string(item.length) +
                       " bytes, beyond the end of its sequence");
      here = walk(item.value, item.value + item.length, false, depth + 1, explicitVr, big);
    }
  }
  if (undefined) throw BadInput("has a sequence without an end" + at(begin));
  return here;
}

std::uint64_t ElementWalker::fragments(const Element& e, std::uint64_t end, int depth, bool big) {
  std::uint64_t here = e.value;
  bool offsetTable = true;
  while (here < end) {
    const Element item = elementAt(here, false, big);
    if (item.tag == sequenceEnd) return item.value;
    if (item.tag != itemTag || item.length == undefinedLength)
      throw BadInput("has damaged compressed pixel data" + at(here));
    if (item.value > end || item.length > end - item.value)
      throw BadInput("is truncated: a fragment of its pixel data" + at(here) + " announces " +
                     std::to_string(item.length) + " bytes, beyond the end of the file");
    if (!offsetTable && depth == 0 && layout_.pixels && layout_.pixels->offset == e.value)
      layout_.pixels->fragments.push_back({item.value, item.length});
    offsetTable = false;
    here = item.value + item.length;
  }
  throw BadInput("is truncated: its compressed pixel data have no end");
}

}  // namespace glisson::dicom::detail
