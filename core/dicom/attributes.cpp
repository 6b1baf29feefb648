// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/detail/attributes.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include <dcmtk/dcmdata/dcistrmb.h>
#include <dcmtk/dcmdata/dcspchrs.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <mutex>
#include <set>

#include "base/error.h"
#include "base/sha256.h"

namespace glisson::dicom {
namespace {

std::string trimmed(std::string value) {
  const auto isPad = [](char c) { return c == ' ' || c == '\0' || c == '\t'; };
  while (!value.empty() && isPad(value.back())) value.pop_back();
  std::size_t first = 0;
  while (first < value.size() && isPad(value[first])) ++first;
  return value.substr(first);
}

/// Length of the UTF-8 character at the start, 0 where it is none.
std::size_t utf8Length(const std::string& s, std::size_t at) {
  const auto byte = [&s](std::size_t n) { return n < s.size() ? static_cast<unsigned char>(s[n]) : 0U; };
  const unsigned c = byte(at);
  const std::size_t n = c < 0x80                ? 1
                        : c >= 0xC2 && c < 0xE0 ? 2
                        : c >= 0xE0 && c < 0xF0 ? 3
                        : c >= 0xF0 && c < 0xF5 ? 4
                                                : 0;
  for (std::size_t k = 1; k < n; ++k)
    if ((byte(at + k) & 0xC0U) != 0x80U) return 0;
  return n;
}

}  // namespace

void parseHeader(const ByteSource& source, const FileLayout& layout, DcmDataset& dataset) {
  static std::once_flag quiet;
  std::call_once(quiet, [] { OFLog::configure(OFLogger::OFF_LOG_LEVEL); });
  std::vector<std::uint8_t> bytes = source.bytes(layout.datasetOffset, layout.headerEnd - layout.datasetOffset);
  DcmInputBufferStream stream;
  stream.setBuffer(bytes.data(), static_cast<offile_off_t>(bytes.size()));
  stream.setEos();
  const E_TransferSyntax syntax = layout.bigEndian    ? EXS_BigEndianExplicit
                                  : layout.explicitVr ? EXS_LittleEndianExplicit
                                                      : EXS_LittleEndianImplicit;
  dataset.transferInit();
  const OFCondition status = dataset.read(stream, syntax, EGL_noChange, DCM_MaxReadLength);
  dataset.transferEnd();
  if (status.bad() && status != EC_EndOfStream)
    throw BadInput(std::string("has a header that cannot be parsed (") + status.text() + ")");
}

std::string text(DcmItem& item, const DcmTagKey& tag) {
  DcmElement* element = nullptr;
  if (item.findAndGetElement(tag, element).bad() || element == nullptr) return {};
  OFString value;
  // Not normalised by DCMTK, which takes time quadratic in the number of values.
  if (element->ident() != EVR_UN && element->ident() != EVR_OB && element->getOFStringArray(value, OFFalse).good())
    return trimmed(std::string(value.c_str(), value.size()));
  Uint8* raw = nullptr;
  if (element->getUint8Array(raw).good() && raw != nullptr)
    return trimmed(std::string(reinterpret_cast<const char*>(raw), element->getLength()));
  return {};
}

std::string cleaned(const std::string& raw) {
  std::string out;
  std::size_t n = 0;
  while (n < raw.size() && out.size() < 60) {
    const std::size_t length = utf8Length(raw, n);
    const auto c = static_cast<unsigned char>(raw[n]);
    if (length == 0) {  // Latin-1
      out += static_cast<char>(0xC0U | (c >> 6U));
      out += static_cast<char>(0x80U | (c & 0x3FU));
      ++n;
      continue;
    }
    if (c >= 0x20 && c != 0x7F && !(length == 2 && c == 0xC2 && static_cast<unsigned char>(raw[n + 1]) < 0xA0))
      out.append(raw, n, length);
    n += length;
  }
  return trimmed(out);
}

std::string shownText(DcmItem& item, const DcmTagKey& tag) {
  return cleaned(text(item, tag));
}

std::string privateText(DcmItem& item, std::uint16_t group, std::uint8_t element, const char* creator) {
  bool firstIsAnothers = false;
  // One pass: creators stand before what they reserved.
  std::set<unsigned> blocks;
  for (DcmObject* o = item.nextInContainer(nullptr); o != nullptr; o = item.nextInContainer(o)) {
    const unsigned number = o->getETag();
    if (o->getGTag() < group) continue;
    if (o->getGTag() > group) break;
    if (number <= 0xFF) {
      const std::string owner = text(item, o->getTag());
      if (owner == creator)
        blocks.insert(number);
      else if (number == 0x10)
        firstIsAnothers = !owner.empty();
    } else if ((number & 0xFFU) == element && blocks.count(number >> 8U) > 0) {
      if (const std::string value = text(item, o->getTag()); !value.empty()) return value;
    }
  }
  if (firstIsAnothers || !blocks.empty()) return {};
  return text(item, DcmTagKey(group, static_cast<Uint16>(0x1000U | element)));
}

std::string unifiedText(DcmItem& item, const DcmTagKey& tag) {
  const std::string raw = text(item, tag);
  const bool plain = std::all_of(raw.begin(), raw.end(), [](char c) { return c >= 0x20 && c < 0x7F; });
  if (plain || raw.size() > 1024) return raw;
  DcmSpecificCharacterSet characters;
  OFString unified;
  const std::string named = text(item, DCM_SpecificCharacterSet);
  if (characters.selectCharacterSet(named.c_str(), "ISO_IR 192").bad() ||
      characters.convertString(raw.c_str(), raw.size(), unified, tag == DCM_PatientName ? "\\^=" : "\\").bad())
    return raw;
  return trimmed(std::string(unified.c_str(), unified.size()));
}

Origin originOf(DcmItem& item) {
  Origin origin;
  std::string name = unifiedText(item, DCM_PatientName);
  while (!name.empty() && (name.back() == '^' || name.back() == ' ')) name.pop_back();
  const std::string id = unifiedText(item, DCM_PatientID);
  if (!id.empty() || !name.empty()) {
    const std::string identity = id + '\0' + name;
    origin.patientKey = sha256(identity.data(), identity.size());
  }
  origin.studyUid = shownText(item, DCM_StudyInstanceUID);
  origin.studyDate = shownText(item, DCM_StudyDate).substr(0, 16);
  return origin;
}

std::string nameOf(const DcmTagKey& key) {
  DcmTag tag(key);
  return std::string(tag.getTagName()) + " " + key.toString().c_str();
}

std::vector<double> numbers(DcmItem& item, const DcmTagKey& tag) {
  const std::string all = text(item, tag);
  std::vector<double> out;
  if (all.empty()) return out;
  std::size_t begin = 0;
  while (begin <= all.size()) {
    const std::size_t end = std::min(all.find('\\', begin), all.size());
    std::string one = trimmed(all.substr(begin, end - begin));
    if (!one.empty() && one.front() == '+') one.erase(0, 1);
    double value = 0.0;
    const auto [stop, problem] = std::from_chars(one.data(), one.data() + one.size(), value);
    if (problem != std::errc{} || stop != one.data() + one.size() || !std::isfinite(value))
      throw BadInput(nameOf(tag) + " holds '" + cleaned(one).substr(0, 20) + "', which is no finite decimal number");
    out.push_back(value);
    begin = end + 1;
  }
  return out;
}

std::optional<double> number(DcmItem& item, const DcmTagKey& tag) {
  const std::vector<double> all = numbers(item, tag);
  if (all.empty()) return {};
  if (all.size() != 1)
    throw BadInput(nameOf(tag) + " holds " + std::to_string(all.size()) + " values where one was expected");
  return all.front();
}

std::optional<int> count(DcmItem& item, const DcmTagKey& tag) {
  Uint16 value = 0;
  if (item.findAndGetUint16(tag, value).bad()) return {};
  return value;
}

DcmItem* itemOf(DcmItem& item, const DcmTagKey& sequence, unsigned long index) {
  DcmSequenceOfItems* items = nullptr;
  if (item.findAndGetSequence(sequence, items).bad() || items == nullptr || index >= items->card()) return nullptr;
  return items->getItem(index);
}

unsigned long itemCount(DcmItem& item, const DcmTagKey& sequence) {
  DcmSequenceOfItems* items = nullptr;
  if (item.findAndGetSequence(sequence, items).bad() || items == nullptr) return 0;
  return items->card();
}

}  // namespace glisson::dicom
