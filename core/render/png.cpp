// SPDX-License-Identifier: GPL-3.0-or-later
#include <png.h>

#include <cmath>
#include <string>

#include "base/error.h"
#include "base/part_file.h"
#include "render/picture.h"

namespace glisson::render {
namespace {

[[noreturn]] void refuse(png_structp, png_const_charp why) {
  throw Error(std::string("the PNG encoder failed: ") + why);
}
void ignore(png_structp, png_const_charp) {}

void append(png_structp png, png_bytep bytes, png_size_t count) {
  auto& to = *static_cast<std::vector<std::uint8_t>*>(png_get_io_ptr(png));
  to.insert(to.end(), bytes, bytes + count);
}

/// libpng's two structures, given back whatever happens.
struct Encoder {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, refuse, ignore);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  Encoder() = default;
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;
  ~Encoder() { png_destroy_write_struct(&png, &info); }
};

}  // namespace

std::vector<std::uint8_t> encodePng(const Picture& picture, double dpi) {
  if (picture.width < 1 || picture.height < 1 ||
      picture.rgb.size() != 3 * static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height))
    throw BadArgument("a picture of " + std::to_string(picture.width) + " x " + std::to_string(picture.height) +
                      " pixels with " + std::to_string(picture.rgb.size()) + " bytes cannot be encoded as PNG");
  if (!(dpi > 0.0) || dpi > 1e5) throw BadArgument("a resolution of " + std::to_string(dpi) + " dpi is not usable");

  std::vector<std::uint8_t> bytes;
  const Encoder encoder;
  if (!encoder.info) throw Error("the PNG encoder cannot be started");
  png_set_write_fn(encoder.png, &bytes, append, nullptr);
  png_set_IHDR(encoder.png, encoder.info, static_cast<png_uint_32>(picture.width),
               static_cast<png_uint_32>(picture.height), 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  const auto perMetre = static_cast<png_uint_32>(std::lround(dpi / 0.0254));
  png_set_pHYs(encoder.png, encoder.info, perMetre, perMetre, PNG_RESOLUTION_METER);
  png_write_info(encoder.png, encoder.info);
  const std::size_t row = 3 * static_cast<std::size_t>(picture.width);
  for (std::size_t y = 0; y < static_cast<std::size_t>(picture.height); ++y)
    png_write_row(encoder.png, picture.rgb.data() + y * row);
  png_write_end(encoder.png, encoder.info);
  return bytes;
}

void writePng(const std::filesystem::path& file, const Picture& picture, double dpi) {
  const std::vector<std::uint8_t> png = encodePng(picture, dpi);
  PartFile part(file);
  part.write(png.data(), png.size());
  part.become();
}

}  // namespace glisson::render
