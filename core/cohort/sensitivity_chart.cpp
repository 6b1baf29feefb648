// SPDX-License-Identifier: GPL-3.0-or-later
#include "cohort/detail/sensitivity_chart.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/chart_frame.h"
#include "render/font.h"

namespace glisson::cohort::detail {
namespace {

using render::Painter;
using render::Point;
using render::Rgb;

constexpr Rgb ink{30, 34, 40}, grey{90, 96, 104}, pale{238, 241, 244};
/// Told apart by colour-blind readers (Okabe and Ito), with a shape each.
constexpr std::array<Rgb, 4> colours{{{0, 114, 178}, {0, 158, 115}, {204, 121, 167}, {30, 34, 40}}};

void mark(Painter& paint, std::size_t patient, const Point& p, double r) {
  const Rgb colour = colours[patient % colours.size()];
  if (patient % 4 == 0)
    paint.disc(p, r, colour);
  else if (patient % 4 == 1)
    paint.rectangle(p.x() - 0.9 * r, p.y() - 0.9 * r, p.x() + 0.9 * r, p.y() + 0.9 * r, colour);
  else if (patient % 4 == 2)
    paint.polygon({{p.x(), p.y() - 1.2 * r}, {p.x() + 1.1 * r, p.y() + 0.8 * r}, {p.x() - 1.1 * r, p.y() + 0.8 * r}},
                  colour);
  else
    paint.polygon(
        {{p.x(), p.y() - 1.3 * r}, {p.x() + 1.3 * r, p.y()}, {p.x(), p.y() + 1.3 * r}, {p.x() - 1.3 * r, p.y()}},
        colour);
}

std::string countBeyond(const SensitivityChart::Row& row, double limit) {
  std::size_t there = 0, beyond = 0;
  for (const double v : row.values) {
    if (std::isfinite(v)) ++there;
    if (std::isfinite(v) && v >= limit) ++beyond;
  }
  return std::to_string(beyond) + " of " + std::to_string(there);
}

}  // namespace

void paint(Painter& painter, const SensitivityChart& chart, const render::ChartSize& size) {
  render::ChartFrame frame = render::beginChart(painter, size, chart.title, chart.caption, 1);
  const double f = frame.font;
  double high = chart.line.value, labels = 0.0;
  for (const auto& row : chart.rows) {
    labels = std::max(labels, render::textWidth(row.assumption, f));
    for (const double v : row.values)
      if (std::isfinite(v)) high = std::max(high, v);
  }
  const std::string beyond = "≥ " + render::shortNumber(chart.line.value);
  frame.x0 = 1.8 * f + labels;
  frame.x1 -= std::max(render::textWidth(beyond, f), render::textWidth("0 of 0", f, true)) + 1.5 * f;
  render::Scale x({.low = 0.0}, 0.0, high);
  x.setPixels(frame.x0, frame.x1);

  // One band a row, below the room for the line's label.
  const double top = frame.y0 + 2.0 * f, band = (frame.y1 - top) / static_cast<double>(chart.rows.size());
  for (std::size_t n = 0; n < chart.rows.size(); n += 2) {
    const double y = top + band * static_cast<double>(n);
    painter.rectangle(frame.x0, y, frame.x1, y + band, pale);
  }
  render::drawAxisX(painter, frame, x, chart.axis, true);
  render::drawVertical(painter, frame, x, {chart.line});
  const double right = static_cast<double>(size.width) - 1.8 * f;
  painter.text({right, top - 0.6 * f}, beyond, {.size_px = f, .colour = grey, .anchor = render::Anchor::Right});
  for (std::size_t n = 0; n < chart.rows.size(); ++n) {
    const auto& row = chart.rows[n];
    const double y = top + band * (static_cast<double>(n) + 0.5);
    painter.text({frame.x0 - 0.6 * f, y + 0.36 * f}, row.assumption,
                 {.size_px = f, .colour = ink, .anchor = render::Anchor::Right, .bold = n == 0});
    painter.text({right, y + 0.36 * f}, countBeyond(row, chart.line.value),
                 {.size_px = f, .colour = ink, .anchor = render::Anchor::Right, .bold = n == 0});
    double low = INFINITY, most = -INFINITY;
    for (const double v : row.values)
      if (std::isfinite(v)) {
        low = std::min(low, v);
        most = std::max(most, v);
      }
    if (low < most) painter.line({x(low), y}, {x(most), y}, {.colour = {170, 176, 184}, .width = f / 6.0});
    for (std::size_t p = 0; p < row.values.size(); ++p)
      if (std::isfinite(row.values[p])) mark(painter, p, {x(row.values[p]), y}, 0.42 * f);
  }
  double legend = -1.5 * f;
  for (const std::string& patient : chart.patients) legend += 2.8 * f + render::textWidth(patient, f);
  double at = std::max(0.5 * f, 0.5 * (size.width - legend));
  for (std::size_t p = 0; p < chart.patients.size(); ++p) {
    mark(painter, p, {at + 0.5 * f, frame.y0 - 1.15 * f}, 0.42 * f);
    painter.text({at + 1.3 * f, frame.y0 - 0.8 * f}, chart.patients[p], {.size_px = f, .colour = ink});
    at += 2.8 * f + render::textWidth(chart.patients[p], f);
  }
}

}  // namespace glisson::cohort::detail
