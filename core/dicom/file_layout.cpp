// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/file_layout.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "base/error.h"
#include "dicom/detail/element_walker.h"

namespace glisson::dicom {
namespace {

using detail::at;
using detail::Element;
using detail::hexTag;
using detail::isKnownVr;
using detail::undefinedLength;
using Walker = detail::ElementWalker;

constexpr int plainDepth = 6;
constexpr std::size_t plainElements = 100'000;
constexpr std::uint64_t plainHeaderBytes = 32ULL * 1024 * 1024;
constexpr std::uint64_t maxHeaderBytes = 128ULL * 1024 * 1024;

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
  if (!any) walker.note("has no file meta information");
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

constexpr const char* deflatedSyntax = "1.2.840.10008.1.2.1.99";

/// What a preamble holds that would make the file more than an image.
void checkPreamble(const std::array<std::uint8_t, 4>& head, Walker& walker) {
  const auto begins = [&head](const char* magic, std::size_t bytes) {
    return std::memcmp(head.data(), magic, bytes) == 0;
  };
  if (begins("MZ", 2) ||
      begins("\x7f"
             "ELF",
             4) ||
      begins("#!", 2))
    walker.warn("has an executable in its preamble (never copied)");
  else if (begins("II*\0", 4) || begins("MM\0*", 4))
    walker.warn("has a TIFF header in its preamble (never copied)");
}

/// Where the file meta information begins. Throws BadInput where the file is not DICOM.
std::uint64_t metaOffset(const ByteSource& source, Walker& walker) {
  std::array<char, 4> magic{};
  if (source.size() >= 132) source.read(128, magic.data(), 4);
  std::array<std::uint8_t, 4> head{};
  source.read(0, head.data(), 4);
  if (std::memcmp(magic.data(), "DICM", 4) == 0) {
    checkPreamble(head, walker);
    return 132;
  }
  const std::uint32_t first = walker.tagAt(0, false);
  if (first >> 16 != 0x0002 && first >> 16 != 0x0008) throw BadInput("is not a DICOM file");
  walker.note("has no DICOM preamble");
  return 0;
}

void requireDataset(const ByteSource& source, const FileLayout& layout) {
  if (source.size() - layout.datasetOffset < 8) throw BadInput("ends before any data element (truncated header)");
}

void walkDataset(const ByteSource& source, Walker& walker, FileLayout& layout) {
  layout.headerEnd = source.size();
  try {
    walker.walk(layout.datasetOffset, source.size(), false, 0, layout.explicitVr, layout.bigEndian);
  } catch (const BadInput&) {
    // What follows complete pixel data is not needed; nesting bombs and contradictions are refused wherever they are.
    const bool complete = layout.pixels && !layout.pixels->encapsulated;
    if (!complete || walker.fatal()) throw;
    walker.warn("has damaged elements after its pixel data");
  }
}

bool isCompressed(const std::string& syntax) {
  return syntax.starts_with("1.2.840.10008.1.2.4.") || syntax == "1.2.840.10008.1.2.5" ||
         syntax == "1.2.840.10008.1.2.8.1";
}

void checkPixels(const FileLayout& layout) {
  const bool compressed = isCompressed(layout.transferSyntax);
  if (!layout.pixels || layout.pixels->encapsulated == compressed) return;
  throw BadInput(std::string("declares ") + (compressed ? "compressed" : "uncompressed") + " pixels (transfer syntax " +
                 layout.transferSyntax + ") and holds " + (compressed ? "uncompressed" : "compressed") + " ones");
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
  return layout.transferSyntax == deflatedSyntax;
}

FileLayout readLayout(ByteSource& source) {
  if (source.size() == 0) throw BadInput("is empty");
  if (source.size() < 16) throw BadInput("is too short to be a DICOM file");
  FileLayout layout;
  Walker walker(source, layout);
  layout.datasetOffset = readMeta(source, walker, layout, metaOffset(source, walker));
  requireDataset(source, layout);
  const std::string& syntax = layout.transferSyntax;
  if (!syntax.empty() && !isKnownSyntax(syntax))
    throw BadInput("declares the unknown transfer syntax '" + syntax + "'; it is not guessed");
  layout.explicitVr = syntax != "1.2.840.10008.1.2";
  layout.bigEndian = syntax == "1.2.840.10008.1.2.2";
  const bool deflated = syntax == deflatedSyntax;
  if (deflated) {
    source.inflateFrom(layout.datasetOffset);
    requireDataset(source, layout);
  }
  checkEncoding(source, walker, layout);
  walkDataset(source, walker, layout);
  checkPixels(layout);
  const std::uint64_t headerBytes = layout.headerEnd - layout.datasetOffset;
  if (headerBytes > maxHeaderBytes) throw BadInput("has a header of more than 128 MiB; it is refused");
  layout.plain = !deflated && !isCompressed(syntax) && !walker.odd() && walker.deepest() <= plainDepth &&
                 walker.elements() <= plainElements && headerBytes <= plainHeaderBytes;
  return layout;
}

}  // namespace glisson::dicom
