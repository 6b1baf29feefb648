// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/language.h"
#include "render/painter.h"

namespace glisson::render {

/// Charts for reports, studies and the workstation: one description, drawn to pixels or SVG, without OpenGL. Values
/// that are not finite are left out and counted in a note. All throw BadArgument where nothing can be drawn (no finite
/// value, a logarithmic axis without positive values, series of unequal lengths).

/// A constant drawn across a chart, with its label: the 1.64 mm voxel (magenta), the significant 5 mm (orange), the
/// atlas.
struct ReferenceLine {
  double value = 0.0;
  std::string label{};
  Rgb colour{230, 126, 0};
};

/// Title and range of an axis.
struct Axis {
  std::string title{};  ///< with its unit, e.g. "Run time (ms)"
  bool logarithmic = false;
  std::optional<double> low{};  ///< from the data where unset
  std::optional<double> high{};
  Language language = Language::English;  ///< of the numbers
};

/// How many values fall into each bin.
struct Histogram {
  std::string title{};
  Axis x{}, y{.title = "Number of cases"};
  std::vector<double> values{};
  double binWidth = 0.5;               ///< in the unit of x; bins begin at multiples of it
  std::vector<ReferenceLine> lines{};  ///< vertical
  std::string caption{};
};

/// Boxes side by side, one per group of values.
struct BoxPlot {
  /// A group of values.
  struct Box {
    std::string label{};
    std::vector<double> values{};
  };
  std::string title{};
  Axis y{};
  std::vector<Box> boxes{};  ///< quartiles (linear between order statistics), whiskers to 1.5 IQR, outliers as dots
  std::vector<ReferenceLine> lines{};  ///< horizontal
  std::string caption{};
};

/// Lines through points, points alone, or both.
struct XyChart {
  /// A row of points with its place in the legend.
  struct Series {
    std::string name{};
    std::vector<double> x{}, y{};
    bool joined = true;
    bool markers = true;
    bool dashed = false;
    std::optional<Rgb> colour{};  ///< else the next of those that are told apart
  };
  std::string title{};
  Axis x{}, y{};
  std::vector<Series> series{};
  std::vector<ReferenceLine> lines{};  ///< horizontal
  bool paretoFront = false;  ///< marks the points that no other point beats in both x and y (smaller is better)
  std::string caption{};
};

/// How far each of several causes moves one number: bars from low to high about it, as they come.
struct Tornado {
  /// What one cause does.
  struct Bar {
    std::string label{};  ///< left of the axis
    double low = 0.0, high = 0.0;
    std::string note{};  ///< right of the bar
    bool sum = false;    ///< all causes together: apart from the others, in another colour
  };
  std::string title{};
  Axis x{};
  double here = 0.0;  ///< the number, a line through all bars
  std::vector<Bar> bars{};
  std::vector<ReferenceLine> lines{};  ///< vertical
  std::string caption{};
};

/// Size of a chart, pixels.
struct ChartSize {
  int width = 1600;
  int height = 1100;
};

/// Onto whatever draws: a PDF page, for instance; in pixels, from (0, 0) to (width, height).
void paint(Painter& painter, const Histogram& chart, const ChartSize& size = {});
void paint(Painter& painter, const BoxPlot& chart, const ChartSize& size = {});
void paint(Painter& painter, const XyChart& chart, const ChartSize& size = {});
void paint(Painter& painter, const Tornado& chart, const ChartSize& size = {});
Picture draw(const Histogram& chart, const ChartSize& size = {});
Picture draw(const BoxPlot& chart, const ChartSize& size = {});
Picture draw(const XyChart& chart, const ChartSize& size = {});
Picture draw(const Tornado& chart, const ChartSize& size = {});
std::string svg(const Histogram& chart, const ChartSize& size = {});
std::string svg(const BoxPlot& chart, const ChartSize& size = {});
std::string svg(const XyChart& chart, const ChartSize& size = {});
std::string svg(const Tornado& chart, const ChartSize& size = {});

/// The column of a histogram, drawn at that size, that a pixel lies in: from its lower end up to its upper one. Nothing
/// outside of the plot area, and where a column is empty.
struct Column {
  double low = 0.0, high = 0.0;
};
std::optional<Column> columnAt(const Histogram& chart, const Point& pixel, const ChartSize& size = {});

/// The box of a plot, drawn at that size, above or below which a pixel lies, and the value at its height. Nothing
/// outside of the plot area.
struct PlaceInBoxes {
  std::size_t box = 0;
  double value = 0.0;
};
std::optional<PlaceInBoxes> placeAt(const BoxPlot& chart, const Point& pixel, const ChartSize& size = {});

/// Indices of the points that no other beats in both x and y, by growing x; equal points are all kept.
std::vector<std::size_t> paretoFront(const std::vector<double>& x, const std::vector<double>& y);

/// Quartiles and whiskers of a box; values need not be sorted.
struct BoxNumbers {
  double lowWhisker = 0.0, lowerQuartile = 0.0, median = 0.0, upperQuartile = 0.0, highWhisker = 0.0;
  std::vector<double> outliers{};
};
BoxNumbers boxNumbers(std::vector<double> values);

/// Number of values in each bin [n binWidth, (n + 1) binWidth), from the bin of the smallest to that of the largest.
struct Bins {
  double start = 0.0;
  std::vector<std::size_t> counts{};
};
Bins binned(const std::vector<double>& values, double binWidth);

}  // namespace glisson::render
