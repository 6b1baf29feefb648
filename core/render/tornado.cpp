// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/detail/tornado.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "render/chart_frame.h"
#include "render/colour_map.h"
#include "render/font.h"

namespace glisson::render::detail {
namespace {

using namespace colours;

constexpr Rgb cause{86, 150, 205}, together{90, 98, 110};

void check(const Tornado& chart) {
  if (chart.bars.empty()) throw BadArgument("the chart '" + chart.title + "' has no bar");
  for (const Tornado::Bar& bar : chart.bars)
    if (!std::isfinite(bar.low) || !std::isfinite(bar.high) || bar.low > bar.high)
      throw BadArgument("the bar '" + bar.label + "' of the chart '" + chart.title + "' does not run from low to high");
  if (!std::isfinite(chart.here)) throw BadArgument("the chart '" + chart.title + "' has no finite value");
}

/// Widest text of all bars, pixels.
double widest(const Tornado& chart, std::string Tornado::Bar::*text, double size_px) {
  double width = 0.0;
  for (const Tornado::Bar& bar : chart.bars) width = std::max(width, textWidth(bar.*text, size_px, true));
  return width;
}

Scale scaleOf(const Tornado& chart) {
  double low = chart.here, high = chart.here;
  for (const Tornado::Bar& bar : chart.bars) {
    low = std::min(low, bar.low);
    high = std::max(high, bar.high);
  }
  for (const ReferenceLine& line : chart.lines) {
    low = std::min(low, line.value);
    high = std::max(high, line.value);
  }
  return Scale(chart.x, low, high);
}

}  // namespace

void paintTornado(Painter& paint, const Tornado& chart, const ChartSize& size) {
  check(chart);
  ChartFrame frame = beginChart(paint, size, chart.title, chart.caption, chart.lines.empty() ? 0 : 1, chart.x.language);
  const double f = frame.font;
  // Labels and notes have the sides to themselves, and at most seven tenths of the width.
  const double room = frame.x1 - frame.x0, labels = widest(chart, &Tornado::Bar::label, f) - 3.6 * f,
               notes = widest(chart, &Tornado::Bar::note, 0.9 * f) + 0.8 * f;
  frame.x0 += std::clamp(labels, 0.0, 0.4 * room);
  frame.x1 -= std::min(notes, 0.3 * room);
  Scale x = scaleOf(chart);
  x.setPixels(frame.x0, frame.x1);
  drawAxisX(paint, frame, x, chart.x.title, true);
  const bool apart = std::any_of(chart.bars.begin(), chart.bars.end(), [](const auto& bar) { return bar.sum; });
  const double slot = (frame.y1 - frame.y0) / (static_cast<double>(chart.bars.size()) + (apart ? 0.5 : 0.0));
  const double half = std::min(0.36 * slot, 1.1 * f);
  double y = frame.y0 + 0.5 * slot;
  for (const Tornado::Bar& bar : chart.bars) {
    if (bar.sum) {
      paint.line({frame.x0, y - 0.25 * slot}, {frame.x1, y - 0.25 * slot},
                 {.colour = {222, 226, 230}, .width = f / 12});
      y += 0.5 * slot;
    }
    // What does nothing still has its place.
    const double least = 0.06 * f, a = std::min(x(bar.low), x(chart.here) - least),
                 b = std::max(x(bar.high), x(chart.here) + least);
    paint.rectangle(a, y - half, b, y + half, bar.sum ? together : cause);
    paint.text({frame.x0 - 0.6 * f, y + 0.36 * f}, bar.label,
               {.size_px = f, .colour = ink, .anchor = Anchor::Right, .bold = bar.sum});
    paint.text({frame.x1 + 0.6 * f, y + 0.33 * f}, bar.note, {.size_px = 0.9 * f, .colour = ink, .bold = bar.sum});
    y += slot;
  }
  paint.line({x(chart.here), frame.y0}, {x(chart.here), frame.y1}, {.colour = ink, .width = f / 8.0});
  for (const ReferenceLine& line : chart.lines) {
    const double at = x(line.value);
    paint.line({at, frame.y0}, {at, frame.y1}, {.colour = line.colour, .width = f / 7.0});
    // Above the bars, inside the picture.
    const double wide = 0.5 * textWidth(line.label, 0.9 * f, true);
    paint.text({std::clamp(at, wide + f, size.width - wide - f), frame.y0 - 0.5 * f}, line.label,
               {.size_px = 0.9 * f, .colour = line.colour, .anchor = Anchor::Centre, .bold = true});
  }
}

}  // namespace glisson::render::detail
