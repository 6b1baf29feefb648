// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/charts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/error.h"
#include "render/chart_frame.h"
#include "render/colour_map.h"
#include "render/detail/tornado.h"
#include "render/detail/xy_chart.h"
#include "render/font.h"
#include "render/svg_painter.h"

namespace glisson::render {
namespace {

using namespace colours;

constexpr Rgb barFill{86, 150, 205};

std::vector<double> finite(const std::vector<double>& values) {
  std::vector<double> kept;
  std::copy_if(values.begin(), values.end(), std::back_inserter(kept), [](double v) { return std::isfinite(v); });
  return kept;
}

std::string withLeftOut(const std::string& caption, std::size_t leftOut) {
  if (leftOut == 0) return caption;
  return caption + (caption.empty() ? "" : " ") + std::to_string(leftOut) + " value(s) not finite, left out.";
}

/// For asking where things are, without drawing.
class NoPainter final : public Painter {
 public:
  void line(const Point&, const Point&, const Stroke&) override {}
  void polygon(const std::vector<Point>&, Rgb, double) override {}
  void disc(const Point&, double, Rgb, double) override {}
  void text(const Point&, const std::string&, const TextStyle&) override {}
};

struct HistogramLayout {
  std::size_t count = 0;  ///< of values that are finite
  Bins bins;
  ChartFrame frame;
  Scale x, y;
};

HistogramLayout layOut(Painter& paint, const Histogram& chart, const ChartSize& size) {
  const std::vector<double> values = finite(chart.values);
  const Bins bins = binned(values, chart.binWidth);
  const double most = static_cast<double>(*std::max_element(bins.counts.begin(), bins.counts.end()));
  double low = bins.start, high = bins.start + chart.binWidth * static_cast<double>(bins.counts.size());
  for (const ReferenceLine& line : chart.lines) {
    low = std::min(low, line.value);
    high = std::max(high, line.value);
  }
  const ChartFrame frame =
      beginChart(paint, size, chart.title, withLeftOut(chart.caption, chart.values.size() - values.size()), false);
  HistogramLayout made{values.size(), bins, frame, Scale(chart.x, low, high), Scale(chart.y, 0.0, 1.08 * most)};
  made.x.setPixels(frame.x0, frame.x1);
  made.y.setPixels(frame.y1, frame.y0);
  return made;
}

void paintChart(Painter& paint, const Histogram& chart, const ChartSize& size) {
  const auto& [count, bins, frame, x, y] = layOut(paint, chart, size);
  drawAxisY(paint, frame, y, chart.y.title);
  for (std::size_t n = 0; n < bins.counts.size(); ++n) {
    if (bins.counts[n] == 0) continue;
    const double a = x(bins.start + chart.binWidth * static_cast<double>(n));
    const double b = x(bins.start + chart.binWidth * static_cast<double>(n + 1));
    const double top = y(static_cast<double>(bins.counts[n]));
    paint.rectangle(a, top, b, frame.y1, barFill);
    paint.frame(a, top, b, frame.y1, {.colour = paper, .width = frame.font / 10.0});
  }
  drawAxisX(paint, frame, x, chart.x.title, false);
  drawVertical(paint, frame, x, chart.lines);
  paint.text({frame.x1, frame.y0 - 0.5 * frame.font}, "n = " + std::to_string(count),
             {.size_px = frame.font, .colour = ink, .anchor = Anchor::Right});
}

struct BoxLayout {
  std::vector<std::vector<double>> groups;  ///< finite values
  ChartFrame frame;
  Scale y;
  double slot = 0.0;  ///< width of the place of a box
};

BoxLayout layOut(Painter& paint, const BoxPlot& chart, const ChartSize& size) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  std::size_t leftOut = 0;
  std::vector<std::vector<double>> groups;
  for (const BoxPlot::Box& box : chart.boxes) {
    groups.push_back(finite(box.values));
    leftOut += box.values.size() - groups.back().size();
    for (const double v : groups.back()) {
      low = std::min(low, v);
      high = std::max(high, v);
    }
  }
  if (!(low <= high)) throw BadArgument("the box plot '" + chart.title + "' has no finite value");
  for (const ReferenceLine& line : chart.lines) {
    low = std::min(low, line.value);
    high = std::max(high, line.value);
  }
  if (!chart.y.logarithmic && low > 0.0 && low < 0.4 * high) low = 0.0;
  const ChartFrame frame = beginChart(paint, size, chart.title, withLeftOut(chart.caption, leftOut), false);
  Scale y(chart.y, low, high);
  y.setPixels(frame.y1, frame.y0);
  double gutter = 0.0;  // the labels of the lines stand beside the boxes, never under them
  for (const ReferenceLine& line : chart.lines)
    gutter = std::max(gutter, textWidth(line.label, 0.9 * frame.font, true) + 0.5 * frame.font);
  gutter = std::min(gutter, 0.4 * (frame.x1 - frame.x0));
  const double slot = (frame.x1 - gutter - frame.x0) / static_cast<double>(groups.size());
  return {std::move(groups), frame, std::move(y), slot};
}

void paintChart(Painter& paint, const BoxPlot& chart, const ChartSize& size) {
  const auto& [groups, frame, y, slot] = layOut(paint, chart, size);
  drawAxisY(paint, frame, y, chart.y.title);
  const double f = frame.font;
  const double half = std::min(0.28 * slot, 4.5 * f);
  const Stroke pen{.colour = ink, .width = f / 9.0};
  std::vector<Stretch> taken;
  for (std::size_t n = 0; n < groups.size(); ++n) {
    const double x = frame.x0 + (static_cast<double>(n) + 0.5) * slot;
    paint.text({x, frame.y1 + 1.5 * f}, chart.boxes[n].label, {.size_px = f, .colour = ink, .anchor = Anchor::Centre});
    paint.text({x, frame.y1 + 2.8 * f}, "n = " + std::to_string(groups[n].size()),
               {.size_px = 0.85 * f, .colour = {90, 96, 104}, .anchor = Anchor::Centre});
    if (groups[n].empty()) continue;
    const BoxNumbers box = boxNumbers(groups[n]);
    paint.line({x, y(box.lowWhisker)}, {x, y(box.lowerQuartile)}, pen);
    paint.line({x, y(box.upperQuartile)}, {x, y(box.highWhisker)}, pen);
    for (const double v : {box.lowWhisker, box.highWhisker})
      paint.line({x - 0.5 * half, y(v)}, {x + 0.5 * half, y(v)}, pen);
    paint.rectangle(x - half, y(box.upperQuartile), x + half, y(box.lowerQuartile), barFill, 0.85);
    paint.frame(x - half, y(box.upperQuartile), x + half, y(box.lowerQuartile), pen);
    paint.line({x - half, y(box.median)}, {x + half, y(box.median)}, {.colour = ink, .width = f / 5.0});
    for (const double v : box.outliers) paint.disc({x, y(v)}, f / 4.0, ink, 0.8);
    const auto [least, most] = std::minmax_element(groups[n].begin(), groups[n].end());
    for (const double side : {-half, 0.0, half}) taken.push_back({{x + side, y(*least)}, {x + side, y(*most)}});
  }
  drawHorizontal(paint, frame, y, chart.lines);
  labelHorizontal(paint, frame, y, chart.lines, std::move(taken));
  paint.line({frame.x0, frame.y1}, {frame.x1, frame.y1}, {.colour = ink, .width = f / 12.0});
}

void paintChart(Painter& paint, const XyChart& chart, const ChartSize& size) {
  detail::paintXyChart(paint, chart, size);
}

void paintChart(Painter& paint, const Tornado& chart, const ChartSize& size) {
  detail::paintTornado(paint, chart, size);
}

template <typename Chart>
Picture drawn(const Chart& chart, const ChartSize& size) {
  Picture picture = blankPicture(std::max(1, size.width), std::max(1, size.height), paper);
  RasterPainter paint(picture);
  paintChart(paint, chart, size);
  return picture;
}

template <typename Chart>
std::string written(const Chart& chart, const ChartSize& size) {
  SvgPainter paint(size.width, size.height);
  paintChart(paint, chart, size);
  return paint.document();
}

}  // namespace

void paint(Painter& painter, const Histogram& chart, const ChartSize& size) {
  paintChart(painter, chart, size);
}
void paint(Painter& painter, const BoxPlot& chart, const ChartSize& size) {
  paintChart(painter, chart, size);
}
void paint(Painter& painter, const XyChart& chart, const ChartSize& size) {
  paintChart(painter, chart, size);
}
void paint(Painter& painter, const Tornado& chart, const ChartSize& size) {
  paintChart(painter, chart, size);
}
Picture draw(const Histogram& chart, const ChartSize& size) {
  return drawn(chart, size);
}
Picture draw(const BoxPlot& chart, const ChartSize& size) {
  return drawn(chart, size);
}
Picture draw(const XyChart& chart, const ChartSize& size) {
  return drawn(chart, size);
}
Picture draw(const Tornado& chart, const ChartSize& size) {
  return drawn(chart, size);
}
std::string svg(const Histogram& chart, const ChartSize& size) {
  return written(chart, size);
}
std::string svg(const BoxPlot& chart, const ChartSize& size) {
  return written(chart, size);
}
std::string svg(const XyChart& chart, const ChartSize& size) {
  return written(chart, size);
}
std::string svg(const Tornado& chart, const ChartSize& size) {
  return written(chart, size);
}

std::optional<Column> columnAt(const Histogram& chart, const Point& pixel, const ChartSize& size) {
  NoPainter nothing;
  const HistogramLayout at = layOut(nothing, chart, size);
  if (pixel.x() < at.frame.x0 || pixel.x() > at.frame.x1 || pixel.y() < at.frame.y0 || pixel.y() > at.frame.y1)
    return {};
  const double n = std::floor((at.x.valueAt(pixel.x()) - at.bins.start) / chart.binWidth);
  if (n < 0.0 || n >= static_cast<double>(at.bins.counts.size()) || at.bins.counts[static_cast<std::size_t>(n)] == 0)
    return {};
  return Column{at.bins.start + n * chart.binWidth, at.bins.start + (n + 1.0) * chart.binWidth};
}

std::optional<PlaceInBoxes> placeAt(const BoxPlot& chart, const Point& pixel, const ChartSize& size) {
  NoPainter nothing;
  const BoxLayout at = layOut(nothing, chart, size);
  if (pixel.x() < at.frame.x0 || pixel.x() > at.frame.x1 || pixel.y() < at.frame.y0 || pixel.y() > at.frame.y1)
    return {};
  const double box = std::floor((pixel.x() - at.frame.x0) / at.slot);
  if (box >= static_cast<double>(at.groups.size())) return {};
  return PlaceInBoxes{static_cast<std::size_t>(box), at.y.valueAt(pixel.y())};
}

std::vector<std::size_t> paretoFront(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<std::size_t> order(x.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return x[a] != x[b] ? x[a] < x[b] : y[a] != y[b] ? y[a] < y[b] : a < b;
  });
  std::vector<std::size_t> front;
  for (const std::size_t n : order) {
    const bool equal = !front.empty() && x[n] == x[front.back()] && y[n] == y[front.back()];
    if (front.empty() || equal || y[n] < y[front.back()]) front.push_back(n);
  }
  return front;
}

BoxNumbers boxNumbers(std::vector<double> values) {
  if (values.empty()) throw BadArgument("a box needs at least one value");
  std::sort(values.begin(), values.end());
  const auto quantile = [&](double p) {
    const double at = p * static_cast<double>(values.size() - 1);
    const auto n = std::min(static_cast<std::size_t>(at), values.size() - 1);
    const auto next = std::min(n + 1, values.size() - 1);
    return values[n] + (at - static_cast<double>(n)) * (values[next] - values[n]);
  };
  BoxNumbers box{0.0, quantile(0.25), quantile(0.5), quantile(0.75), 0.0, {}};
  const double reach = 1.5 * (box.upperQuartile - box.lowerQuartile);
  box.lowWhisker = box.lowerQuartile;
  box.highWhisker = box.upperQuartile;
  for (const double v : values) {
    if (v < box.lowerQuartile - reach || v > box.upperQuartile + reach) {
      box.outliers.push_back(v);
    } else {
      box.lowWhisker = std::min(box.lowWhisker, v);
      box.highWhisker = std::max(box.highWhisker, v);
    }
  }
  return box;
}

Bins binned(const std::vector<double>& values, double binWidth) {
  if (values.empty()) throw BadArgument("a histogram needs at least one finite value");
  if (!(binWidth > 0.0)) throw BadArgument("the bin width must be above zero");
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double first = std::floor(*low / binWidth), last = std::floor(*high / binWidth);
  if (last - first > 1e5) throw BadArgument("the bin width is too small for the range of the values");
  Bins bins{first * binWidth, std::vector<std::size_t>(static_cast<std::size_t>(last - first) + 1, 0)};
  for (const double v : values) ++bins.counts[static_cast<std::size_t>(std::floor(v / binWidth) - first)];
  return bins;
}

}  // namespace glisson::render
