// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "base/version.h"
#include "render/font.h"
#include "report/detail/pdf_canvas.h"
#include "report/page.h"

namespace glisson::report {
namespace {

using detail::PdfCanvas;
using render::Rgb;

constexpr double margin = 50.0, bottom = PdfCanvas::height_pt - 56.0, column = PdfCanvas::width_pt - 2.0 * margin;
constexpr double bodySize = 9.5, captionSize = 8.3, leading = 1.42;
constexpr Rgb ink{27, 31, 36}, grey{87, 96, 106}, rule{208, 215, 222}, paleRule{234, 238, 242}, red{154, 28, 28};

double widthOf(const std::string& utf8, double size, bool bold = false) {
  // Measured large: letters are placed by their unrounded widths.
  return render::textWidth(utf8, 64.0, bold) * size / 64.0;
}

/// Lines no wider than `width`; a word that is wider than a line is broken inside.
std::vector<std::string> wrapped(const std::string& utf8, double size, double width, bool bold = false) {
  std::vector<std::string> lines;
  std::string line;
  for (std::size_t at = 0; at <= utf8.size();) {
    const std::size_t end = std::min(utf8.find_first_of(" \n", at), utf8.size());
    std::string word = utf8.substr(at, end - at);
    at = end + 1;
    if (!line.empty() && widthOf(line + " " + word, size, bold) > width) lines.push_back(std::exchange(line, {}));
    while (line.empty() && widthOf(word, size, bold) > width) {
      std::size_t fits = 1;
      for (std::size_t n = 1; n < word.size() && widthOf(word.substr(0, n), size, bold) <= width; ++n)
        if ((static_cast<unsigned char>(word[n]) & 0xc0U) != 0x80U) fits = n;
      if (fits >= word.size() || word.size() < 2) break;
      lines.push_back(word.substr(0, fits));
      word.erase(0, fits);
    }
    line += (line.empty() ? "" : " ") + word;
  }
  if (!line.empty() || lines.empty()) lines.push_back(line);
  return lines;
}

/// Puts blocks one below the other and begins a new sheet where one is full. Nothing is drawn until all is placed:
/// every sheet tells how many there are.
class Layout {
 public:
  Layout() : sheets_(1) {}

  void title(const std::string& text) {
    for (const std::string& line : wrapped(text, 17.0, column, true)) put(line, 17.0, ink, true);
    y_ += 6.0;
  }
  /// least: height of what must stand on the same sheet below it.
  void heading(const Heading& b, double least) {
    need(40.0 + least);
    y_ += y_ > margin ? 12.0 : 0.0;
    bookmarks_.push_back({b.text, static_cast<int>(sheets_.size()), y_});
    put(b.text, 12.5, ink, true);
    line(margin, y_ - 1.0, margin + column, rule, 0.8);
    y_ += 6.0;
  }
  void operator()(const Paragraph& b) {
    text(b.text, bodySize, ink);
    y_ += 5.0;
  }
  void operator()(const Warning& b) {
    const auto lines = wrapped(b.text, bodySize, column - 22.0);
    const double height = static_cast<double>(lines.size()) * bodySize * leading + 10.0;
    need(std::min(height, bottom - margin));
    const double top = y_;
    add([top, height](PdfCanvas& c) {
      c.painter().rectangle(margin, top, margin + column, top + height, {255, 244, 229});
      c.painter().rectangle(margin, top, margin + 3.0, top + height, {217, 119, 6});
    });
    y_ += 5.0;
    for (const std::string& l : lines) put(l, bodySize, ink, false, margin + 12.0);
    y_ = top + height + 6.0;
  }
  void operator()(const List& b) {
    for (const std::string& item : b.items) {
      const auto lines = wrapped(item, bodySize, column - 14.0);
      for (std::size_t n = 0; n < lines.size(); ++n) {
        if (n == 0) put("•", bodySize, ink, false, margin + 3.0, false);
        put(lines[n], bodySize, ink, false, margin + 14.0);
      }
    }
    y_ += 5.0;
  }
  void operator()(const Heading& b) { heading(b, 50.0); }
  void operator()(const Table& b);
  void operator()(const Figure& b);
  /// Height of a figure with its caption.
  static double heightOf(const Figure& b) { return placed(b).height; }

  std::string write(const std::string& title) const;

 private:
  using Mark = std::function<void(PdfCanvas&)>;
  struct Placed {
    double scale, width, picture, height;  ///< points a pixel; points
    std::vector<std::string> caption;
  };
  static Placed placed(const Figure& b);
  struct Bookmark {
    std::string text;
    int sheet;
    double y;
  };

  void add(Mark mark) { sheets_.back().push_back(std::move(mark)); }
  void newSheet() {
    sheets_.emplace_back();
    y_ = margin;
  }
  /// A new sheet where less than `height` is left of this one; true where one was begun.
  bool need(double height) {
    if (y_ + height <= bottom || y_ <= margin) return false;
    newSheet();
    return true;
  }
  void textAt(const std::string& utf8, double x, double baseline, double size, Rgb colour, bool bold) {
    add([=](PdfCanvas& c) {
      c.painter().text({x, baseline}, utf8, {.size_px = size, .colour = colour, .bold = bold});
    });
  }
  /// One line of text; the next goes below it.
  void put(const std::string& utf8, double size, Rgb colour, bool bold = false, double x = margin, bool next = true) {
    need(size * leading);
    textAt(utf8, x, y_ + size * 1.05, size, colour, bold);
    if (next) y_ += size * leading;
  }
  void text(const std::string& utf8, double size, Rgb colour) {
    for (const std::string& l : wrapped(utf8, size, column)) put(l, size, colour);
  }
  void line(double x0, double y, double x1, Rgb colour, double width) {
    add([=](PdfCanvas& c) { c.painter().rectangle(x0, y - width / 2, x1, y + width / 2, colour); });
  }

  std::vector<std::vector<Mark>> sheets_;
  std::vector<Bookmark> bookmarks_;
  double y_ = margin;
};

/// Columns as wide as their content where all fit; else narrow ones keep their width and wide ones share the rest.
std::vector<double> columnWidths(const Table& t, double size, double gap, double room) {
  const std::size_t n = t.header.empty() ? t.rows.front().size() : t.header.size();
  std::vector<double> content(n, 0.0), least(n, 0.0);
  const auto measure = [&](const std::vector<std::string>& cells, bool bold) {
    for (std::size_t c = 0; c < n; ++c) {
      content[c] = std::max(content[c], widthOf(cells[c], size, bold) + gap);
      for (std::size_t at = 0; at < cells[c].size();) {
        const std::size_t end = std::min(cells[c].find(' ', at), cells[c].size());
        least[c] = std::max(least[c], std::min(widthOf(cells[c].substr(at, end - at), size, bold) + gap, 0.6 * room));
        at = end + 1;
      }
    }
  };
  if (!t.header.empty()) measure(t.header, true);
  for (const auto& row : t.rows) measure(row, false);
  const double all = std::accumulate(content.begin(), content.end(), 0.0);
  if (all <= room) return content;
  const double fixed = std::accumulate(least.begin(), least.end(), 0.0);
  std::vector<double> width(n);
  for (std::size_t c = 0; c < n; ++c)
    width[c] = fixed >= room ? room * least[c] / fixed
                             : least[c] + (room - fixed) * (content[c] - least[c]) / std::max(all - fixed, 1e-9);
  return width;
}

void Layout::operator()(const Table& b) {
  if (b.rows.empty() && b.header.empty()) return;
  const double gap = 10.0;
  const std::size_t n = b.header.empty() ? b.rows.front().size() : b.header.size();
  // Smaller letters before broken lines, as far as they can be read.
  double size = n > 3 ? 8.2 : 8.8;
  std::vector<double> width = columnWidths(b, size, gap, column);
  while (size > 7.0 && std::accumulate(width.begin(), width.end(), 0.0) > column - 0.01)
    width = columnWidths(b, size -= 0.3, gap, column);
  const double right = margin + std::min(column, std::accumulate(width.begin(), width.end(), 0.0));
  std::function<void(const std::vector<std::string>&, bool)> row = [&](const std::vector<std::string>& cells,
                                                                       bool header) {
    std::vector<std::vector<std::string>> lines;
    std::size_t most = 1;
    for (std::size_t c = 0; c < n; ++c) {
      lines.push_back(wrapped(cells[c], size, width[c] - gap + 0.01, header));  // a word that just fits, fits
      most = std::max(most, lines.back().size());
    }
    const double height = static_cast<double>(most) * size * 1.32 + 4.0;
    if (need(header ? height + 3.0 * size : height) && !header && !b.header.empty()) row(b.header, true);
    double x = margin;
    for (std::size_t c = 0; c < n; x += width[c++])
      for (std::size_t l = 0; l < lines[c].size(); ++l)
        textAt(lines[c][l], x, y_ + 2.0 + size * (1.0 + 1.32 * static_cast<double>(l)), size, ink, header);
    y_ += height;
    line(margin, y_, right, header ? rule : paleRule, header ? 1.2 : 0.6);
  };
  if (!b.header.empty()) row(b.header, true);
  for (const auto& cells : b.rows) row(cells, false);
  y_ += 8.0;
}

Layout::Placed Layout::placed(const Figure& b) {
  const render::ChartSize size = b.drawing ? b.size : detail::sizeOfPng(b.png);
  Placed p;
  p.caption = wrapped(b.caption, captionSize, column);
  const double below = static_cast<double>(p.caption.size()) * captionSize * leading + 12.0;
  // Two to a sheet where they are no taller than wide; never coarser than 96 pixels an inch.
  const double tallest = std::max(0.47 * (bottom - margin) - below, 200.0);
  p.scale = std::min({column / size.width, tallest / size.height, 0.75});
  p.width = p.scale * size.width;
  p.picture = p.scale * size.height;
  p.height = p.picture + below;
  return p;
}

void Layout::operator()(const Figure& b) {
  const Placed p = placed(b);
  need(p.height);
  const double x = margin + 0.5 * (column - p.width), y = y_;
  if (b.drawing)
    add([=](PdfCanvas& c) { c.drawing(b.drawing, x, y, p.scale); });
  else
    add([=](PdfCanvas& c) { c.picture(b.png, x, y, p.width); });
  y_ += p.picture + 3.0;
  for (const std::string& l : p.caption) put(l, captionSize, grey);
  y_ += 9.0;
}

std::string Layout::write(const std::string& title) const {
  PdfCanvas canvas(title);
  for (std::size_t s = 0; s < sheets_.size(); ++s) {
    for (const Mark& mark : sheets_[s]) mark(canvas);
    for (const Bookmark& b : bookmarks_)
      if (b.sheet == static_cast<int>(s) + 1) canvas.bookmark(b.text, b.sheet, b.y);
    const double foot = PdfCanvas::height_pt - 30.0;
    canvas.painter().text({margin, foot}, researchUseOnly, {.size_px = 8.0, .colour = red});
    canvas.painter().text({margin + column, foot}, std::to_string(s + 1) + " of " + std::to_string(sheets_.size()),
                          {.size_px = 8.0, .colour = grey, .anchor = render::Anchor::Right});
    canvas.nextSheet();
  }
  return canvas.finish();
}

}  // namespace

std::string pdf(const Page& page) {
  Layout layout;
  layout.title(page.title());
  const std::vector<Block>& blocks = page.blocks();
  for (std::size_t n = 0; n < blocks.size(); ++n) {
    const auto* heading = std::get_if<Heading>(&blocks[n]);
    const auto* figure = n + 1 < blocks.size() ? std::get_if<Figure>(&blocks[n + 1]) : nullptr;
    if (heading && figure)
      layout.heading(*heading, Layout::heightOf(*figure));
    else
      std::visit(layout, blocks[n]);
  }
  return layout.write(page.title());
}

}  // namespace glisson::report
