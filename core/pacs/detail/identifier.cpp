// SPDX-License-Identifier: GPL-3.0-or-later
#include "pacs/detail/identifier.h"

#include <dcmtk/config/osconfig.h>
// DCMTK's headers need its configuration first.
#include <dcmtk/dcmdata/dcistrmb.h>
#include <dcmtk/dcmdata/dcostrmb.h>
#include <dcmtk/dcmdata/dctk.h>

#include <algorithm>

#include "pacs/detail/syntaxes.h"
#include "pacs/node.h"

namespace glisson::pacs::detail {
namespace {

DcmTagKey keyOf(std::uint32_t tag) {
  return {static_cast<Uint16>(tag >> 16), static_cast<Uint16>(tag & 0xffff)};
}

E_TransferSyntax syntaxOf(const std::string& uid) {
  return uid == implicitLittle ? EXS_LittleEndianImplicit : EXS_LittleEndianExplicit;
}

/// Bytes of the character that begins here, 0 where it is no UTF-8.
std::size_t characterAt(const std::string& s, std::size_t at) {
  const auto c = static_cast<unsigned char>(s[at]);
  const std::size_t length = c < 0x80                ? 1
                             : c >= 0xc2 && c < 0xe0 ? 2
                             : c >= 0xe0 && c < 0xf0 ? 3
                             : c >= 0xf0 && c < 0xf5 ? 4
                                                     : 0;
  if (length == 0 || at + length > s.size()) return 0;
  for (std::size_t n = 1; n < length; ++n)
    if ((static_cast<unsigned char>(s[at + n]) & 0xc0) != 0x80) return 0;
  return length;
}

}  // namespace

std::string shown(const std::string& text, std::size_t limit) {
  std::string clean;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = characterAt(text, at);
    // U+0080 to U+009F are control characters too.
    const bool control = static_cast<unsigned char>(text[at]) < 0x20 || text[at] == 0x7f ||
                         (length == 2 && static_cast<unsigned char>(text[at]) == 0xc2 &&
                          static_cast<unsigned char>(text[at + 1]) < 0xa0);
    const std::string one = length == 0 ? "?" : control ? "" : text.substr(at, length);
    if (clean.size() + one.size() > limit) break;
    clean += one;
    at += std::max<std::size_t>(length, 1);
  }
  const std::size_t first = clean.find_first_not_of(' ');
  if (first == std::string::npos) return {};
  return clean.substr(first, clean.find_last_not_of(' ') - first + 1);
}

std::string encodedKeys(const Keys& keys, const std::string& transferSyntax) {
  DcmDataset dataset;
  bool ascii = true;
  for (const auto& [tag, value] : keys) {
    ascii =
        ascii && std::all_of(value.begin(), value.end(), [](char c) { return static_cast<unsigned char>(c) < 0x80; });
    const OFCondition put =
        value.empty() ? dataset.insertEmptyElement(keyOf(tag)) : dataset.putAndInsertString(keyOf(tag), value.c_str());
    if (put.bad()) throw BadArgument(std::string("a query cannot hold this value: ") + put.text());
  }
  if (!ascii) dataset.putAndInsertString(DCM_SpecificCharacterSet, "ISO_IR 192");
  std::vector<char> buffer(64 * 1024);
  DcmOutputBufferStream stream(buffer.data(), static_cast<offile_off_t>(buffer.size()));
  dataset.transferInit();
  const OFCondition written = dataset.write(stream, syntaxOf(transferSyntax), EET_ExplicitLength, nullptr);
  dataset.transferEnd();
  if (written.bad()) throw BadArgument(std::string("a query cannot be written: ") + written.text());
  return {buffer.data(), static_cast<std::size_t>(stream.tell())};
}

Keys decodedKeys(const std::string& bytes, const std::string& transferSyntax,
                 const std::vector<std::uint32_t>& wanted) {
  if (bytes.size() > largestIdentifier) throw NetworkError("the server sent an answer that is too long to be one");
  DcmInputBufferStream stream;
  stream.setBuffer(bytes.data(), static_cast<offile_off_t>(bytes.size()));
  stream.setEos();
  DcmDataset dataset;
  dataset.transferInit();
  const OFCondition read = dataset.read(stream, syntaxOf(transferSyntax));
  dataset.transferEnd();
  if (read.bad() && read != EC_EndOfStream) throw NetworkError("the server sent an answer that is no DICOM data set");
  dataset.convertToUTF8();
  Keys keys;
  for (const std::uint32_t tag : wanted) {
    OFString value;
    if (dataset.findAndGetOFStringArray(keyOf(tag), value).good())
      keys[tag] = shown({value.c_str(), value.size()}, 200);
  }
  return keys;
}

}  // namespace glisson::pacs::detail
