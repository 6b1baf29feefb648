#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace glisson::report {

/// Builds one self-contained HTML page: no script, no link to anything outside it, pictures inside. Text is escaped.
class HtmlReport {
 public:
  explicit HtmlReport(std::string title);

  void heading(const std::string& text);
  void paragraph(const std::string& text);
  void list(const std::vector<std::string>& items);
  /// Two columns: what and value with unit.
  void table(const std::vector<std::pair<std::string, std::string>>& rows);
  /// Any number of columns; the first cell of a row says what it is. Throws BadArgument where a row is not as long as
  /// the header.
  void table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows);
  /// A reservation that must not be overlooked.
  void warning(const std::string& text);
  /// A PNG file with a caption, put into the page. Throws BadInput where it cannot be read.
  void picture(const std::filesystem::path& png, const std::string& caption);

  /// The whole page; ends with the research-use line.
  std::string html() const;

 private:
  std::string title_;
  std::string body_;
};

/// A number with a few significant digits for tables and captions, never in a locale's own way.
std::string number(double value, int significant = 4);

/// Rows of "tidy" CSV: quoted where needed, '.' as decimal point.
class Csv {
 public:
  explicit Csv(const std::vector<std::string>& header);
  void row(const std::vector<std::string>& cells);
  const std::string& text() const { return text_; }

 private:
  std::size_t columns_;
  std::string text_;
};

}  // namespace glisson::report
