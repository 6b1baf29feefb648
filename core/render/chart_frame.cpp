// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/chart_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "base/error.h"
#include "render/colour_map.h"
#include "render/font.h"

namespace glisson::render {
namespace {

using namespace colours;
constexpr Rgb rule{222, 226, 230};

std::string superscript(int n) {
  constexpr const char* digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string out = n < 0 ? "⁻" : "";
  for (const char c : std::to_string(std::abs(n))) out += digits[c - '0'];
  return out;
}

}  // namespace

std::string shortNumber(double v) {
  if (v == 0.0) return "0";
  const double size = std::abs(v);
  std::string text;
  if (size >= 1e5 || size < 1e-3) {
    int exponent = static_cast<int>(std::floor(std::log10(size) + 1e-9));
    const double mantissa = std::round(size / std::pow(10.0, exponent) * 100.0) / 100.0;
    text = (mantissa == 1.0 ? "" : shortNumber(mantissa) + "×") + "10" + superscript(exponent);
  } else {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.4g", size);
    text = buffer;
  }
  return v < 0.0 ? "−" + text : text;
}

Scale::Scale(const Axis& axis, double low, double high) : logarithmic_(axis.logarithmic) {
  low_ = axis.low.value_or(low);
  high_ = axis.high.value_or(high);
  if (!std::isfinite(low_) || !std::isfinite(high_))
    throw BadArgument("the axis '" + axis.title + "' has no finite range");
  if (logarithmic_) {
    if (!(low_ > 0.0))
      throw BadArgument("the logarithmic axis '" + axis.title + "' has a value that is not above zero");
    if (!axis.low) low_ = std::pow(10.0, std::floor(std::log10(low_) + 1e-9));
    if (!axis.high) high_ = std::pow(10.0, std::ceil(std::log10(high_) - 1e-9));
    if (!(high_ > low_)) high_ = 10.0 * low_;
    const int first = static_cast<int>(std::floor(std::log10(low_) + 1e-9));
    const int last = static_cast<int>(std::ceil(std::log10(high_) - 1e-9));
    const int every = std::max(1, (last - first + 7) / 8);
    for (int decade = first; decade <= last; ++decade)
      for (int m = 1; m < 10; ++m) {
        const double v = m * std::pow(10.0, decade);
        if (v < low_ * (1 - 1e-9) || v > high_ * (1 + 1e-9)) continue;
        if (m == 1)
          ticks_.push_back({v, (decade - first) % every == 0 ? shortNumber(v) : ""});
        else if (every == 1)
          ticks_.push_back({v, ""});
      }
    return;
  }
  if (!(high_ > low_)) {
    const double pad = std::max(0.5, 0.1 * std::abs(low_));
    low_ -= pad;
    high_ += pad;
  }
  double step = std::pow(10.0, std::floor(std::log10((high_ - low_) / 4.0)));
  for (const double factor : {2.0, 2.5, 2.0})
    if ((high_ - low_) / step > 8.0) step *= factor;
  if (!axis.low) low_ = std::floor(low_ / step + 1e-9) * step;
  if (!axis.high) high_ = std::ceil(high_ / step - 1e-9) * step;
  for (double n = std::ceil(low_ / step - 1e-9); n * step <= high_ + 1e-9 * step; n += 1.0)
    ticks_.push_back({n * step, inLanguage(shortNumber(std::abs(n) < 0.5 ? 0.0 : n * step), axis.language)});
}

void Scale::setPixels(double atLow, double atHigh) {
  from_ = atLow;
  to_ = atHigh;
}

double Scale::along(double value) const {
  return logarithmic_ ? std::log(value / low_) / std::log(high_ / low_) : (value - low_) / (high_ - low_);
}

double Scale::operator()(double value) const {
  return from_ + (to_ - from_) * along(value);
}

double Scale::valueAt(double pixel) const {
  const double along = (pixel - from_) / (to_ - from_);
  return logarithmic_ ? low_ * std::pow(high_ / low_, along) : low_ + (high_ - low_) * along;
}

double chartFont(const ChartSize& size) {
  return std::clamp(std::min(size.width / 52.0, size.height / 36.0), 8.0, 80.0);
}

ChartFrame beginChart(Painter& paint, const ChartSize& size, const std::string& title, const std::string& caption,
                      int legendRows, Language language) {
  if (size.width < 200 || size.height < 160 || size.width > 20000 || size.height > 20000)
    throw BadArgument("a chart of " + std::to_string(size.width) + " x " + std::to_string(size.height) +
                      " pixels is outside 200 x 160 to 20000 x 20000");
  ChartFrame frame;
  frame.font = chartFont(size);
  const double f = frame.font;
  paint.rectangle(0, 0, size.width, size.height, paper);
  if (!title.empty())
    paint.text({0.5 * size.width, 2.1 * f}, title,
               {.size_px = 1.25 * f, .colour = ink, .anchor = Anchor::Centre, .bold = true});
  const std::vector<std::string> lines = wrapText(caption, 0.8 * f, size.width - 2.0 * f);
  double y = size.height - 0.7 * f;
  paint.text({f, y}, phrase(researchUseOnly, language), {.size_px = 0.75 * f, .colour = {150, 80, 0}});
  for (auto line = lines.rbegin(); line != lines.rend(); ++line) {
    y -= 1.2 * f;
    paint.text({f, y}, *line, {.size_px = 0.8 * f, .colour = {90, 96, 104}});
  }
  frame.x0 = 5.6 * f;
  frame.x1 = size.width - 1.8 * f;
  frame.y0 = (title.empty() ? 1.4 * f : 3.4 * f) + 1.7 * f * legendRows;
  frame.y1 = y - 4.6 * f;
  return frame;
}

void drawAxisX(Painter& paint, const ChartFrame& frame, const Scale& scale, const std::string& title, bool grid) {
  const double f = frame.font;
  for (const Scale::Tick& tick : scale.ticks()) {
    const double x = scale(tick.value);
    if (grid && !tick.text.empty() && x > frame.x0 + 1.0)
      paint.line({x, frame.y0}, {x, frame.y1}, {.colour = rule, .width = f / 18.0});
    paint.line({x, frame.y1}, {x, frame.y1 + (tick.text.empty() ? 0.2 : 0.4) * f}, {.colour = ink, .width = f / 14.0});
    paint.text({x, frame.y1 + 1.5 * f}, tick.text, {.size_px = f, .colour = ink, .anchor = Anchor::Centre});
  }
  paint.line({frame.x0, frame.y1}, {frame.x1, frame.y1}, {.colour = ink, .width = f / 12.0});
  paint.text({0.5 * (frame.x0 + frame.x1), frame.y1 + 3.1 * f}, title,
             {.size_px = 1.1 * f, .colour = ink, .anchor = Anchor::Centre});
}

void drawAxisY(Painter& paint, const ChartFrame& frame, const Scale& scale, const std::string& title) {
  const double f = frame.font;
  for (const Scale::Tick& tick : scale.ticks()) {
    const double y = scale(tick.value);
    if (!tick.text.empty() && y < frame.y1 - 1.0)
      paint.line({frame.x0, y}, {frame.x1, y}, {.colour = rule, .width = f / 18.0});
    paint.line({frame.x0 - (tick.text.empty() ? 0.2 : 0.4) * f, y}, {frame.x0, y}, {.colour = ink, .width = f / 14.0});
    paint.text({frame.x0 - 0.6 * f, y + 0.36 * f}, tick.text, {.size_px = f, .colour = ink, .anchor = Anchor::Right});
  }
  paint.line({frame.x0, frame.y0}, {frame.x0, frame.y1}, {.colour = ink, .width = f / 12.0});
  paint.text({1.5 * f, 0.5 * (frame.y0 + frame.y1)}, title,
             {.size_px = 1.1 * f, .colour = ink, .anchor = Anchor::Centre, .angle_deg = 90.0});
}

void drawHorizontal(Painter& paint, const ChartFrame& frame, const Scale& y, const std::vector<ReferenceLine>& lines) {
  for (const ReferenceLine& line : lines) {
    const double at = y(line.value);
    if (at >= frame.y0 - 1.0 && at <= frame.y1 + 1.0)
      paint.line({frame.x0, at}, {frame.x1, at}, {.colour = line.colour, .width = frame.font / 7.0});
  }
}

void labelHorizontal(Painter& paint, const ChartFrame& frame, const Scale& y, const std::vector<ReferenceLine>& lines,
                     std::vector<Stretch> drawn) {
  const double f = frame.font;
  for (const ReferenceLine& line : lines) drawn.push_back({{frame.x0, y(line.value)}, {frame.x1, y(line.value)}});
  for (std::size_t n = 0; n < lines.size(); ++n) {
    const double at = y(lines[n].value);
    if (!(at >= frame.y0 - 1.0 && at <= frame.y1 + 1.0)) continue;
    const double width = textWidth(lines[n].label, 0.9 * f, true);
    const std::size_t own = drawn.size() - lines.size();  // the lines come last; labels placed before go in front
    // To cover a marker is worse than to cross a line.
    const auto harm = [&](const Point& low, const Point& high) {
      std::size_t sum = 0;
      for (std::size_t s = 0; s < drawn.size(); ++s) {
        if (s == own + n) continue;
        const auto& [from, to] = drawn[s];
        const double length = (to - from).norm(), apart = (length > 0.0 ? 0.15 : 0.55) * f;
        const int steps = 1 + static_cast<int>(length / (0.25 * f));
        for (int step = 0; step <= steps; ++step) {
          const Point p = from + (to - from) * (static_cast<double>(step) / steps);
          if ((p.array() > low.array() - apart).all() && (p.array() < high.array() + apart).all()) {
            sum += length > 0.0 ? 1 : 8;
            break;
          }
        }
      }
      return sum;
    };
    Point best(frame.x1 - 0.3 * f, at - 0.35 * f);
    std::size_t least = std::numeric_limits<std::size_t>::max();
    // Close above, close below; where both are full all along the line, one row further off.
    for (const std::array<double, 2>& rows : {std::array{-0.35, 1.05}, std::array{-1.35, 2.05}})
      for (double right = frame.x1 - 0.3 * f; right - width > frame.x0 + 0.3 * f && least > 0; right -= 0.5 * f)
        for (const double row : rows) {
          const double baseline = at + row * f;
          if (baseline - 0.8 * f < frame.y0 || baseline > frame.y1 - 0.2 * f) continue;
          const std::size_t found = harm({right - width, baseline - 0.75 * f}, {right, baseline + 0.15 * f});
          if (found >= least) continue;
          least = found;
          best = {right, baseline};
        }
    paint.text(best, lines[n].label,
               {.size_px = 0.9 * f, .colour = lines[n].colour, .anchor = Anchor::Right, .bold = true});
    drawn.insert(drawn.begin(), {{best.x() - width, best.y() - 0.35 * f}, {best.x(), best.y() - 0.35 * f}});
  }
}

void drawVertical(Painter& paint, const ChartFrame& frame, const Scale& x, const std::vector<ReferenceLine>& lines) {
  double row = 1.0;
  for (const ReferenceLine& line : lines) {
    const double at = x(line.value);
    if (!(at >= frame.x0 - 1.0 && at <= frame.x1 + 1.0)) continue;
    paint.line({at, frame.y0}, {at, frame.y1}, {.colour = line.colour, .width = frame.font / 7.0});
    const double width = textWidth(line.label, 0.9 * frame.font, true);
    const bool fits = at + 0.4 * frame.font + width < frame.x1;
    paint.text({at + (fits ? 0.4 : -0.4) * frame.font, frame.y0 + row * 1.2 * frame.font}, line.label,
               {.size_px = 0.9 * frame.font,
                .colour = line.colour,
                .anchor = fits ? Anchor::Left : Anchor::Right,
                .bold = true});
    row += 1.0;
  }
}

}  // namespace glisson::render
