// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace glisson::render {

/// A line of text as coverage (0..255), to be blended by whoever draws. The pen starts at (0, 0) on the baseline;
/// the first stored pixel is (left, top), y down.
struct TextMask {
  int left = 0, top = 0, width = 0, height = 0;
  std::vector<std::uint8_t> coverage;
};

/// Size, slope and weight of a line of text.
struct TextShape {
  double size_px = 16.0;   ///< em size
  double angle_deg = 0.0;  ///< counter-clockwise about the pen's start
  bool bold = false;
};

/// Rasterises one line of UTF-8 with the built-in font (DejaVu Sans): the same pixels on every machine, whatever fonts
/// it has, and no OpenGL. Safe to call from any thread.
TextMask rasterText(const std::string& utf8, const TextShape& shape);

/// The font file itself (TrueType), for documents that carry their font.
std::span<const unsigned char> builtInFont();

/// Advance width of one line, pixels.
double textWidth(const std::string& utf8, double size_px, bool bold = false);

}  // namespace glisson::render
