// SPDX-License-Identifier: GPL-3.0-or-later
#include <fstream>
#include <sstream>

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include "base/error.h"
#include "base/part_file.h"
#include "dicom/detail/attributes.h"
#include "dicom/detail/clean_copy.h"
#include "dicom/detail/writer.h"
#include "dicom/write_mr.h"

namespace glisson::dicom {
namespace {

std::string shortElement(std::uint16_t element, const char* vr, std::string value) {
  if (value.size() % 2 != 0) value += '\0';  // UIDs and raw bytes are padded with a zero
  const auto low = [](std::size_t v) {
    return std::string{static_cast<char>(v & 0xFF), static_cast<char>(v >> 8 & 0xFF)};
  };
  return low(0x0002) + low(element) + vr + low(value.size()) + value;
}

/// Preamble and file meta information; nothing of the source's but its transfer syntax.
std::string metaInformation(const std::string& sopClass, const std::string& sopInstance, const std::string& syntax) {
  const std::string version = std::string("\x02\x00\x01\x00OB\x00\x00\x02\x00\x00\x00\x00\x01", 14);
  const std::string body = version + shortElement(0x0002, "UI", sopClass) + shortElement(0x0003, "UI", sopInstance) +
                           shortElement(0x0010, "UI", syntax) +
                           shortElement(0x0012, "UI", uidFrom("glisson/implementation"));
  std::string length;
  for (int n = 0; n < 4; ++n) length += static_cast<char>(body.size() >> (8 * n) & 0xFF);
  return std::string(128, '\0') + "DICM" + shortElement(0x0000, "UL", length) + body;
}

/// Where the bytes of the pixel element end.
std::uint64_t endOfPixels(const FileLayout& layout) {
  if (!layout.pixels) return layout.headerEnd;
  const PixelElement& p = *layout.pixels;
  if (!p.encapsulated) return p.offset + p.length;
  if (p.fragments.empty()) throw BadInput("has compressed pixels without any code stream");
  return p.fragments.back().offset + p.fragments.back().length + 8;  // sequence delimiter
}

}  // namespace

void writeCleanCopy(DcmDataset& data, const ByteSource& source, const FileLayout& layout,
                    const std::filesystem::path& file) {
  const E_TransferSyntax written = layout.bigEndian    ? EXS_BigEndianExplicit
                                   : layout.explicitVr ? EXS_LittleEndianExplicit
                                                       : EXS_LittleEndianImplicit;
  const bool compressed = layout.pixels && layout.pixels->encapsulated;
  const std::string syntax = compressed ? layout.transferSyntax : DcmXfer(written).getXferID();
  const std::uint64_t end = endOfPixels(layout);
  PartFile header(file), whole(file);
  if (data.saveFile(header.path().c_str(), written, EET_ExplicitLength).bad())
    throw Error("a de-identified file cannot be written; is the folder writable, and the disk not full?");
  std::ifstream from(header.path(), std::ios::binary);
  std::ostringstream start;
  start << metaInformation(text(data, DCM_SOPClassUID), text(data, DCM_SOPInstanceUID), syntax) << from.rdbuf();
  const std::string head = start.str();
  whole.write(head.data(), head.size());
  for (std::uint64_t at = layout.headerEnd; at < end;) {
    const std::uint64_t piece = std::min<std::uint64_t>(end - at, 1U << 20);
    const std::vector<std::uint8_t> bytes = source.bytes(at, piece);
    whole.write(bytes.data(), bytes.size());
    at += piece;
  }
  whole.become();
}

}  // namespace glisson::dicom
