// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/detail/jpeg2000.h"

#include <openjpeg.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>

#include "base/error.h"

namespace glisson::dicom::detail {
namespace {

constexpr std::array<std::uint8_t, 4> codeStreamStart = {0xFF, 0x4F, 0xFF, 0x51};
constexpr std::array<std::uint8_t, 8> jp2Start = {0, 0, 0, 0x0C, 0x6A, 0x50, 0x20, 0x20};

struct Memory {
  const std::vector<std::uint8_t>* bytes = nullptr;
  std::size_t at = 0;
};

OPJ_SIZE_T readSome(void* to, OPJ_SIZE_T count, void* user) {
  auto& m = *static_cast<Memory*>(user);
  const std::size_t n = std::min<std::size_t>(count, m.bytes->size() - m.at);
  if (n == 0) return static_cast<OPJ_SIZE_T>(-1);
  std::memcpy(to, m.bytes->data() + m.at, n);
  m.at += n;
  return n;
}

OPJ_OFF_T skipSome(OPJ_OFF_T count, void* user) {
  auto& m = *static_cast<Memory*>(user);
  if (count < 0) return -1;
  const std::size_t n = std::min<std::size_t>(static_cast<std::size_t>(count), m.bytes->size() - m.at);
  m.at += n;
  return static_cast<OPJ_OFF_T>(n);
}

OPJ_BOOL seekTo(OPJ_OFF_T place, void* user) {
  auto& m = *static_cast<Memory*>(user);
  if (place < 0 || static_cast<std::size_t>(place) > m.bytes->size()) return OPJ_FALSE;
  m.at = static_cast<std::size_t>(place);
  return OPJ_TRUE;
}

void say(const char*, void*) {}

std::size_t streamStart(const std::vector<std::uint8_t>& b) {
  if (b.size() >= 8 && std::equal(jp2Start.begin(), jp2Start.end(), b.begin()))
    return static_cast<std::size_t>(std::search(b.begin(), b.end(), codeStreamStart.begin(), codeStreamStart.end()) -
                                    b.begin());
  return b.size() >= 4 && std::equal(codeStreamStart.begin(), codeStreamStart.end(), b.begin()) ? 0 : b.size();
}

}  // namespace

Jpeg2000Size jpeg2000Size(const std::vector<std::uint8_t>& stream) {
  const std::size_t start = streamStart(stream);
  Jpeg2000Size size;
  const auto number = [&stream](std::size_t at, int count) {
    std::int64_t value = 0;
    for (int n = 0; n < count; ++n) value = (value << 8) | stream[at + static_cast<std::size_t>(n)];
    return value;
  };
  if (stream.size() < start + 43) return size;
  size.width = number(start + 8, 4) - number(start + 16, 4);
  size.height = number(start + 12, 4) - number(start + 20, 4);
  size.components = static_cast<int>(number(start + 40, 2));
  size.bits = (stream[start + 42] & 0x7F) + 1;
  size.isSigned = (stream[start + 42] & 0x80) != 0;
  // Marker segments up to the coding style (COD), which names the wavelet.
  std::size_t at = start + 2;
  while (at + 14 <= stream.size() && stream[at] == 0xFF) {
    if (stream[at + 1] == 0x52) {
      size.reversible = stream[at + 13] == 1;
      break;
    }
    at += 2 + static_cast<std::size_t>(number(at + 2, 2));
  }
  return size;
}

std::vector<std::uint8_t> decodeJpeg2000(const std::vector<std::uint8_t>& stream, int rows, int columns,
                                         int bytesPerPixel) {
  const auto damaged = [] { return BadInput("has a JPEG 2000 code stream that cannot be decoded"); };
  const bool boxed = stream.size() >= 8 && std::equal(jp2Start.begin(), jp2Start.end(), stream.begin());
  const std::unique_ptr<opj_codec_t, void (*)(opj_codec_t*)> codec(
      opj_create_decompress(boxed ? OPJ_CODEC_JP2 : OPJ_CODEC_J2K), opj_destroy_codec);
  opj_set_info_handler(codec.get(), say, nullptr);
  opj_set_warning_handler(codec.get(), say, nullptr);
  opj_set_error_handler(codec.get(), say, nullptr);
  opj_dparameters_t parameters;
  opj_set_default_decoder_parameters(&parameters);
  if (opj_setup_decoder(codec.get(), &parameters) == OPJ_FALSE) throw damaged();
  // Half a picture is none: a stream that ends too early is an error.
  opj_decoder_set_strict_mode(codec.get(), OPJ_TRUE);
  const std::unique_ptr<opj_stream_t, void (*)(opj_stream_t*)> input(opj_stream_create(1U << 20, OPJ_TRUE),
                                                                     opj_stream_destroy);
  Memory memory{&stream, 0};
  opj_stream_set_user_data(input.get(), &memory, nullptr);
  opj_stream_set_user_data_length(input.get(), stream.size());
  opj_stream_set_read_function(input.get(), readSome);
  opj_stream_set_skip_function(input.get(), skipSome);
  opj_stream_set_seek_function(input.get(), seekTo);
  opj_image_t* raw = nullptr;
  const bool begun = opj_read_header(input.get(), codec.get(), &raw) == OPJ_TRUE;
  const std::unique_ptr<opj_image_t, void (*)(opj_image_t*)> image(raw, opj_image_destroy);
  if (!begun || !image || image->numcomps != 1) throw damaged();
  if (static_cast<std::int64_t>(image->x1) - image->x0 != columns ||
      static_cast<std::int64_t>(image->y1) - image->y0 != rows)
    throw BadInput("has a JPEG 2000 code stream of another size than its header");
  if (opj_decode(codec.get(), input.get(), image.get()) == OPJ_FALSE) throw damaged();
  if (opj_end_decompress(codec.get(), input.get()) == OPJ_FALSE) throw damaged();
  const opj_image_comp_t& pixels = image->comps[0];
  if (pixels.data == nullptr || static_cast<int>(pixels.w) != columns || static_cast<int>(pixels.h) != rows ||
      static_cast<int>(pixels.prec) > 8 * bytesPerPixel)
    throw damaged();
  const std::size_t count = static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
  std::vector<std::uint8_t> out(count * static_cast<std::size_t>(bytesPerPixel));
  for (std::size_t n = 0; n < count; ++n) {
    const auto value = static_cast<std::uint32_t>(pixels.data[n]);
    for (int byte = 0; byte < bytesPerPixel; ++byte)
      out[n * static_cast<std::size_t>(bytesPerPixel) + static_cast<std::size_t>(byte)] =
          static_cast<std::uint8_t>(value >> (8 * byte));
  }
  return out;
}

}  // namespace glisson::dicom::detail
