// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/detail/code_streams.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include <algorithm>

#include "base/error.h"
#include "dicom/detail/jpeg2000.h"

namespace glisson::dicom::detail {
namespace {

bool isRle(const std::string& syntax) {
  return syntax == UID_RLELosslessTransferSyntax;
}

/// A run-length code stream has no size of its own: each segment [PS3.5 annex G] must unpack to one byte of every
/// pixel, or rows and columns are not what was compressed. One byte of padding is allowed.
void checkRunLengths(const std::vector<std::uint8_t>& b, std::uint64_t segments, std::uint64_t pixels,
                     const std::string& where) {
  const auto offset = [&b](std::uint64_t at) {
    const auto n = static_cast<std::size_t>(at);
    return static_cast<std::size_t>(b[n]) | static_cast<std::size_t>(b[n + 1]) << 8 |
           static_cast<std::size_t>(b[n + 2]) << 16 | static_cast<std::size_t>(b[n + 3]) << 24;
  };
  for (std::uint64_t s = 0; s < segments; ++s) {
    std::size_t at = offset(4 + 4 * s);
    const std::size_t end = s + 1 < segments ? offset(8 + 4 * s) : b.size();
    std::uint64_t unpacked = 0;
    while (at + 1 < end) {
      const int n = static_cast<std::int8_t>(b[at]);
      if (n == -128) {
        ++at;
        continue;
      }
      unpacked += static_cast<std::uint64_t>(n >= 0 ? n + 1 : 1 - n);
      at += n >= 0 ? static_cast<std::size_t>(n) + 2 : 2;
    }
    if (at > end || unpacked < pixels || unpacked > pixels + 1)
      throw BadInput("has a run-length segment of " + std::to_string(unpacked) + " pixels where its header says " +
                     std::to_string(pixels) + where);
  }
}

std::string sizeText(int width, int height, int components) {
  return std::to_string(width) + " x " + std::to_string(height) + " pixels of " + std::to_string(components) +
         " sample(s)";
}

/// The run-length code stream of one picture. bytes: the beginning of its fragment. whole: it has a fragment of its
/// own.
void checkRunLength(const ImageHeader& header, const ByteSource& source, const Fragment& f,
                    const std::vector<std::uint8_t>& bytes, bool whole, const std::string& where) {
  const auto number32 = [&bytes](std::size_t at) {
    return static_cast<std::uint64_t>(bytes[at]) | static_cast<std::uint64_t>(bytes[at + 1]) << 8 |
           static_cast<std::uint64_t>(bytes[at + 2]) << 16 | static_cast<std::uint64_t>(bytes[at + 3]) << 24;
  };
  if (bytes.size() < 64) throw BadInput("has a run-length code stream without its header" + where);
  const std::uint64_t segments = number32(0);
  const auto expected = static_cast<std::uint64_t>(header.samples * header.bitsAllocated / 8);
  if (segments != expected)
    throw BadInput("has a run-length code stream of " + std::to_string(segments) + " segments where " +
                   std::to_string(expected) + " were expected" + where);
  std::uint64_t last = 64;
  for (std::size_t s = 0; s < expected; ++s) {
    const std::uint64_t begin = number32(4 + 4 * s);
    if (begin < last || begin > f.length) throw BadInput("has run-length segments outside of their frame" + where);
    last = begin;
  }
  if (whole)
    checkRunLengths(source.bytes(f.offset, f.length), expected,
                    static_cast<std::uint64_t>(header.rows) * static_cast<std::uint64_t>(header.columns), where);
}

void checkJpeg2000(const ImageHeader& header, const ByteSource& source, int frame, const std::string& where) {
  const Jpeg2000Size size = jpeg2000Size(bytesOf(fragmentsOf(header, frame), source, 4096));
  if (size.width != header.columns || size.height != header.rows || size.components != header.samples)
    throw BadInput("has a JPEG 2000 code stream of " + std::to_string(size.width) + " x " +
                   std::to_string(size.height) + " pixels of " + std::to_string(size.components) +
                   " sample(s), but its header says " + sizeText(header.columns, header.rows, header.samples) + where);
  if (size.bits > header.bitsAllocated)
    throw BadInput("has a JPEG 2000 code stream of " + std::to_string(size.bits) + " bits, but its header says " +
                   std::to_string(header.bitsAllocated) + where);
  if (size.isSigned != header.isSigned)
    throw BadInput(std::string("has a JPEG 2000 code stream of ") + (size.isSigned ? "signed" : "unsigned") +
                   " numbers, but its header says " + (header.isSigned ? "signed" : "unsigned") + " (0028,0103)" +
                   where);
}

/// A marker that a frame header begins with, of JPEG or JPEG-LS.
bool beginsFrame(int marker) {
  return (marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC) || marker == 0xF7;
}

/// JPEG and JPEG-LS: the first frame header that the markers lead to. b: the beginning of the code stream.
void checkJpeg(const ImageHeader& header, const std::vector<std::uint8_t>& b, const std::string& where) {
  const auto number16 = [&b](std::size_t at) { return (b[at] << 8) | b[at + 1]; };
  if (b.size() < 4 || b[0] != 0xFF || b[1] != 0xD8)
    throw BadInput("has compressed pixels that do not begin as a JPEG code stream" + where);
  for (std::size_t at = 2; at + 10 <= b.size() && b[at] == 0xFF;) {
    const int marker = b[at + 1];
    if (beginsFrame(marker)) {
      const int height = number16(at + 5);
      const int width = number16(at + 7);
      const int components = b[at + 9];
      if (height != header.rows || width != header.columns || components != header.samples)
        throw BadInput("has a code stream of " + sizeText(width, height, components) + ", but its header says " +
                       sizeText(header.columns, header.rows, header.samples) + where);
      if (b[at + 4] > header.bitsAllocated)
        throw BadInput("has a code stream of " + std::to_string(b[at + 4]) + " bits, but its header says " +
                       std::to_string(header.bitsAllocated) + where);
      return;
    }
    at += marker == 0xFF ? 1 : 2 + static_cast<std::size_t>(number16(at + 2));
  }
  throw BadInput("has a code stream without an image size" + where);
}

}  // namespace

bool isJpeg2000(const std::string& syntax) {
  return syntax == UID_JPEG2000LosslessOnlyTransferSyntax || syntax == UID_JPEG2000TransferSyntax;
}

std::span<const Fragment> fragmentsOf(const ImageHeader& header, int frame) {
  const std::vector<Fragment>& all = header.layout.pixels->fragments;
  const std::size_t pictures = header.isMosaic() ? 1 : header.frames.size();
  if (pictures == 1) return all;
  return std::span(all).subspan(static_cast<std::size_t>(frame), 1);
}

std::vector<std::uint8_t> bytesOf(std::span<const Fragment> fragments, const ByteSource& source, std::uint64_t most) {
  std::vector<std::uint8_t> out;
  for (const Fragment& f : fragments) {
    if (out.size() >= most) break;
    const auto piece = source.bytes(f.offset, std::min<std::uint64_t>(f.length, most - out.size()));
    out.insert(out.end(), piece.begin(), piece.end());
  }
  return out;
}

void checkCodeStreams(const ImageHeader& header, const ByteSource& source) {
  const std::string& syntax = header.layout.transferSyntax;
  const auto& fragments = header.layout.pixels->fragments;
  const std::size_t pictures = header.isMosaic() ? 1 : header.frames.size();
  if (isJpeg2000(syntax) && pictures > 1 && fragments.size() != pictures)
    throw BadInput("has " + std::to_string(pictures) + " frames in " + std::to_string(fragments.size()) +
                   " compressed fragments; which belong together is not guessed");
  const bool oneEach = fragments.size() == pictures;
  for (std::size_t n = 0; n < (oneEach ? pictures : 1); ++n) {
    const Fragment& f = fragments[n];
    const std::string where = " (frame " + std::to_string(n + 1) + ")";
    const std::vector<std::uint8_t> begin = source.bytes(f.offset, std::min<std::uint64_t>(f.length, 1U << 16));
    if (isRle(syntax))
      checkRunLength(header, source, f, begin, oneEach, where);
    else if (isJpeg2000(syntax))
      checkJpeg2000(header, source, static_cast<int>(n), where);
    else
      checkJpeg(header, begin, where);
  }
}

}  // namespace glisson::dicom::detail
