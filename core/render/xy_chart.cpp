// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/detail/xy_chart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "render/chart_frame.h"
#include "render/colour_map.h"
#include "render/font.h"

namespace glisson::render::detail {
namespace {

using namespace colours;

/// Told apart by colour-blind readers (Okabe and Ito), black first.
constexpr std::array<Rgb, 7> seriesColours{
    {{0, 114, 178}, {213, 94, 0}, {0, 158, 115}, {204, 121, 167}, {86, 180, 233}, {120, 94, 10}, {30, 34, 40}}};
constexpr Rgb frontFill{255, 205, 70};

bool usable(const XyChart& chart, double x, double y) {
  return std::isfinite(x) && std::isfinite(y) && (!chart.x.logarithmic || x > 0.0) && (!chart.y.logarithmic || y > 0.0);
}

/// The points of all series that can be drawn, and what the axes must hold.
struct Extent {
  std::vector<double> x, y;
  double lowX = std::numeric_limits<double>::infinity(), highX = -lowX, lowY = lowX, highY = -lowX;
  std::size_t leftOut = 0;
};

Extent extentOf(const XyChart& chart) {
  Extent e;
  for (const XyChart::Series& s : chart.series) {
    if (s.x.size() != s.y.size())
      throw BadArgument("the series '" + s.name + "' has " + std::to_string(s.x.size()) + " x and " +
                        std::to_string(s.y.size()) + " y values");
    for (std::size_t n = 0; n < s.x.size(); ++n) {
      if (!usable(chart, s.x[n], s.y[n])) {
        ++e.leftOut;
        continue;
      }
      e.x.push_back(s.x[n]);
      e.y.push_back(s.y[n]);
      e.lowX = std::min(e.lowX, s.x[n]);
      e.highX = std::max(e.highX, s.x[n]);
      e.lowY = std::min(e.lowY, s.y[n]);
      e.highY = std::max(e.highY, s.y[n]);
    }
  }
  if (e.x.empty()) throw BadArgument("the chart '" + chart.title + "' has no point that can be drawn on its axes");
  for (const ReferenceLine& line : chart.lines) {
    if (chart.y.logarithmic && !(line.value > 0.0)) continue;
    e.lowY = std::min(e.lowY, line.value);
    e.highY = std::max(e.highY, line.value);
  }
  return e;
}

std::string captionOf(const XyChart& chart, std::size_t leftOut) {
  if (leftOut == 0) return chart.caption;
  return chart.caption + (chart.caption.empty() ? "" : " ") + std::to_string(leftOut) +
         " point(s) cannot be shown on these axes.";
}

/// Where each entry of the legend goes: in rows as wide as the chart.
struct Legend {
  std::vector<Point> place;  ///< offset from the first entry: the Pareto front's, where there is one, then the series'
  double height = 0.0;       ///< from the first row to the last
  int rows = 1;
};

Legend legendOf(const XyChart& chart, double font, double width) {
  std::vector<std::string> entries;
  if (chart.paretoFront) entries.emplace_back("Pareto front");
  for (const XyChart::Series& series : chart.series) entries.push_back(series.name);
  Legend legend;
  Point next(0.0, 0.0);
  for (const std::string& entry : entries) {
    const double entryWidth = 3.4 * font + textWidth(entry, font);
    if (next.x() > 0.0 && next.x() + entryWidth > width - 6.0 * font) next = {0.0, next.y() + 1.5 * font};
    legend.place.push_back(next);
    next.x() += entryWidth;
  }
  legend.height = next.y();
  legend.rows = 1 + static_cast<int>(std::lround(next.y() / (1.5 * font)));
  return legend;
}

/// Shape beside colour: readers who do not see the one see the other.
void drawMarker(Painter& paint, std::size_t series, const Point& p, double r, Rgb colour) {
  const double x = p.x(), y = p.y();
  switch (series % 4) {
    case 0: paint.disc(p, r, colour); break;
    case 1: paint.rectangle(x - 0.9 * r, y - 0.9 * r, x + 0.9 * r, y + 0.9 * r, colour); break;
    case 2: paint.polygon({{x, y - 1.2 * r}, {x + 1.1 * r, y + 0.8 * r}, {x - 1.1 * r, y + 0.8 * r}}, colour); break;
    default: paint.polygon({{x, y - 1.3 * r}, {x + 1.3 * r, y}, {x, y + 1.3 * r}, {x - 1.3 * r, y}}, colour); break;
  }
}

/// The plot area of one chart while it is filled.
class Plot {
 public:
  Plot(Painter& paint, const XyChart& chart, const ChartFrame& frame, const Scale& x, const Scale& y,
       const Legend& legend)
      : paint_(paint),
        chart_(chart),
        x_(x),
        y_(y),
        legend_(legend),
        font_(frame.font),
        firstEntry_(frame.x0, frame.y0 - 0.8 * frame.font - legend.height) {}

  void front(const std::vector<double>& allX, const std::vector<double>& allY);
  void series(std::size_t s);
  /// What is drawn, for labels that keep clear of it.
  std::vector<Stretch> takeDrawn() { return std::move(taken_); }

 private:
  Painter& paint_;
  const XyChart& chart_;
  const Scale &x_, &y_;
  const Legend& legend_;
  double font_;
  Point firstEntry_;
  std::vector<Stretch> taken_;
};

void Plot::front(const std::vector<double>& allX, const std::vector<double>& allY) {
  const std::vector<std::size_t> front = paretoFront(allX, allY);
  std::vector<Point> steps;
  for (const std::size_t n : front) {
    if (!steps.empty()) steps.emplace_back(x_(allX[n]), steps.back().y());
    steps.emplace_back(x_(allX[n]), y_(allY[n]));
  }
  const Stroke stair{.colour = {120, 126, 134}, .width = font_ / 8.0, .dashed = true};
  paint_.polyline(steps, stair);
  for (std::size_t n = 1; n < steps.size(); ++n) taken_.emplace_back(steps[n - 1], steps[n]);
  for (const std::size_t n : front) paint_.disc({x_(allX[n]), y_(allY[n])}, 0.62 * font_, frontFill);
  paint_.disc(firstEntry_ + Point(0.6 * font_, -0.35 * font_), 0.55 * font_, frontFill);
  paint_.text(firstEntry_ + Point(1.5 * font_, 0.0), "Pareto front", {.size_px = font_, .colour = ink});
}

void Plot::series(std::size_t s) {
  const XyChart::Series& series = chart_.series[s];
  const Rgb colour = series.colour.value_or(seriesColours[s % seriesColours.size()]);
  const auto marker = [&](const Point& p) { drawMarker(paint_, s, p, 0.38 * font_, colour); };
  const Stroke pen{.colour = colour, .width = font_ / 7.0, .dashed = series.dashed};
  std::vector<Point> points;
  for (std::size_t n = 0; n < series.x.size(); ++n)
    if (usable(chart_, series.x[n], series.y[n])) points.emplace_back(x_(series.x[n]), y_(series.y[n]));
  if (series.joined) paint_.polyline(points, pen);
  if (series.markers) std::for_each(points.begin(), points.end(), marker);
  for (std::size_t n = 0; n < points.size(); ++n) {
    if (series.markers || !series.joined) taken_.emplace_back(points[n], points[n]);
    if (series.joined && n > 0) taken_.emplace_back(points[n - 1], points[n]);
  }
  const Point entry = firstEntry_ + legend_.place[s + (chart_.paretoFront ? 1 : 0)];
  if (series.joined) paint_.line(entry + Point(0.0, -0.35 * font_), entry + Point(1.6 * font_, -0.35 * font_), pen);
  if (series.markers) marker(entry + Point(0.8 * font_, -0.35 * font_));
  paint_.text(entry + Point(2.0 * font_, 0.0), series.name, {.size_px = font_, .colour = ink});
}

}  // namespace

void paintXyChart(Painter& paint, const XyChart& chart, const ChartSize& size) {
  const Extent extent = extentOf(chart);
  const Legend legend = legendOf(chart, chartFont(size), size.width);
  const ChartFrame frame = beginChart(paint, size, chart.title, captionOf(chart, extent.leftOut), legend.rows);
  Scale x(chart.x, extent.lowX, extent.highX), y(chart.y, extent.lowY, extent.highY);
  x.setPixels(frame.x0, frame.x1);
  y.setPixels(frame.y1, frame.y0);
  drawAxisY(paint, frame, y, chart.y.title);
  drawAxisX(paint, frame, x, chart.x.title, true);
  drawHorizontal(paint, frame, y, chart.lines);
  Plot plot(paint, chart, frame, x, y, legend);
  if (chart.paretoFront) plot.front(extent.x, extent.y);
  for (std::size_t s = 0; s < chart.series.size(); ++s) plot.series(s);
  labelHorizontal(paint, frame, y, chart.lines, plot.takeDrawn());
}

}  // namespace glisson::render::detail
