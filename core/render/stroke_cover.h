// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>

#include "render/painter.h"

namespace glisson::render {

/// Calls visit(x, y, coverage 0..1) for every pixel of a width × height image that an anti-aliased line touches. Lines
/// thinner than a pixel keep a pixel's breadth and grow fainter.
template <typename Visit>
void coverStroke(const Point& a, const Point& b, double lineWidth, int width, int height, Visit&& visit) {
  const double half = 0.5 * lineWidth;
  const double reach = half + 1.0;
  const Point d = b - a;
  const double length2 = d.squaredNorm();
  const auto pixel = [](double v, int limit) { return static_cast<int>(std::clamp(v, -1.0, limit + 1.0)); };
  const int y0 = std::max(0, pixel(std::floor(std::min(a.y(), b.y()) - reach), height));
  const int y1 = std::min(height - 1, pixel(std::ceil(std::max(a.y(), b.y()) + reach), height));
  for (int y = y0; y <= y1; ++y) {
    // Only the part of the row near the line: keeps long slanted lines cheap.
    double low = std::min(a.x(), b.x()), high = std::max(a.x(), b.x());
    if (std::abs(d.y()) > 1e-9) {
      const double margin = reach * std::sqrt(length2) / std::abs(d.y());
      const double x = a.x() + d.x() * (y + 0.5 - a.y()) / d.y();
      low = std::max(low, x - margin);
      high = std::min(high, x + margin);
    }
    const int x0 = std::max(0, pixel(std::floor(low - reach), width));
    const int x1 = std::min(width - 1, pixel(std::ceil(high + reach), width));
    for (int x = x0; x <= x1; ++x) {
      const Point p(x + 0.5, y + 0.5);
      const double t = length2 > 0.0 ? std::clamp((p - a).dot(d) / length2, 0.0, 1.0) : 0.0;
      const double distance = (p - a - t * d).norm();
      const double coverage = std::min(1.0, lineWidth) * std::clamp(std::max(half, 0.5) + 0.5 - distance, 0.0, 1.0);
      if (coverage > 0.0) visit(x, y, coverage);
    }
  }
}

}  // namespace glisson::render
