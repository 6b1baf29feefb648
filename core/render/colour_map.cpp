// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/colour_map.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace glisson::render {
namespace {

constexpr std::array<Rgb, 10> viridisAnchors{{{68, 1, 84},
                                              {72, 40, 120},
                                              {62, 73, 137},
                                              {49, 104, 142},
                                              {38, 130, 142},
                                              {31, 158, 137},
                                              {53, 183, 121},
                                              {110, 206, 88},
                                              {181, 222, 43},
                                              {253, 231, 37}}};
constexpr std::array<Rgb, 10> magmaAnchors{{{0, 0, 4},
                                            {24, 15, 61},
                                            {68, 15, 118},
                                            {114, 31, 129},
                                            {158, 47, 127},
                                            {205, 64, 113},
                                            {241, 96, 93},
                                            {253, 150, 104},
                                            {254, 202, 141},
                                            {252, 253, 191}}};

}  // namespace

ColourMap ColourMap::viridis() {
  return ColourMap(viridisAnchors);
}
ColourMap ColourMap::magma() {
  return ColourMap(magmaAnchors);
}

Rgb ColourMap::at(double fraction) const {
  const double last = static_cast<double>(anchors_.size() - 1);
  const double s = std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) * last : 0.0;
  const auto n = std::min(static_cast<std::size_t>(s), anchors_.size() - 2);
  const double t = s - static_cast<double>(n);
  const auto mix = [t](std::uint8_t a, std::uint8_t b) {
    return static_cast<std::uint8_t>(std::lround((1.0 - t) * a + t * b));
  };
  const Rgb a = anchors_[n], b = anchors_[n + 1];
  return {mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b)};
}

double scaleEnd(double most) {
  if (!(most > 0.0) || !std::isfinite(most)) return 1.0;
  const double ten = std::pow(10.0, std::floor(std::log10(most)));
  for (const double step : {1.0, 2.0, 3.0, 4.0, 6.0, 8.0})
    if (most <= step * ten) return step * ten;
  return 10.0 * ten;
}

}  // namespace glisson::render
