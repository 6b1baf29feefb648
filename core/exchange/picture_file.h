// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace glisson::exchange {

/// An RGB picture, row 0 at the top, 3 bytes a pixel.
struct RgbPicture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
};

/// Reads a PNG of 8-bit RGB (or RGBA: opacity is left out). Throws BadInput where it is none.
RgbPicture readPng(const std::filesystem::path& file);

}  // namespace glisson::exchange
