// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace glisson::render {

/// An RGB picture, row 0 at the top, 3 bytes a pixel.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
};

/// Writes a PNG with its resolution (dots per inch) recorded (pHYs chunk). Written beside, then renamed, so that a
/// failure leaves the old file. The bytes depend on the pixels and dpi only. Throws BadInput where the file cannot be
/// written, BadArgument where the picture is empty or its sizes disagree.
void writePng(const std::filesystem::path& file, const Picture& picture, double dpi = 300.0);

/// The same bytes in memory, for reports that embed pictures.
std::vector<std::uint8_t> encodePng(const Picture& picture, double dpi = 300.0);

}  // namespace glisson::render
