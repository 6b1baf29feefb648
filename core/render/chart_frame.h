// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "render/charts.h"

namespace glisson::render {

/// Maps values of one axis to pixels and names its ticks.
class Scale {
 public:
  /// low, high: range of the data; fixed ends of the axis win. Throws BadArgument where a logarithmic axis has none
  /// above 0.
  Scale(const Axis& axis, double low, double high);
  void setPixels(double atLow, double atHigh);

  double operator()(double value) const;
  double valueAt(double pixel) const;  ///< beyond the ends of the axis too
  /// A mark of the scale.
  struct Tick {
    double value;
    std::string text;  ///< empty for a minor tick
  };
  const std::vector<Tick>& ticks() const { return ticks_; }

 private:
  double along(double value) const;
  bool logarithmic_;
  double low_, high_, from_ = 0.0, to_ = 1.0;
  std::vector<Tick> ticks_;
};

/// Size of the letters (px) of a chart of that size.
double chartFont(const ChartSize& size);

/// White page with plot area, axes, titles, caption, legend and the research-use line.
struct ChartFrame {
  double font = 0.0, x0 = 0.0, y0 = 0.0, x1 = 0.0, y1 = 0.0;  ///< plot area, pixels, y0 at the top
};
ChartFrame beginChart(Painter& paint, const ChartSize& size, const std::string& title, const std::string& caption,
                      int legendRows, Language language = Language::English);
void drawAxisX(Painter& paint, const ChartFrame& frame, const Scale& scale, const std::string& title, bool grid);
void drawAxisY(Painter& paint, const ChartFrame& frame, const Scale& scale, const std::string& title);
void drawHorizontal(Painter& paint, const ChartFrame& frame, const Scale& y, const std::vector<ReferenceLine>& lines);

/// The labels of horizontal lines, each where it covers none of what is drawn (pixels; a point is a stretch of no
/// length), at the right end where that is free. To be called after the rest, in the order of the lines.
using Stretch = std::pair<Point, Point>;
void labelHorizontal(Painter& paint, const ChartFrame& frame, const Scale& y, const std::vector<ReferenceLine>& lines,
                     std::vector<Stretch> drawn);
void drawVertical(Painter& paint, const ChartFrame& frame, const Scale& x, const std::vector<ReferenceLine>& lines);

/// A number as short as it can be said: 0.0164, 1.5, 200, 3×10⁶.
std::string shortNumber(double v);

}  // namespace glisson::render
