// SPDX-License-Identifier: GPL-3.0-or-later
#include "exchange/picture_file.h"

#include <png.h>

#include "base/error.h"

namespace glisson::exchange {

RgbPicture readPng(const std::filesystem::path& file) {
  const std::string which = "'" + file.filename().string() + "'";
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&image, file.c_str()) == 0) throw BadInput(which + " is no PNG picture");
  image.format = PNG_FORMAT_RGB;
  if (image.width > 20000 || image.height > 20000) {
    png_image_free(&image);
    throw BadInput(which + " has more than 20,000 pixels along a side");
  }
  RgbPicture picture{static_cast<int>(image.width), static_cast<int>(image.height), {}};
  picture.rgb.resize(PNG_IMAGE_SIZE(image));
  const png_color background{255, 255, 255};
  if (png_image_finish_read(&image, &background, picture.rgb.data(), 0, nullptr) == 0) {
    png_image_free(&image);
    throw BadInput(which + " is a damaged PNG picture");
  }
  return picture;
}

}  // namespace glisson::exchange
