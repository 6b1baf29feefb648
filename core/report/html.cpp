#include "report/html.h"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>

#include "base/error.h"
#include "base/version.h"
#include "base/xml_text.h"

namespace glisson::report {
namespace {

std::string base64(const std::string& bytes) {
  static constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned int group = 0;
    for (std::size_t b = 0; b < 3; ++b)
      group = (group << 8) | (i + b < bytes.size() ? static_cast<unsigned char>(bytes[i + b]) : 0u);
    for (unsigned int c = 0; c < 4; ++c) out += i + c > bytes.size() ? '=' : letters[(group >> (18 - 6 * c)) & 63u];
  }
  return out;
}

constexpr const char* style =
    "body{font:16px/1.5 system-ui,'DejaVu Sans',sans-serif;max-width:62rem;margin:2rem auto;padding:0 "
    "1rem;color:#1b1f24}"
    "h1{font-size:1.6rem}h2{font-size:1.2rem;margin-top:2rem;border-bottom:1px solid #d0d7de}"
    "table{border-collapse:collapse;margin:.6rem "
    "0}th{text-align:left;padding:.2rem 1.2rem .2rem 0;border-bottom:2px solid #d0d7de}"
    ".wide td,.wide th{font-size:.92rem;overflow-wrap:anywhere}.warning{background:#fff4e5;border-left:4px solid "
    "#d97706;padding:.5rem .8rem}td{padding:.2rem 1.2rem .2rem 0;vertical-align:top;border-bottom:1px solid #eaeef2}"
    "td:last-child{font-variant-numeric:tabular-nums}figure{margin:1rem 0}img{max-width:100%}"
    "figcaption{color:#57606a;font-size:.9rem}footer{margin-top:3rem;color:#9a1c1c;font-weight:600}";

}  // namespace

HtmlReport::HtmlReport(std::string title) : title_(std::move(title)) {}

void HtmlReport::heading(const std::string& text) {
  body_ += "<h2>" + xmlEscaped(text) + "</h2>\n";
}

void HtmlReport::paragraph(const std::string& text) {
  body_ += "<p>" + xmlEscaped(text) + "</p>\n";
}

void HtmlReport::list(const std::vector<std::string>& items) {
  body_ += "<ul>\n";
  for (const std::string& item : items) body_ += "<li>" + xmlEscaped(item) + "</li>\n";
  body_ += "</ul>\n";
}

void HtmlReport::table(const std::vector<std::pair<std::string, std::string>>& rows) {
  body_ += "<table>\n";
  for (const auto& [what, value] : rows)
    body_ += "<tr><td>" + xmlEscaped(what) + "</td><td>" + xmlEscaped(value) + "</td></tr>\n";
  body_ += "</table>\n";
}

void HtmlReport::table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows) {
  body_ += "<table class=\"wide\">\n<tr>";
  for (const std::string& cell : header) body_ += "<th>" + xmlEscaped(cell) + "</th>";
  body_ += "</tr>\n";
  for (const auto& row : rows) {
    if (row.size() != header.size())
      throw BadArgument("HtmlReport: a row has " + std::to_string(row.size()) + " cells, not " +
                        std::to_string(header.size()));
    body_ += "<tr>";
    for (const std::string& cell : row) body_ += "<td>" + xmlEscaped(cell) + "</td>";
    body_ += "</tr>\n";
  }
  body_ += "</table>\n";
}

void HtmlReport::warning(const std::string& text) {
  body_ += "<p class=\"warning\">" + xmlEscaped(text) + "</p>\n";
}

void HtmlReport::picture(const std::filesystem::path& png, const std::string& caption) {
  std::ifstream in(png, std::ios::binary);
  if (!in) throw BadInput("the report cannot read the picture '" + png.filename().string() + "'");
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  body_ += "<figure><img alt=\"" + xmlEscaped(caption) + "\" src=\"data:image/png;base64," + base64(bytes) +
           "\"><figcaption>" + xmlEscaped(caption) + "</figcaption></figure>\n";
}

std::string HtmlReport::html() const {
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>" + xmlEscaped(title_) +
         "</title><style>" + style + "</style></head>\n<body>\n<h1>" + xmlEscaped(title_) + "</h1>\n" + body_ +
         "<footer>" + researchUseOnly + "</footer>\n</body></html>\n";
}

std::string number(double value, int significant) {
  if (!std::isfinite(value)) return "not available";
  char text[64];
  std::snprintf(text, sizeof text, "%.*g", significant, value);
  return text;
}

Csv::Csv(const std::vector<std::string>& header) : columns_(header.size()) {
  row(header);
}

void Csv::row(const std::vector<std::string>& cells) {
  if (cells.size() != columns_)
    throw BadArgument("Csv: a row has " + std::to_string(cells.size()) + " cells, not " + std::to_string(columns_));
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i) text_ += ',';
    if (cells[i].find_first_of(",\"\n") == std::string::npos) {
      text_ += cells[i];
      continue;
    }
    text_ += '"';
    for (const char c : cells[i]) text_ += c == '"' ? std::string("\"\"") : std::string(1, c);
    text_ += '"';
  }
  text_ += '\n';
}

}  // namespace glisson::report
