// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/detail/packed_frames.h"

#include <zlib.h>

#include <algorithm>

#include "base/error.h"

namespace glisson::dicom {
namespace {

const std::string runLength = "1.2.840.10008.1.2.5";
const std::string deflatedFrame = "1.2.840.10008.1.2.8.1";

/// PackBits [PS3.5 annex G] of one segment.
std::vector<std::uint8_t> unpackRuns(const std::vector<std::uint8_t>& b, std::size_t expected,
                                     const std::string& where) {
  const auto number32 = [&b](std::size_t at) {
    return static_cast<std::uint32_t>(b[at]) | static_cast<std::uint32_t>(b[at + 1]) << 8 |
           static_cast<std::uint32_t>(b[at + 2]) << 16 | static_cast<std::uint32_t>(b[at + 3]) << 24;
  };
  if (b.size() < 64 || number32(0) != 1 || number32(4) != 64)
    throw BadInput("has a run-length code stream with a damaged header" + where);
  std::vector<std::uint8_t> out;
  out.reserve(expected);
  std::size_t at = 64;
  while (at < b.size() && out.size() < expected) {
    const int n = static_cast<std::int8_t>(b[at++]);
    if (n == -128) continue;
    if (n >= 0) {
      const auto count = static_cast<std::size_t>(n) + 1;
      if (b.size() - at < count) throw BadInput("has a run-length code stream that breaks off" + where);
      out.insert(out.end(), b.begin() + static_cast<std::ptrdiff_t>(at),
                 b.begin() + static_cast<std::ptrdiff_t>(at + count));
      at += count;
    } else {
      if (at == b.size()) throw BadInput("has a run-length code stream that breaks off" + where);
      out.insert(out.end(), static_cast<std::size_t>(1 - n), b[at++]);
    }
  }
  if (out.size() < expected || out.size() > expected + 1)
    throw BadInput("has a run-length code stream of " + std::to_string(out.size()) + " bytes where " +
                   std::to_string(expected) + " were expected" + where);
  out.resize(expected);
  return out;
}

std::vector<std::uint8_t> inflateFrame(std::vector<std::uint8_t> b, std::size_t expected, const std::string& where) {
  std::vector<std::uint8_t> out(expected + 2);
  z_stream z{};
  if (inflateInit2(&z, -MAX_WBITS) != Z_OK) throw BadInput("has deflated pixels that cannot be read" + where);
  z.next_in = b.data();
  z.avail_in = static_cast<uInt>(b.size());
  z.next_out = out.data();
  z.avail_out = static_cast<uInt>(out.size());
  const int status = inflate(&z, Z_FINISH);
  const std::size_t got = out.size() - z.avail_out;
  inflateEnd(&z);
  if (status != Z_STREAM_END || got < expected || got > expected + 1)
    throw BadInput("has a deflated frame that is damaged or of another size than " + std::to_string(expected) +
                   " bytes" + where);
  out.resize(expected);
  return out;
}

}  // namespace

PackedFrames::PackedFrames(const ByteSource& source, const FileLayout& layout, std::size_t frames,
                           std::size_t pixelsPerFrame, int bits)
    : source_(source), layout_(layout), pixels_(pixelsPerFrame), bits_(bits) {
  if (!layout.pixels || layout.pixels->element != 0x0010) throw BadInput("has no pixel data");
  const PixelElement& p = *layout.pixels;
  if (!p.encapsulated) {
    const std::uint64_t need =
        (static_cast<std::uint64_t>(frames) * pixels_ * static_cast<std::uint64_t>(bits) + 7) / 8;
    if (p.length < need || p.length > need + 1)
      throw BadInput("has " + std::to_string(p.length) + " bytes of pixels where its header asks for " +
                     std::to_string(need));
    if (layout.bigEndian && p.words)
      throw BadInput("has packed pixels in big-endian words; convert it to little endian");
    return;
  }
  if (layout.transferSyntax != runLength && layout.transferSyntax != deflatedFrame)
    throw BadInput("has a segmentation compressed with transfer syntax " + layout.transferSyntax +
                   (layout.transferSyntax.starts_with("1.2.840.10008.1.2.4.9") ? " (JPEG 2000)" : "") +
                   ", which is not read; convert it to an uncompressed one");
  if (p.fragments.size() != frames)
    throw BadInput("has " + std::to_string(p.fragments.size()) + " code streams for " + std::to_string(frames) +
                   " frames");
}

std::vector<std::uint8_t> PackedFrames::frame(std::size_t n) const {
  const PixelElement& p = *layout_.pixels;
  const std::string where = " (frame " + std::to_string(n + 1) + ")";
  std::vector<std::uint8_t> packed;
  std::size_t firstBit = 0;
  if (p.encapsulated) {
    const std::size_t bytes = bits_ == 1 ? (pixels_ + 7) / 8 : pixels_;
    const Fragment& f = p.fragments[n];
    packed = source_.bytes(f.offset, f.length);
    packed =
        layout_.transferSyntax == runLength ? unpackRuns(packed, bytes, where) : inflateFrame(packed, bytes, where);
  } else if (bits_ == 8) {
    packed = source_.bytes(p.offset + static_cast<std::uint64_t>(n) * pixels_, pixels_);
  } else {
    const std::uint64_t begin = static_cast<std::uint64_t>(n) * pixels_;
    const std::uint64_t end = begin + pixels_;
    firstBit = static_cast<std::size_t>(begin % 8);
    packed = source_.bytes(p.offset + begin / 8, (end + 7) / 8 - begin / 8);
  }
  if (bits_ == 8) return packed;
  std::vector<std::uint8_t> out(pixels_);
  for (std::size_t i = 0; i < pixels_; ++i) {
    const std::size_t bit = firstBit + i;
    out[i] = static_cast<std::uint8_t>((packed[bit / 8] >> (bit % 8)) & 1U);
  }
  return out;
}

}  // namespace glisson::dicom
