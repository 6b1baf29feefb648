// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <sstream>

#include "render/painter.h"

namespace glisson::render {

/// The same drawing as SVG 1.1 text, for print.
class SvgPainter final : public Painter {
 public:
  SvgPainter(int width, int height);
  void line(const Point& a, const Point& b, const Stroke& stroke) override;
  void polygon(const std::vector<Point>& corners, Rgb fill, double alpha = 1.0) override;
  void disc(const Point& centre, double radius, Rgb fill, double alpha = 1.0) override;
  void text(const Point& baseline, const std::string& utf8, const TextStyle& style) override;

  std::string document() const;

 private:
  std::ostringstream out_;
};

}  // namespace glisson::render
