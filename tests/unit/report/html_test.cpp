#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "report/html.h"
#include "support/support.h"

namespace glisson::report {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(HtmlReport, EscapesTextAndEndsWithTheResearchUseLine) {
  HtmlReport page("a <b> & c");
  page.paragraph("<script>alert(1)</script>");
  const std::string html = page.html();
  EXPECT_THAT(html, Not(HasSubstr("<script")));
  EXPECT_THAT(html, HasSubstr("&lt;script&gt;"));
  EXPECT_THAT(html, HasSubstr("a &lt;b&gt; &amp; c"));
  EXPECT_THAT(html, HasSubstr("Research use only, not for clinical use"));
}

TEST(HtmlReport, PicturesAreInside) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "x.png", std::ios::binary) << "Man"
                                                    << "Ma"
                                                    << "M";  // 6 bytes: no padding
  HtmlReport page("t");
  page.picture(folder / "x.png", "caption");
  EXPECT_THAT(page.html(), HasSubstr("base64,TWFuTWFN\""));
  std::ofstream(folder / "y.png", std::ios::binary) << "Ma";
  page.picture(folder / "y.png", "caption");
  EXPECT_THAT(page.html(), HasSubstr("base64,TWE=\""));
  EXPECT_THROW(page.picture(folder / "none.png", ""), BadInput);
}

TEST(Csv, QuotesOnlyWhereNeeded) {
  Csv csv({"a", "b"});
  csv.row({"1.5", "say \"x\", y"});
  EXPECT_EQ(csv.text(), "a,b\n1.5,\"say \"\"x\"\", y\"\n");
  EXPECT_THROW(csv.row({"only one"}), BadArgument);
}

TEST(Number, FewDigitsAndNoNan) {
  EXPECT_EQ(number(3.14159), "3.142");
  EXPECT_EQ(number(std::nan("")), "not available");
}

}  // namespace
}  // namespace glisson::report
