// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "render/painter.h"

namespace glisson::render {

/// A colour ramp whose lightness grows with the value, so that order survives grey printing and colour blindness.
class ColourMap {
 public:
  /// Dark violet, blue, green, yellow: stiffness.
  static ColourMap viridis();
  /// Black, violet, orange, pale yellow: differences.
  static ColourMap magma();

  /// fraction is clamped to [0, 1].
  Rgb at(double fraction) const;

 private:
  explicit ColourMap(std::span<const Rgb> anchors) : anchors_(anchors) {}
  std::span<const Rgb> anchors_;  ///< evenly spaced, linear in sRGB between
};

/// End of a scale that holds a value: 1, 2, 3, 4, 6 or 8 times a power of ten; 1 where it is not above 0.
double scaleEnd(double most);

/// The project's colours, told apart by colour-blind readers too.
namespace colours {
inline constexpr Rgb mreBlue{86, 140, 255};  // text and lines on dark
inline constexpr Rgb atlasRed{255, 84, 84};
inline constexpr Rgb agreePurple{206, 92, 255};
inline constexpr Rgb gridGreen{60, 210, 110};
inline constexpr Rgb orange{230, 126, 0};   // the 5 mm line
inline constexpr Rgb magenta{200, 0, 160};  // the 1.64 mm line
inline constexpr Rgb paper{255, 255, 255};
inline constexpr Rgb ink{30, 34, 40};
inline constexpr Rgb night{12, 14, 18};
inline constexpr Rgb light{232, 236, 240};
inline constexpr Rgb faint{140, 148, 158};
inline constexpr Rgb warning{255, 176, 32};
}  // namespace colours

}  // namespace glisson::render
