// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "report/page.h"
#include "support/support.h"

namespace glisson::report {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(Html, EscapesTextAndEndsWithTheResearchUseLine) {
  Page page("a <b> & c");
  page.paragraph("<script>alert(1)</script>");
  const std::string text = html(page);
  EXPECT_THAT(text, Not(HasSubstr("<script")));
  EXPECT_THAT(text, HasSubstr("&lt;script&gt;"));
  EXPECT_THAT(text, HasSubstr("a &lt;b&gt; &amp; c"));
  EXPECT_THAT(text, HasSubstr("Research use only, not for clinical use"));
}

TEST(Html, PicturesAreInside) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "x.png", std::ios::binary) << "Man"
                                                    << "Ma"
                                                    << "M";  // 6 bytes: no padding
  Page page("t");
  page.picture(folder / "x.png", "caption");
  EXPECT_THAT(html(page), HasSubstr("base64,TWFuTWFN\""));
  std::ofstream(folder / "y.png", std::ios::binary) << "Ma";
  page.picture(folder / "y.png", "caption");
  EXPECT_THAT(html(page), HasSubstr("base64,TWE=\""));
  EXPECT_THROW(page.picture(folder / "none.png", ""), BadInput);
}

}  // namespace
}  // namespace glisson::report
