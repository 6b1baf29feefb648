#include "dicom/file_layout.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <map>

#include "base/error.h"

namespace glisson::dicom {
namespace {

constexpr int maxDepth = 64;
constexpr std::size_t maxElements = 2'000'000;
constexpr int plainDepth = 6;
constexpr std::size_t plainElements = 100'000;
constexpr std::uint64_t plainHeaderBytes = 32ULL * 1024 * 1024;
constexpr std::uint64_t maxHeaderBytes = 128ULL * 1024 * 1024;
constexpr std::uint32_t undefinedLength = 0xFFFFFFFFU;
constexpr std::uint32_t itemTag = 0xFFFEE000U;
constexpr std::uint32_t itemEnd = 0xFFFEE00DU;
constexpr std::uint32_t sequenceEnd = 0xFFFEE0DDU;

std::string hexTag(std::uint32_t tag) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "(%04X,%04X)", tag >> 16, tag & 0xFFFFU);
  return text.data();
}

std::string at(std::uint64_t offset) {
  return " at offset " + std::to_string(offset);
}

bool isUpper(std::uint8_t c) {
  return c >= 'A' && c <= 'Z';
}

bool isKnownVr(const std::array<std::uint8_t, 2>& vr) {
  static constexpr const char* known[] = {"AE", "AS", "AT", "CS", "DA", "DS", "DT", "FL", "FD", "IS", "LO", "LT",
                                          "OB", "OD", "OF", "OL", "OV", "OW", "PN", "SH", "SL", "SQ", "SS", "ST",
                                          "SV", "TM", "UC", "UI", "UL", "UN", "UR", "US", "UT", "UV"};
  return std::any_of(std::begin(known), std::end(known),
                     [&vr](const char* k) { return vr[0] == k[0] && vr[1] == k[1]; });
}

bool hasShortLength(const std::array<std::uint8_t, 2>& vr) {
  static constexpr const char* longer[] = {"OB", "OD", "OF", "OL", "OV", "OW", "SQ",
                                           "SV", "UC", "UN", "UR", "UT", "UV"};
  return isKnownVr(vr) && std::none_of(std::begin(longer), std::end(longer),
                                       [&vr](const char* k) { return vr[0] == k[0] && vr[1] == k[1]; });
}

struct Element {
  std::uint32_t tag = 0;
  std::array<std::uint8_t, 2> vr{};  ///< zero where implicit
  std::uint32_t length = 0;
  std::uint64_t begin = 0;  ///< of the tag
  std::uint64_t value = 0;
  bool is(const char* text) const { return vr[0] == text[0] && vr[1] == text[1]; }
};

class Walker {
 public:
  Walker(const ByteSource& source, FileLayout& layout) : source_(source), layout_(layout) {}

  void warn(const std::string& text) {
    if (std::find(layout_.warnings.begin(), layout_.warnings.end(), text) == layout_.warnings.end())
      layout_.warnings.push_back(text);
  }

  std::uint32_t tagAt(std::uint64_t offset, bool big) const {
    return (static_cast<std::uint32_t>(number16(offset, big)) << 16) | number16(offset + 2, big);
  }

  Element elementAt(std::uint64_t offset, bool explicitVr, bool big) {
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
      throw BadInput(
          "element " + hexTag(e.tag) + at(offset) +
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

  /// Walks the elements of [begin, end), or up to an item delimiter where the item's length is undefined. Returns where
  /// the walk ended.
  std::uint64_t walk(std::uint64_t begin, std::uint64_t end, bool untilItemEnd, int depth, bool explicitVr, bool big) {
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

  /// Whether what was found is to be refused wherever it stands.
  bool fatal() const { return fatal_; }
  int deepest() const { return deepest_; }
  std::size_t elements() const { return elements_; }

 private:
  std::uint16_t number16(std::uint64_t offset, bool big) const {
    std::array<std::uint8_t, 2> b{};
    source_.read(offset, b.data(), 2);
    return static_cast<std::uint16_t>(big ? (b[0] << 8) | b[1] : (b[1] << 8) | b[0]);
  }

  std::uint32_t number32(std::uint64_t offset, bool big) const {
    const std::uint32_t first = number16(offset, big);
    const std::uint32_t second = number16(offset + 2, big);
    return big ? (first << 16) | second : (second << 16) | first;
  }

  /// Checks that only the top level needs: image-size attributes, duplicates, the pixel element.
  void atTop(const Element& e, bool explicitVr, std::uint64_t end) {
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

  std::uint64_t skipValue(const Element& e, std::uint64_t end, int depth, bool explicitVr, bool big) {
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
                     (explicitVr && !isKnownVr(e.vr) ? " has an unknown value representation and" : "") +
                     " announces " + std::to_string(e.length) + " bytes, beyond the end of " +
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

  std::uint64_t items(std::uint64_t begin, std::uint64_t end, bool undefined, int depth, bool explicitVr, bool big) {
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

  std::uint64_t fragments(const Element& e, std::uint64_t end, int depth, bool big) {
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

  const ByteSource& source_;
  FileLayout& layout_;
  std::map<std::uint32_t, Element> top_;
  std::size_t elements_ = 0;
  int deepest_ = 0;
  bool fatal_ = false;
};

std::string uidText(const ByteSource& source, const Element& e) {
  const auto raw = source.bytes(e.value, std::min<std::uint32_t>(e.length, 128));
  std::string text;
  for (const std::uint8_t c : raw) {
    if (c == 0 || c == ' ') break;
    text += (c >= '0' && c <= '9') || c == '.' ? static_cast<char>(c) : '?';
  }
  return text;
}

/// Native, or one of the compressed syntaxes that a DICOM file may carry; anything else is unknown.
bool isKnownSyntax(const std::string& uid) {
  static const std::string base = "1.2.840.10008.1.2";
  if (uid == base || uid == base + ".1" || uid == base + ".2" || uid == base + ".1.99" || uid == base + ".5" ||
      uid == base + ".8.1")
    return true;
  return uid.starts_with(base + ".4.") && uid.size() <= base.size() + 6;
}

/// Reads the file meta information from offset on; returns where the data set begins.
std::uint64_t readMeta(const ByteSource& source, Walker& walker, FileLayout& layout, std::uint64_t offset) {
  std::uint64_t here = offset;
  bool any = false;
  while (source.size() - here >= 8 && walker.tagAt(here, false) >> 16 == 0x0002) {
    const Element e = walker.elementAt(here, true, false);
    if (e.length == undefinedLength || e.value > source.size() || e.length > source.size() - e.value ||
        !isKnownVr(e.vr))
      throw BadInput("has damaged file meta information: element " + hexTag(e.tag) + at(e.begin));
    if (e.tag == 0x00020010) layout.transferSyntax = uidText(source, e);
    if (e.tag == 0x00020002) layout.sopClassUid = uidText(source, e);
    here = e.value + e.length;
    any = true;
  }
  if (!any) walker.warn("has no file meta information");
  return here;
}

/// The first element shows how the data set is really encoded.
void checkEncoding(const ByteSource& source, Walker& walker, FileLayout& layout) {
  const std::uint64_t here = layout.datasetOffset;
  std::array<std::uint8_t, 8> b{};
  source.read(here, b.data(), b.size());
  const bool looksExplicit = isKnownVr({b[4], b[5]});
  if (layout.transferSyntax.empty()) {
    layout.explicitVr = looksExplicit;
    walker.warn("names no transfer syntax; it was found from its bytes");
    return;
  }
  const std::uint32_t group = walker.tagAt(here, layout.bigEndian) >> 16;
  if (group > 0x00FF && (walker.tagAt(here, !layout.bigEndian) >> 16) <= 0x00FF)
    throw BadInput("declares one byte order and is written in the other" + at(here));
  if (layout.explicitVr != looksExplicit)
    throw BadInput(std::string("declares ") + (layout.explicitVr ? "explicit" : "implicit") +
                   " value representations and is written with " + (looksExplicit ? "explicit" : "implicit") + " ones" +
                   at(here));
}

}  // namespace

bool isDeflated(const ByteSource& source) {
  if (source.size() < 140) return false;
  std::array<char, 4> magic{};
  source.read(128, magic.data(), 4);
  FileLayout layout;
  Walker walker(source, layout);
  const bool preamble = std::memcmp(magic.data(), "DICM", 4) == 0;
  if (!preamble && walker.tagAt(0, false) >> 16 != 0x0002) return false;
  readMeta(source, walker, layout, preamble ? 132 : 0);
  return layout.transferSyntax == "1.2.840.10008.1.2.1.99";
}

FileLayout readLayout(ByteSource& source) {
  if (source.size() == 0) throw BadInput("is empty");
  if (source.size() < 16) throw BadInput("is too short to be a DICOM file");
  FileLayout layout;
  Walker walker(source, layout);
  std::array<char, 4> magic{};
  if (source.size() >= 132) source.read(128, magic.data(), 4);
  std::uint64_t meta = 0;
  std::array<std::uint8_t, 4> head{};
  source.read(0, head.data(), 4);
  if (std::memcmp(magic.data(), "DICM", 4) == 0) {
    meta = 132;
    if (std::memcmp(head.data(), "MZ", 2) == 0 ||
        std::memcmp(head.data(),
                    "\x7f"
                    "ELF",
                    4) == 0 ||
        std::memcmp(head.data(), "#!", 2) == 0)
      walker.warn("has an executable in its preamble (never copied)");
    else if (std::memcmp(head.data(), "II*\0", 4) == 0 || std::memcmp(head.data(), "MM\0*", 4) == 0)
      walker.warn("has a TIFF header in its preamble (never copied)");
  } else {
    const std::uint32_t first = walker.tagAt(0, false);
    if (first >> 16 != 0x0002 && first >> 16 != 0x0008) throw BadInput("is not a DICOM file");
    walker.warn("has no DICOM preamble");
  }
  layout.datasetOffset = readMeta(source, walker, layout, meta);
  if (source.size() - layout.datasetOffset < 8) throw BadInput("ends before any data element (truncated header)");
  const std::string& syntax = layout.transferSyntax;
  if (!syntax.empty() && !isKnownSyntax(syntax))
    throw BadInput("declares the unknown transfer syntax '" + syntax + "'; it is not guessed");
  layout.explicitVr = syntax != "1.2.840.10008.1.2";
  layout.bigEndian = syntax == "1.2.840.10008.1.2.2";
  if (syntax == "1.2.840.10008.1.2.1.99") {
    source.inflateFrom(layout.datasetOffset);
    if (source.size() - layout.datasetOffset < 8) throw BadInput("ends before any data element (truncated header)");
  }
  checkEncoding(source, walker, layout);
  layout.headerEnd = source.size();
  try {
    walker.walk(layout.datasetOffset, source.size(), false, 0, layout.explicitVr, layout.bigEndian);
  } catch (const BadInput&) {
    // What follows complete pixel data is not needed; nesting bombs and contradictions are refused wherever they are.
    const bool complete = layout.pixels && !layout.pixels->encapsulated;
    if (!complete || walker.fatal()) throw;
    walker.warn("has damaged elements after its pixel data");
  }
  const bool compressed = syntax.starts_with("1.2.840.10008.1.2.4.") || syntax == "1.2.840.10008.1.2.5" ||
                          syntax == "1.2.840.10008.1.2.8.1";
  if (layout.pixels && layout.pixels->encapsulated != compressed)
    throw BadInput(std::string("declares ") + (compressed ? "compressed" : "uncompressed") +
                   " pixels (transfer syntax " + syntax + ") and holds " +
                   (compressed ? "uncompressed" : "compressed") + " ones");
  if (layout.headerEnd - layout.datasetOffset > maxHeaderBytes)
    throw BadInput("has a header of more than 128 MiB; it is refused");
  const auto harmless = [](const std::string& w) {
    return w == "has no DICOM preamble" || w == "has no file meta information";
  };
  layout.plain = syntax != "1.2.840.10008.1.2.1.99" && !compressed && walker.deepest() <= plainDepth &&
                 walker.elements() <= plainElements && layout.headerEnd - layout.datasetOffset <= plainHeaderBytes &&
                 std::all_of(layout.warnings.begin(), layout.warnings.end(), harmless);
  return layout;
}

}  // namespace glisson::dicom
