// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/colour_map.h"

#include <QColor>
#include <algorithm>
#include <cmath>

namespace glisson::views {

namespace {

struct Stop {
  double at;
  int red, green, blue;
};

std::array<QRgb, 256> make() {
  constexpr std::array<Stop, 9> stops = {{{0.00, 38, 16, 92},
                                          {0.12, 45, 64, 190},
                                          {0.26, 36, 138, 232},
                                          {0.38, 40, 196, 190},
                                          {0.50, 104, 210, 92},
                                          {0.62, 208, 215, 60},
                                          {0.75, 247, 160, 44},
                                          {0.88, 226, 74, 30},
                                          {1.00, 130, 10, 24}}};
  std::array<QRgb, 256> colours{};
  for (std::size_t i = 0; i < colours.size(); ++i) {
    const double t = static_cast<double>(i) / 255.0;
    std::size_t s = 1;
    while (s + 1 < stops.size() && t > stops[s].at) ++s;
    const Stop &a = stops[s - 1], &b = stops[s];
    const double w = (t - a.at) / (b.at - a.at);
    const auto mix = [w](int x, int y) { return static_cast<int>(std::lround(x + w * (y - x))); };
    colours[i] = qRgb(mix(a.red, b.red), mix(a.green, b.green), mix(a.blue, b.blue));
  }
  return colours;
}

}  // namespace

const std::array<QRgb, 256>& stiffnessColours() {
  static const std::array<QRgb, 256> colours = make();
  return colours;
}

const std::array<QRgb, 256>& waveColours() {
  static const std::array<QRgb, 256> colours = [] {
    std::array<QRgb, 256> c{};
    for (int i = 0; i < 256; ++i) {
      const double t = (i - 127.5) / 127.5, away = std::abs(t);
      const auto fade = [&](int end) { return static_cast<int>(std::lround(26.0 + away * (end - 26.0))); };
      c[static_cast<std::size_t>(i)] =
          t < 0.0 ? qRgb(fade(90), fade(170), fade(255)) : qRgb(fade(255), fade(120), fade(70));
    }
    return c;
  }();
  return colours;
}

const std::array<QRgb, 256>& greyLevels() {
  static const std::array<QRgb, 256> levels = [] {
    std::array<QRgb, 256> g{};
    for (int i = 0; i < 256; ++i) g[static_cast<std::size_t>(i)] = qRgb(i, i, i);
    return g;
  }();
  return levels;
}

}  // namespace glisson::views
