// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/font.h"

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>

#include "base/error.h"

// The font is part of the program, so that pictures do not depend on what is installed.
asm(".section .rodata\n"
    ".global glisson_font_begin\n.hidden glisson_font_begin\n"
    ".global glisson_font_end\n.hidden glisson_font_end\n"
    ".balign 16\n"
    "glisson_font_begin:\n.incbin \"" GLISSON_FONT_FILE
    "\"\n"
    "glisson_font_end:\n.byte 0\n"
    ".previous\n");
extern "C" {
extern const unsigned char glisson_font_begin[];
extern const unsigned char glisson_font_end[];
}

namespace glisson::render {
namespace {

class Font {
 public:
  Font() {
    if (FT_Init_FreeType(&library_) != 0 ||
        FT_New_Memory_Face(library_, glisson_font_begin, glisson_font_end - glisson_font_begin, 0, &face_) != 0)
      throw Error("the built-in font cannot be opened");
  }
  ~Font() {
    FT_Done_Face(face_);
    FT_Done_FreeType(library_);
  }
  Font(const Font&) = delete;
  Font& operator=(const Font&) = delete;

  void setSize(double size_px) {
    FT_Set_Char_Size(face_, 0, static_cast<FT_F26Dot6>(std::lround(size_px * 64.0)), 72, 72);
  }
  /// Loads the outline, unhinted: text may be rotated and must keep its proportions at every size.
  FT_GlyphSlot load(char32_t code, double embolden_px) {
    if (FT_Load_Char(face_, code, FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP) != 0)
      throw Error("the built-in font cannot give a glyph");
    if (embolden_px > 0.0) FT_Outline_Embolden(&face_->glyph->outline, static_cast<FT_Pos>(embolden_px * 64.0));
    return face_->glyph;
  }
  double kerning_px(FT_UInt left, FT_UInt right) {
    FT_Vector delta{};
    if (left != 0 && right != 0) FT_Get_Kerning(face_, left, right, FT_KERNING_UNFITTED, &delta);
    return static_cast<double>(delta.x) / 64.0;
  }
  FT_UInt index(char32_t code) { return FT_Get_Char_Index(face_, code); }

 private:
  FT_Library library_ = nullptr;
  FT_Face face_ = nullptr;
};

std::mutex fontMutex;
Font& font() {
  static Font one;
  return one;
}

/// Malformed bytes become U+FFFD: a caption must never stop a picture.
std::u32string decode(const std::string& utf8) {
  std::u32string out;
  for (std::size_t n = 0; n < utf8.size();) {
    const auto lead = static_cast<unsigned char>(utf8[n]);
    const int more = lead < 0x80 ? 0 : (lead >> 5) == 6 ? 1 : (lead >> 4) == 14 ? 2 : (lead >> 3) == 30 ? 3 : -1;
    char32_t code = more == 0 ? lead : more > 0 ? (lead & (0x3fU >> more)) : 0xfffd;
    std::size_t used = 1;
    for (int m = 0; m < more; ++m, ++used) {
      if (n + used >= utf8.size() || (static_cast<unsigned char>(utf8[n + used]) >> 6) != 2) {
        code = 0xfffd;
        break;
      }
      code = (code << 6) | (static_cast<unsigned char>(utf8[n + used]) & 0x3fU);
    }
    out.push_back(code < 0x20 ? U' ' : code);
    n += used;
  }
  return out;
}

double boldness_px(const TextShape& shape) {
  return shape.bold ? shape.size_px / 26.0 : 0.0;
}

struct PlacedBitmap {
  int left, top, width, height;
  std::vector<std::uint8_t> coverage;
};

double advance_px(FT_GlyphSlot glyph, double bold_px) {
  return static_cast<double>(glyph->linearHoriAdvance) / 65536.0 + bold_px;
}

}  // namespace

std::span<const unsigned char> builtInFont() {
  return {glisson_font_begin, glisson_font_end};
}

double textWidth(const std::string& utf8, double size_px, bool bold) {
  const std::scoped_lock lock(fontMutex);
  Font& f = font();
  f.setSize(size_px);
  const double bold_px = boldness_px({.size_px = size_px, .bold = bold});
  double pen = 0.0;
  FT_UInt previous = 0;
  for (const char32_t code : decode(utf8)) {
    const FT_UInt glyph = f.index(code);
    pen += f.kerning_px(previous, glyph) + advance_px(f.load(code, bold_px), bold_px);
    previous = glyph;
  }
  return pen;
}

TextMask rasterText(const std::string& utf8, const TextShape& shape) {
  const std::scoped_lock lock(fontMutex);
  Font& f = font();
  f.setSize(shape.size_px);
  const double angle = shape.angle_deg * std::numbers::pi / 180.0;
  const double c = std::cos(angle), s = std::sin(angle);
  const FT_Matrix turn{std::lround(c * 65536.0), std::lround(-s * 65536.0), std::lround(s * 65536.0),
                       std::lround(c * 65536.0)};
  const double bold_px = boldness_px(shape);

  std::vector<PlacedBitmap> glyphs;
  double pen = 0.0;
  FT_UInt previous = 0;
  int left = 0, top = 0, right = 0, bottom = 0;
  for (const char32_t code : decode(utf8)) {
    const FT_UInt index = f.index(code);
    FT_GlyphSlot glyph = f.load(code, bold_px);
    pen += f.kerning_px(previous, index);
    previous = index;
    const double advance = advance_px(glyph, bold_px);
    FT_Outline_Transform(&glyph->outline, &turn);
    FT_Outline_Translate(&glyph->outline, std::lround(64.0 * pen * c), std::lround(64.0 * pen * s));
    pen += advance;
    if (FT_Render_Glyph(glyph, FT_RENDER_MODE_NORMAL) != 0) continue;  // a blank has no outline
    const FT_Bitmap& b = glyph->bitmap;
    PlacedBitmap placed{
        glyph->bitmap_left, -glyph->bitmap_top, static_cast<int>(b.width), static_cast<int>(b.rows), {}};
    if (placed.width == 0 || placed.height == 0) continue;
    for (int y = 0; y < placed.height; ++y)
      placed.coverage.insert(placed.coverage.end(), b.buffer + y * b.pitch, b.buffer + y * b.pitch + placed.width);
    if (glyphs.empty()) {
      left = placed.left;
      top = placed.top;
      right = left;
      bottom = top;
    }
    left = std::min(left, placed.left);
    top = std::min(top, placed.top);
    right = std::max(right, placed.left + placed.width);
    bottom = std::max(bottom, placed.top + placed.height);
    glyphs.push_back(std::move(placed));
  }

  TextMask mask{left, top, right - left, bottom - top, {}};
  mask.coverage.assign(static_cast<std::size_t>(mask.width) * static_cast<std::size_t>(mask.height), 0);
  for (const PlacedBitmap& g : glyphs)
    for (int y = 0; y < g.height; ++y)
      for (int x = 0; x < g.width; ++x) {
        auto& to = mask.coverage[static_cast<std::size_t>(y + g.top - top) * static_cast<std::size_t>(mask.width) +
                                 static_cast<std::size_t>(x + g.left - left)];
        to = std::max(to, g.coverage[static_cast<std::size_t>(y * g.width + x)]);
      }
  return mask;
}

}  // namespace glisson::render
