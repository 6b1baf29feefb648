// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "base/version.h"
#include "render/picture.h"

namespace glisson::render {

/// A colour, 0 to 255.
struct Rgb {
  std::uint8_t r = 0, g = 0, b = 0;
  bool operator==(const Rgb&) const = default;
};

/// Pixel position, x to the right, y down; the centre of the first pixel is (0.5, 0.5).
using Point = Eigen::Vector2d;

/// How a line is drawn; width in pixels, alpha from 0 (unseen) to 1.
struct Stroke {
  Rgb colour;
  double width = 1.0;
  bool dashed = false;
  double alpha = 1.0;
};

/// Which end of a line of text lies at its place.
enum class Anchor { Left, Centre, Right };

/// How a line of text is drawn.
struct TextStyle {
  double size_px = 16.0;
  Rgb colour;
  Anchor anchor = Anchor::Left;
  double angle_deg = 0.0;  ///< counter-clockwise about the anchor
  bool bold = false;
  double alpha = 1.0;
  double halo_px = 0.0;  ///< dark edge around letters that lie on an image
};

/// What charts draw on: pixels or SVG, the same calls.
class Painter {
 public:
  virtual ~Painter() = default;
  virtual void line(const Point& a, const Point& b, const Stroke& stroke) = 0;
  virtual void polygon(const std::vector<Point>& corners, Rgb fill, double alpha = 1.0) = 0;
  virtual void disc(const Point& centre, double radius, Rgb fill, double alpha = 1.0) = 0;
  /// baseline: where the anchored end of the baseline lies.
  virtual void text(const Point& baseline, const std::string& utf8, const TextStyle& style) = 0;

  void rectangle(double x0, double y0, double x1, double y1, Rgb fill, double alpha = 1.0);
  void frame(double x0, double y0, double x1, double y1, const Stroke& stroke);
  void polyline(const std::vector<Point>& points, const Stroke& stroke);
};

/// Anti-aliased drawing into a Picture on the CPU. Deterministic. Parts outside the picture are cut off.
class RasterPainter final : public Painter {
 public:
  explicit RasterPainter(Picture& target) : picture_(target) {}
  void line(const Point& a, const Point& b, const Stroke& stroke) override;
  void polygon(const std::vector<Point>& corners, Rgb fill, double alpha = 1.0) override;
  void disc(const Point& centre, double radius, Rgb fill, double alpha = 1.0) override;
  void text(const Point& baseline, const std::string& utf8, const TextStyle& style) override;

  void blend(int x, int y, Rgb colour, double alpha);

 private:
  void segment(const Point& a, const Point& b, const Stroke& stroke);
  Picture& picture_;
};

/// A picture of one colour.
Picture blankPicture(int width, int height, Rgb fill);

/// Copies source into target with its first pixel at (x, y).
void paste(Picture& target, const Picture& source, int x, int y);

/// Breaks text into lines no wider than width_px.
std::vector<std::string> wrapText(const std::string& utf8, double size_px, double width_px);

using glisson::researchUseOnly;

}  // namespace glisson::render
