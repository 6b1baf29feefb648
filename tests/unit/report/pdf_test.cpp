// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>

#include "base/error.h"
#include "render/picture.h"
#include "report/page.h"
#include "support/support.h"

namespace glisson::report {
namespace {

using testing::HasSubstr;
using testing::Not;

render::Histogram chart() {
  render::Histogram h;
  h.title = "Values of a chart";
  h.x.title = "kPa";
  h.values = {1.2, 1.9, 2.2, 4.6};
  return h;
}

/// A page with one of everything; the picture is 40 × 20 pixels.
Page examplePage(const test::TemporaryFolder& folder) {
  render::Picture picture{40, 20, std::vector<std::uint8_t>(40 * 20 * 3, 128)};
  for (std::size_t n = 0; n < picture.rgb.size(); n += 7) picture.rgb[n] = static_cast<std::uint8_t>(n);
  render::writePng(folder / "x.png", picture);
  Page page("Report of µ ≥ 2.1 kPa");
  page.heading("First heading");
  page.paragraph("A paragraph with µ, ν and ± in it.");
  page.warning("A reservation.");
  page.list({"one item", "another item"});
  page.table({{"Mean", "1.5 mm"}});
  page.table({"Patient", "Digest"}, {{"case-001", std::string(64, 'a')}});
  page.picture(folder / "x.png", "Caption of a picture");
  page.chart(folder / "x.png", chart(), "Caption of a chart");
  return page;
}

/// What a command prints; empty where it is not installed.
std::string output(const std::string& command) {
  std::string text;
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen((command + " 2>/dev/null").c_str(), "r"), pclose);
  std::array<char, 4096> buffer{};
  for (std::size_t n = 0; (n = std::fread(buffer.data(), 1, buffer.size(), pipe.get())) > 0;)
    text.append(buffer.data(), n);
  return text;
}

std::filesystem::path written(const test::TemporaryFolder& folder, const Page& page) {
  std::ofstream(folder / "page.pdf", std::ios::binary) << pdf(page);
  return folder / "page.pdf";
}

TEST(Pdf, TheSamePageIsTheSameFile) {
  const test::TemporaryFolder folder;
  const std::string once = pdf(examplePage(folder));
  EXPECT_EQ(once.substr(0, 5), "%PDF-");
  EXPECT_EQ(once, pdf(examplePage(folder)));
  EXPECT_THAT(once, Not(HasSubstr("/CreationDate")));
  EXPECT_THAT(once, Not(HasSubstr("/ModDate")));
  EXPECT_THAT(once, Not(HasSubstr("/Author")));
  EXPECT_THAT(once, Not(HasSubstr(folder.path().string())));
}

TEST(Pdf, TextCanBeSearchedAndTheFontIsInside) {
  if (output("command -v pdftotext").empty()) GTEST_SKIP() << "pdftotext (poppler-utils) is not installed";
  const test::TemporaryFolder folder;
  const std::string file = written(folder, examplePage(folder)).string();
  const std::string text = output("pdftotext -layout " + file + " -");
  for (const char* expected : {"Report of µ ≥ 2.1 kPa", "First heading", "A paragraph with µ, ν and ± in it.",
                               "A reservation.", "another item", "1.5 mm", "case-001", "Caption of a picture",
                               "Caption of a chart", "1 of 1", "Research use only, not for clinical use"})
    EXPECT_THAT(text, HasSubstr(expected));
  // A chart is drawn, not photographed: its words are text.
  EXPECT_THAT(text, HasSubstr("Values of a chart"));
  EXPECT_THAT(text, HasSubstr(std::string(64, 'a')));
  const std::string fonts = output("pdffonts " + file);
  EXPECT_THAT(fonts, HasSubstr("DejaVuSans"));
  EXPECT_THAT(fonts, Not(HasSubstr(" no  ")));  // the columns emb, sub, uni
  EXPECT_THAT(output("pdfimages -list " + file), HasSubstr("40    20"));
}

TEST(Pdf, ALongTableGoesOnWithItsHeaderOnEverySheet) {
  if (output("command -v pdftotext").empty()) GTEST_SKIP() << "pdftotext (poppler-utils) is not installed";
  const test::TemporaryFolder folder;
  Page page("Many rows");
  std::vector<std::vector<std::string>> rows;
  for (int n = 0; n < 200; ++n) rows.push_back({"row " + std::to_string(n), "value"});
  page.table({"Headline of the table", "Value"}, rows);
  const std::string text = output("pdftotext -layout " + written(folder, page).string() + " -");
  std::size_t headers = 0, sheets = 0;
  for (std::size_t at = 0; (at = text.find("Headline of the table", at)) != std::string::npos; ++at) ++headers;
  for (std::size_t at = 0; (at = text.find('\f', at)) != std::string::npos; ++at) ++sheets;
  EXPECT_GE(sheets, 3u);
  EXPECT_EQ(headers, sheets);
  for (int n = 0; n < 200; ++n) EXPECT_THAT(text, HasSubstr("row " + std::to_string(n) + " "));
}

TEST(Pdf, APictureThatCannotBeReadIsNamed) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "broken.png", std::ios::binary) << "not a picture at all, and longer than a header";
  Page page("t");
  page.picture(folder / "broken.png", "");
  EXPECT_THROW(pdf(page), BadInput);
}

}  // namespace
}  // namespace glisson::report
