// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "render/charts.h"

namespace glisson::report {

/// A heading of a section.
struct Heading {
  std::string text;
};
/// A paragraph of text.
struct Paragraph {
  std::string text;
};
/// A reservation that must not be overlooked.
struct Warning {
  std::string text;
};
/// A list of points.
struct List {
  std::vector<std::string> items;
};
/// A table of text.
struct Table {
  std::vector<std::string> header;             ///< empty: two columns, what and value
  std::vector<std::vector<std::string>> rows;  ///< all of the same length
};
/// A PNG file with a caption; where it was drawn from a chart, the chart too, for print.
struct Figure {
  std::filesystem::path png;
  std::string caption;
  std::function<void(render::Painter&)> drawing{};  ///< empty: the picture is all there is
  render::ChartSize size{};                         ///< of the drawing
};
using Block = std::variant<Heading, Paragraph, Warning, List, Table, Figure>;

/// What a report says, in order; html() and pdf() write it down. Knows no medical word.
class Page {
 public:
  explicit Page(std::string title) : title_(std::move(title)) {}

  void heading(const std::string& text) { blocks_.emplace_back(Heading{text}); }
  void paragraph(const std::string& text) { blocks_.emplace_back(Paragraph{text}); }
  void warning(const std::string& text) { blocks_.emplace_back(Warning{text}); }
  void list(const std::vector<std::string>& items) { blocks_.emplace_back(List{items}); }
  /// Two columns: what and value with unit.
  void table(const std::vector<std::pair<std::string, std::string>>& rows);
  /// Any number of columns; the first cell of a row says what it is. Throws BadArgument where a row is not as long as
  /// the header.
  void table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows);
  /// A PNG file with a caption. Throws BadInput where it cannot be read.
  void picture(const std::filesystem::path& png, const std::string& caption);
  /// A chart that was drawn to a PNG file: the file goes into HTML, the drawing itself into PDF. Throws as picture.
  void drawing(const std::filesystem::path& png, std::function<void(render::Painter&)> drawing,
               const render::ChartSize& size, const std::string& caption);
  template <typename Chart>
  void chart(const std::filesystem::path& png, const Chart& chart, const std::string& caption) {
    drawing(
        png, [chart](render::Painter& painter) { render::paint(painter, chart); }, {}, caption);
  }

  const std::string& title() const { return title_; }
  const std::vector<Block>& blocks() const { return blocks_; }

 private:
  std::string title_;
  std::vector<Block> blocks_;
};

/// One self-contained HTML page: no script, no link to anything outside it, pictures inside. Text is escaped. Ends with
/// the research-use line. Throws BadInput where a picture cannot be read.
std::string html(const Page& page);

/// The same as one PDF document, A4: text that can be searched and copied, charts as vectors, pictures and font
/// inside, headings as bookmarks, the research-use line on every sheet. The bytes depend on the page alone: no date, no
/// name of a person or machine. Throws BadInput where a picture cannot be read.
std::string pdf(const Page& page);

}  // namespace glisson::report
