// SPDX-License-Identifier: GPL-3.0-or-later
#include <fstream>
#include <iterator>

#include "base/error.h"
#include "base/version.h"
#include "base/xml_text.h"
#include "report/page.h"

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

struct Writer {
  std::string& out;

  void operator()(const Heading& b) const { out += "<h2>" + xmlEscaped(b.text) + "</h2>\n"; }
  void operator()(const Paragraph& b) const { out += "<p>" + xmlEscaped(b.text) + "</p>\n"; }
  void operator()(const Warning& b) const { out += "<p class=\"warning\">" + xmlEscaped(b.text) + "</p>\n"; }
  void operator()(const List& b) const {
    out += "<ul>\n";
    for (const std::string& item : b.items) out += "<li>" + xmlEscaped(item) + "</li>\n";
    out += "</ul>\n";
  }
  void operator()(const Table& b) const {
    out += b.header.empty() ? "<table>\n" : "<table class=\"wide\">\n";
    if (!b.header.empty()) row("th", b.header);
    for (const auto& cells : b.rows) row("td", cells);
    out += "</table>\n";
  }
  void operator()(const Figure& b) const {
    std::ifstream in(b.png, std::ios::binary);
    if (!in) throw BadInput("the report cannot read the picture '" + b.png.filename().string() + "'");
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    const std::string caption = xmlEscaped(b.caption);
    out += "<figure><img alt=\"" + caption + "\" src=\"data:image/png;base64," + base64(bytes) + "\"><figcaption>" +
           caption + "</figcaption></figure>\n";
  }

  void row(const char* cell, const std::vector<std::string>& cells) const {
    out += "<tr>";
    for (const std::string& text : cells) out += std::string("<") + cell + ">" + xmlEscaped(text) + "</" + cell + ">";
    out += "</tr>\n";
  }
};

}  // namespace

std::string html(const Page& page) {
  const std::string title = xmlEscaped(page.title());
  std::string out = "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>" + title +
                    "</title><style>" + style + "</style></head>\n<body>\n<h1>" + title + "</h1>\n";
  for (const Block& block : page.blocks()) std::visit(Writer{out}, block);
  return out + "<footer>" + researchUseOnly + "</footer>\n</body></html>\n";
}

}  // namespace glisson::report
